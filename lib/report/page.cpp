// SPDX-License-Identifier: BSD-3-Clause
#include "report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "artefact/sequence_file.h"
#include "report/page_differences.h"
#include "report/page_sequence.h"
#include "report/page_variant.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Of a page's data, images included as far as there is room: with the libraries it stays below 8
// MB.
constexpr size_t kMaxDataBytes = 6'500'000;
constexpr size_t kMinImageBytes = 1'000'000;

// Those with an image; where they are too many, evenly over those in which something was detected.
std::vector<int> ShownFrames(const Sequence& sequence, const ImageSource& images) {
  std::vector<int> frames;
  for (int i = 0; i < static_cast<int>(sequence.frames.size()); ++i) {
    if (images.has(i)) frames.push_back(i);
  }
  if (frames.size() <= kMaxPageFrames) return frames;
  std::set<int> with_detections;
  for (const Detection& detection : sequence.detections) {
    with_detections.insert(detection.frame_index);
  }
  std::erase_if(frames, [&](int frame) { return with_detections.count(frame) == 0; });
  return SpreadOver(frames, kMaxPageFrames);
}

// The frames of these ids, ascending.
std::vector<int> FramesOfIds(const Sequence& sequence, const std::set<int>& ids) {
  std::vector<int> frames;
  for (int i = 0; i < static_cast<int>(sequence.frames.size()); ++i) {
    if (ids.count(sequence.frames[static_cast<size_t>(i)].id) > 0) frames.push_back(i);
  }
  return frames;
}

json PageImages(const Sequence& sequence, const std::vector<int>& frames, const ImageSource& images,
                size_t max_bytes, int threads) {
  const auto encoded = EncodeImages(frames, images, max_bytes, threads);
  json by_frame = json::object();
  for (size_t i = 0; i < frames.size(); ++i) {
    const int id = sequence.frames[static_cast<size_t>(frames[i])].id;
    by_frame[std::to_string(id)] = "data:image/jpeg;base64," + encoded[i];
  }
  return by_frame;
}

void Replace(const std::string& placeholder, std::string_view by, std::string* text) {
  const size_t at = text->find(placeholder);
  if (at == std::string::npos) throw std::logic_error("page.html has no " + placeholder);
  text->replace(at, placeholder.size(), by);
}

std::string Escaped(std::string text, const std::string& what, const std::string& by) {
  for (size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
  return text;
}

}  // namespace

bool IsComplete(const VariantResult& variant) {
  return !variant.metrics.is_null() && fs::exists(variant.folder / "sequence.json");
}

json PageData(const DatasetResult& dataset, const ImageSourceOf& images, int threads) {
  json data = {{"dataset", dataset.name},
               {"sequences", json::array()},
               {"variants", json::array()},
               {"images", json::object()},
               {"differences", PageDifferences(dataset)}};
  std::map<fs::path, size_t> index_of_sequence;  // by the file that links lead to
  std::optional<Sequence> first;                 // whose images are shown
  std::vector<int> frames_of_first;
  std::set<int> shown_ids;
  for (const VariantResult& result : dataset.variants) {
    if (!IsComplete(result)) continue;
    const fs::path file = result.folder / "sequence.json";
    const Sequence sequence = ReadSequence(file, PlaneNeed::kNotNeeded);
    if (!first) {
      first = sequence;
      frames_of_first = ShownFrames(sequence, images(sequence));
      for (const int i : frames_of_first) {
        shown_ids.insert(sequence.frames[static_cast<size_t>(i)].id);
      }
    }
    const std::vector<int> shown = FramesOfIds(sequence, shown_ids);
    const auto [entry, is_new] =
        index_of_sequence.emplace(fs::canonical(file), data["sequences"].size());
    if (is_new) data["sequences"].push_back(PageSequence(sequence, shown));
    json variant = PageVariant(result, sequence, shown);
    variant["sequence"] = entry->second;
    data["variants"].push_back(std::move(variant));
  }
  if (!first) return data;
  const size_t without_images = data.dump(-1, ' ', false, json::error_handler_t::replace).size();
  const size_t room = kMaxDataBytes - std::min(kMaxDataBytes - kMinImageBytes, without_images);
  data["images"] = PageImages(*first, frames_of_first, images(*first), room, threads);
  return data;
}

json OverviewData(const std::vector<json>& pages) {
  json datasets = json::array();
  for (const json& page : pages) {
    json variants = json::array();
    for (const json& variant : page.at("variants")) {
      variants.push_back({{"name", variant.at("name")},
                          {"kind", variant.at("kind")},
                          {"metrics", variant.at("metrics")}});
    }
    const json& sequence = page.at("sequences").front();
    datasets.push_back({{"dataset", page.at("dataset")},
                        {"frames", sequence.at("frames").size()},
                        {"objects", sequence.at("objects").size()},
                        {"detections", sequence.at("detections").size()},
                        {"variants", std::move(variants)}});
  }
  return {{"datasets", std::move(datasets)}};
}

std::string PageHtml(const std::string& title, const std::string& entry, const json& data) {
  const auto& files = EmbeddedPageFiles();
  std::string scripts;
  // Libraries first; of ours the functions that others use.
  for (const char* name :
       {"three.min.js", "OrbitControls.js", "chart.min.js", "elements.js", "overlay.js",
        "charts.js", "map.js", "figures.js", "objects.js", "frames.js", "tables.js", "main.js"}) {
    scripts += fmt::format("<script>\n{}\n</script>\n", files.at(name));
  }
  std::string html(files.at("page.html"));
  Replace("{{title}}", Escaped(Escaped(title, "&", "&amp;"), "<", "&lt;"), &html);
  Replace("{{style}}", files.at("page.css"), &html);
  Replace("{{scripts}}", scripts, &html);
  Replace("{{entry}}", entry, &html);
  // "<" would begin or end elements. Names that are not UTF-8 are shown as far as they are.
  const std::string text = data.dump(-1, ' ', false, json::error_handler_t::replace);
  Replace("{{data}}", Escaped(text, "<", "\\u003c"), &html);
  return html;
}

}  // namespace soslam
