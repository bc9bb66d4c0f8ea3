// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/report/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "soslam/model/describe_metrics.h"

namespace soslam {

namespace fs = std::filesystem;
using nlohmann::json;

void FitPage(size_t max_bytes, const BytesOfPage& bytes_of, DatasetPage* page) {
  if (bytes_of(*page) <= max_bytes) return;
  if (!page->symmetries.empty()) {
    for (json& symmetry : page->symmetries) symmetry["curves"] = json::array();
    page->notes.emplace_back(
        "For lack of room the cost over yaw of single observations is left out.");
  }
  std::vector<std::string> reduced;
  for (const VariantKind kind : {VariantKind::kFrames, VariantKind::kViews, VariantKind::kMap}) {
    for (PageVariant& variant : page->variants) {
      if (variant.kind != kind || bytes_of(*page) <= max_bytes) continue;
      variant.numbers_only = true;
      variant.data = json::object();
      variant.objects.clear();
      variant.solver.reset();
      variant.metrics.objects.clear();
      reduced.push_back(variant.name);
    }
  }
  if (reduced.empty()) return;
  page->notes.push_back(
      fmt::format("For lack of room only the numbers of {} are shown.", fmt::join(reduced, ", ")));
  if (reduced.size() < page->variants.size()) return;
  for (ShownSequence& shown : page->sequences) {
    shown.selection = {};
    for (const char* key : {"frames", "objects", "detections", "planes", "segments"}) {
      shown.data[key] = json::array();
    }
  }
}

namespace {

// Size of a page's data and tables.
size_t PageBytes(const DatasetPage& page) {
  return PageText(MakePageData(page)).size() + DatasetTables(page).size();
}

// Makes the page of a dataset. Files that variants share are read once.
class PageMaker {
 public:
  PageMaker(const DatasetResult& dataset, const ImageSourceOf& images) : images_(images) {
    page_.name = dataset.name;
    page_.differences = PartDifferences(dataset);
    page_.findings = PageFindings(dataset);
    for (const VariantResult& variant : dataset.variants) Add(variant);
    page_.has_true_objects = std::ranges::any_of(page_.sequences, HasTrueObjects);
    page_.has_true_poses = std::ranges::any_of(page_.sequences, HasTruePoses);
  }

  DatasetPage Fitted(size_t max_bytes, int threads) {
    if (page_.variants.empty()) return std::move(page_);
    const ShownSequence& first = page_.sequences.front();
    const ImageSource source = images_(first.sequence);
    const bool has_images = std::ranges::any_of(first.selection.shown, source.has);
    // The section of the map has at most a quarter of a page.
    const std::string map_section = SectionOfBest(
        "the map from above",
        [&](const PageVariant& variant, const fs::path& folder, const Sequence& sequence) {
          if (variant.kind != VariantKind::kMap) return std::string();
          const std::string title = folders_.size() == 1 ? "Map" : "Map of " + variant.name;
          std::string section =
              MapSection(title, folder, sequence, images_(sequence), max_bytes / 4, threads);
          if (section.empty()) {
            page_.notes.emplace_back("For lack of room the map from above is left out.");
          }
          return section;
        });
    max_bytes -= std::min(max_bytes, map_section.size());
    // The boxes of its objects have at most an eighth.
    const std::string boxes_section = SectionOfBest(
        "the boxes of objects",
        [&](const PageVariant&, const fs::path& folder, const Sequence& sequence) {
          return BoxesSection(folder, sequence, images_(sequence), max_bytes / 8, threads);
        });
    max_bytes -= std::min(max_bytes, boxes_section.size());
    // Images shrink to an eighth of a page before anything else is left out.
    FitPage(max_bytes - (has_images ? max_bytes / 8 : 0), PageBytes, &page_);
    if (!first.selection.frames.empty()) AddImages(first, source, max_bytes, threads);
    page_.map_section = map_section;
    page_.boxes_section = boxes_section;
    return std::move(page_);
  }

 private:
  static bool HasTrueObjects(const ShownSequence& shown) {
    return std::ranges::any_of(
               shown.sequence.objects,
               [](const Object& object) { return object.ground_truth.has_value(); }) ||
           std::ranges::any_of(shown.sequence.detections, [](const Detection& detection) {
             return detection.true_landmark_in_camera.has_value();
           });
  }

  static bool HasTruePoses(const ShownSequence& shown) {
    return std::ranges::any_of(shown.sequence.frames, [](const Frame& frame) {
      return frame.true_world_from_camera.has_value();
    });
  }

  void Add(const VariantResult& result) {
    std::string state =
        result.unreadable.empty() ? WhyUnfinished(result) : "failed: " + result.unreadable;
    bool is_shown = false;
    if (result.metrics) {
      try {
        const size_t index = IndexOfSequence(result.folder / "sequence.json");
        const ShownSequence& shown = page_.sequences[index];
        PageVariant variant = ReadPageVariant(result, shown.sequence, shown.selection);
        variant.sequence = index;
        if (ShowsStage(result, "refine", "symmetry.h5")) {
          variant.symmetry = IndexOfSymmetry(result.folder / "symmetry.h5", shown);
        }
        page_.variants.push_back(std::move(variant));
        folders_.push_back(result.folder);
        is_shown = true;
      } catch (const InputError& error) {
        state = fmt::format("failed: {}", error.what());
      }
    }
    if (state.empty() && is_shown) return;
    if (state.empty()) state = "incomplete: it has no metrics.json";
    page_.unfinished.push_back({Utf8(result.name), Utf8(state), is_shown});
  }

  // The result of `make` for the variant of most interest; empty where its files are not valid.
  template <typename Make>
  std::string SectionOfBest(const char* what, const Make& make) {
    const size_t index = DetailedVariants(page_).front();
    const PageVariant& variant = page_.variants[index];
    try {
      return make(variant, folders_[index], page_.sequences[variant.sequence].sequence);
    } catch (const InputError& error) {
      page_.problems.push_back(Utf8(fmt::format("{} cannot be shown: {}", what, error.what())));
      return "";
    }
  }

  size_t IndexOfSequence(const fs::path& file) {
    const auto known = sequence_of_.find(fs::weakly_canonical(file));
    if (known != sequence_of_.end()) return known->second;
    Sequence sequence = ReadSequence(file, PlaneNeed::kNotNeeded);
    if (page_.sequences.empty()) shown_ids_ = FramesToShow(sequence, images_(sequence).has);
    PageSelection selection = SelectForPage(sequence, shown_ids_);
    json data = PageSequence(sequence, selection);
    page_.sequences.push_back({std::move(sequence), std::move(selection), std::move(data)});
    return sequence_of_[fs::canonical(file)] = page_.sequences.size() - 1;
  }

  size_t IndexOfSymmetry(const fs::path& file, const ShownSequence& shown) {
    const auto known = symmetry_of_.find(fs::weakly_canonical(file));
    if (known != symmetry_of_.end()) return known->second;
    const std::vector<SymmetryRecord> records = ReadSymmetry(file);
    page_.symmetries.push_back({{"curves", PageCurves(records, shown.sequence, shown.selection)},
                                {"descriptors", PageDescriptors(records)}});
    return symmetry_of_[fs::canonical(file)] = page_.symmetries.size() - 1;
  }

  void AddImages(const ShownSequence& first, const ImageSource& source, size_t max_bytes,
                 int threads) {
    constexpr size_t kBytesOfNotes = 20'000;
    const size_t taken = PageBytes(page_) + kBytesOfNotes;
    const EncodedImages encoded = EncodeImages(first.selection.shown, source,
                                               max_bytes - std::min(max_bytes, taken), threads);
    for (const auto& [frame_index, base64] : encoded.images) {
      const int id = first.sequence.frames[frame_index].id;
      page_.images[std::to_string(id)] = "data:image/jpeg;base64," + base64;
    }
    if (!encoded.failures.empty()) {
      page_.problems.push_back(Utf8(
          fmt::format("{} of {} images cannot be shown, the first: {}", encoded.failures.size(),
                      first.selection.shown.size(), encoded.failures.front())));
    }
    if (encoded.scaled_to_px > 0) {
      page_.notes.push_back(
          fmt::format("For lack of room images are {} px wide at most.", encoded.scaled_to_px));
    }
    if (encoded.left_out > 0) {
      page_.notes.push_back(fmt::format("For lack of room {} images of {} are left out.",
                                        encoded.left_out,
                                        encoded.left_out + encoded.images.size()));
    }
  }

  const ImageSourceOf& images_;
  DatasetPage page_;
  std::vector<fs::path> folders_;  // of the page's variants
  std::set<int> shown_ids_;
  std::map<fs::path, size_t> sequence_of_, symmetry_of_;  // by resolved path
};

// Data that the page of a dataset and the page of all datasets share.
json MakeHead(const DatasetPage& page) {
  json head = {{"dataset", Utf8(page.name)},  {"url", EncodeUrl(page.name)},
               {"unfinished", json::array()}, {"findings", json::array()},
               {"notes", page.notes},         {"problems", page.problems},
               {"variants", json::array()},   {"has_true_objects", page.has_true_objects}};
  for (const auto& [name, state, is_shown] : page.unfinished) {
    head["unfinished"].push_back({{"name", name}, {"state", state}, {"is_shown", is_shown}});
  }
  for (const auto& [finding, where] : page.findings) {
    head["findings"].push_back(DescribedToJson(finding));
    head["findings"].back()["where"] = where;
  }
  for (const PageVariant& variant : page.variants) {
    head["variants"].push_back({{"name", variant.name},
                                {"kind", NameOf(variant.kind)},
                                {"metrics", DescribedToJson(variant.metrics)}});
  }
  return head;
}

}  // namespace

DatasetPage MakePage(const DatasetResult& dataset, const ImageSourceOf& images, size_t max_bytes,
                     int threads) {
  return PageMaker(dataset, images).Fitted(max_bytes, threads);
}

json MakePageData(const DatasetPage& page) {
  json data = MakeHead(page);
  data["images"] = page.images;
  data["symmetries"] = page.symmetries;
  data["has_true_poses"] = page.has_true_poses;
  data["detailed"] = DetailedVariants(page);
  data["sequences"] = json::array();
  for (const ShownSequence& shown : page.sequences) data["sequences"].push_back(shown.data);
  for (size_t i = 0; i < page.variants.size(); ++i) {
    const PageVariant& variant = page.variants[i];
    json& of_variant = data["variants"][i];
    of_variant.update(variant.data);
    of_variant["sequence"] = variant.sequence;
    of_variant["symmetry"] = variant.symmetry ? json(*variant.symmetry) : json();
    of_variant["numbers_only"] = variant.numbers_only;
  }
  data["differences"] = json::array();
  for (const auto& [parts, objects, of_metrics] : page.differences) {
    json pair = {{"with", parts.variant}, {"without", parts.baseline}, {"objects", objects}};
    for (size_t i = 0; i < of_metrics.size(); ++i) {
      json& of_metric = pair[kMeanMetrics[i].Key()];
      of_metric = {{"mean", nullptr}, {"low", nullptr}, {"high", nullptr}};
      if (!of_metrics[i]) continue;
      of_metric["mean"] = PageNumber(of_metrics[i]->mean);
      if (const auto& interval = of_metrics[i]->confidence_95) {
        of_metric["low"] = PageNumber(interval->low);
        of_metric["high"] = PageNumber(interval->high);
      }
    }
    data["differences"].push_back(std::move(pair));
  }
  return data;
}

json OverviewData(const std::vector<DatasetPage>& pages) {
  json datasets = json::array();
  for (const DatasetPage& page : pages) {
    json dataset = MakeHead(page);
    dataset["counts"] = CountsOfDataset(page);
    for (json& variant : dataset["variants"]) {
      variant["metrics"].erase("objects");
      if (!variant["metrics"].contains("map_quality")) continue;
      for (const char* rows : {"objects", "landmarks"}) {
        variant["metrics"]["map_quality"].erase(rows);
      }
    }
    datasets.push_back(std::move(dataset));
  }
  return {{"datasets", std::move(datasets)}};
}

}  // namespace soslam
