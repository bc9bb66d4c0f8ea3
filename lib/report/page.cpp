// SPDX-License-Identifier: BSD-3-Clause
#include "report/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "artefact/files.h"
#include "artefact/hdf5_artefact.h"
#include "base/error.h"
#include "report/page_html.h"
#include "report/tables.h"

namespace soslam {
namespace {

using nlohmann::json;

void KeepNumbersOnly(json* variant) {
  for (const char* key :
       {"objects", "outlines", "trajectory", "solver", "planes", "grids", "points"}) {
    variant->erase(key);
  }
  variant->at("metrics")["objects"] = json::array();
  variant->at("numbers_only") = true;
}

// Keeps only the numbers of as many variants as necessary. Returns their names.
std::vector<std::string> KeepNumbersOnlyOfSome(size_t max_bytes, const BytesOfPage& bytes_of,
                                               json* data) {
  std::vector<std::string> names;
  for (const char* kind : {"frames", "views", "map"}) {
    for (json& variant : data->at("variants")) {
      if (variant.at("kind") != kind || bytes_of(*data) <= max_bytes) continue;
      KeepNumbersOnly(&variant);
      names.push_back(variant.at("name"));
    }
  }
  return names;
}

}  // namespace

void FitPageData(size_t max_bytes, const BytesOfPage& bytes_of, json* data) {
  if (bytes_of(*data) <= max_bytes) return;
  if (!data->at("symmetries").empty()) {
    for (json& symmetry : data->at("symmetries")) symmetry["curves"] = json::array();
    data->at("notes").push_back(
        "For lack of room the cost over yaw of single observations is left out.");
  }
  const auto reduced = KeepNumbersOnlyOfSome(max_bytes, bytes_of, data);
  if (reduced.empty()) return;
  data->at("notes").push_back(
      fmt::format("For lack of room only the numbers of {} are shown.", fmt::join(reduced, ", ")));
  if (reduced.size() < data->at("variants").size()) return;
  for (json& sequence : data->at("sequences")) {
    for (const char* key : {"frames", "objects", "detections", "planes", "segments"}) {
      sequence[key] = json::array();
    }
  }
}

namespace {

// Size of a dataset's data and of their tables.
size_t PageBytes(const json& page) { return PageText(page).size() + DatasetTables(page).size(); }

namespace fs = std::filesystem;

// Collects the data of a dataset's page. Files that variants share are read once.
class DatasetPage {
 public:
  DatasetPage(const DatasetResult& dataset, const ImageSourceOf& images) : images_(images) {
    data_ = {{"dataset", Utf8(dataset.name)},     {"url", UrlOf(dataset.name)},
             {"images", json::object()},          {"sequences", json::array()},
             {"symmetries", json::array()},       {"variants", json::array()},
             {"unfinished", json::array()},       {"notes", json::array()},
             {"problems", json::array()},         {"differences", PageDifferences(dataset)},
             {"findings", PageFindings(dataset)}, {"map_section", ""}};
    for (const VariantResult& variant : dataset.variants) Add(variant);
    data_["has_true_objects"] = std::ranges::any_of(sequences_, HasTrueObjects);
    data_["has_true_poses"] = std::ranges::any_of(sequences_, HasTruePoses);
  }

  json Fitted(size_t max_bytes, int threads) {
    if (data_["variants"].empty()) return data_;
    const LoadedSequence& first = sequences_.front();
    const ImageSource source = images_(first.sequence);
    const bool has_images = std::ranges::any_of(first.selection.shown, source.has);
    // The section of the map has at most a quarter of a page.
    const std::string map_section = SectionOfBestMap(max_bytes / 4, threads);
    max_bytes -= std::min(max_bytes, map_section.size());
    // Images shrink to an eighth of a page before anything else is left out.
    FitPageData(max_bytes - (has_images ? max_bytes / 8 : 0), PageBytes, &data_);
    data_["detailed"] = DetailedVariants(data_);
    if (!data_["sequences"].front()["frames"].empty()) {
      AddImages(first, source, max_bytes, threads);
    }
    data_["map_section"] = map_section;
    return data_;
  }

 private:
  struct LoadedSequence {
    Sequence sequence;
    PageSelection selection;
  };

  static bool HasTrueObjects(const LoadedSequence& loaded) {
    return std::ranges::any_of(
               loaded.sequence.objects,
               [](const Object& object) { return object.ground_truth.has_value(); }) ||
           std::ranges::any_of(loaded.sequence.detections, [](const Detection& detection) {
             return detection.true_landmark_in_camera.has_value();
           });
  }

  static bool HasTruePoses(const LoadedSequence& loaded) {
    return std::ranges::any_of(loaded.sequence.frames, [](const Frame& frame) {
      return frame.true_world_from_camera.has_value();
    });
  }

  void Add(const VariantResult& result) {
    std::string state =
        result.unreadable.empty() ? WhyUnfinished(result) : "failed: " + result.unreadable;
    bool is_shown = false;
    if (!result.metrics.is_null()) {
      try {
        AddEstimates(result);
        is_shown = true;
      } catch (const InputError& error) {
        state = fmt::format("failed: {}", error.what());
      }
    }
    if (state.empty() && is_shown) return;
    if (state.empty()) state = "incomplete: it has no metrics.json";
    data_["unfinished"].push_back(
        {{"name", Utf8(result.name)}, {"state", Utf8(state)}, {"is_shown", is_shown}});
  }

  // The section of the map that is of most interest; empty without one.
  std::string SectionOfBestMap(size_t max_bytes, int threads) {
    const size_t index = DetailedVariants(data_).front();
    const json& variant = data_["variants"][index];
    if (variant.at("kind") != "map") return "";
    const Sequence& sequence = sequences_[variant.at("sequence").get<size_t>()].sequence;
    const bool is_only = folders_.size() == 1;
    const std::string title = is_only ? "Map" : "Map of " + variant.at("name").get<std::string>();
    try {
      std::string section =
          MapSection(title, folders_[index], sequence, images_(sequence), max_bytes, threads);
      if (section.empty()) {
        data_["notes"].push_back("For lack of room the map from above is left out.");
      }
      return section;
    } catch (const InputError& error) {
      data_["problems"].push_back(
          Utf8(fmt::format("the map from above cannot be shown: {}", error.what())));
      return "";
    }
  }

  void AddEstimates(const VariantResult& result) {
    const size_t index = IndexOfSequence(result.folder / "sequence.json");
    const auto& [sequence, selection] = sequences_[index];
    json variant = PageVariant(result, sequence, selection);
    variant["name"] = Utf8(result.name);
    variant["sequence"] = index;
    variant["symmetry"] = nullptr;
    variant["numbers_only"] = false;
    const fs::path symmetry = result.folder / "symmetry.h5";
    if (ShowsStage(result, "refine", "symmetry.h5")) {
      variant["symmetry"] = IndexOfSymmetry(symmetry, sequences_[index]);
    }
    data_["variants"].push_back(std::move(variant));
    folders_.push_back(result.folder);
  }

  size_t IndexOfSequence(const fs::path& file) {
    const auto known = sequence_of_.find(fs::weakly_canonical(file));
    if (known != sequence_of_.end()) return known->second;
    Sequence sequence = ReadSequence(file, PlaneNeed::kNotNeeded);
    if (sequences_.empty()) shown_ids_ = FramesToShow(sequence, images_(sequence).has);
    PageSelection selection = SelectForPage(sequence, shown_ids_);
    data_["sequences"].push_back(PageSequence(sequence, selection));
    sequences_.push_back({std::move(sequence), std::move(selection)});
    return sequence_of_[fs::canonical(file)] = sequences_.size() - 1;
  }

  size_t IndexOfSymmetry(const fs::path& file, const LoadedSequence& loaded) {
    const auto known = symmetry_of_.find(fs::weakly_canonical(file));
    if (known != symmetry_of_.end()) return known->second;
    const std::vector<SymmetryRecord> records = ReadSymmetry(file);
    data_["symmetries"].push_back(
        {{"curves", PageCurves(records, loaded.sequence, loaded.selection)},
         {"descriptors", PageDescriptors(records)}});
    return symmetry_of_[fs::canonical(file)] = data_["symmetries"].size() - 1;
  }

  void AddImages(const LoadedSequence& first, const ImageSource& source, size_t max_bytes,
                 int threads) {
    constexpr size_t kBytesOfNotes = 20'000;
    const size_t taken = PageBytes(data_) + kBytesOfNotes;
    const EncodedImages encoded = EncodeImages(first.selection.shown, source,
                                               max_bytes - std::min(max_bytes, taken), threads);
    for (const auto& [frame_index, base64] : encoded.images) {
      const int id = first.sequence.frames[frame_index].id;
      data_["images"][std::to_string(id)] = "data:image/jpeg;base64," + base64;
    }
    if (!encoded.failures.empty()) {
      data_["problems"].push_back(Utf8(
          fmt::format("{} of {} images cannot be shown, the first: {}", encoded.failures.size(),
                      first.selection.shown.size(), encoded.failures.front())));
    }
    if (encoded.scaled_to_px > 0) {
      data_["notes"].push_back(
          fmt::format("For lack of room images are {} px wide at most.", encoded.scaled_to_px));
    }
    if (encoded.left_out > 0) {
      data_["notes"].push_back(fmt::format("For lack of room {} images of {} are left out.",
                                           encoded.left_out,
                                           encoded.left_out + encoded.images.size()));
    }
  }

  const ImageSourceOf& images_;
  json data_;
  std::deque<LoadedSequence> sequences_;  // a deque, as image sources refer to its elements
  std::vector<fs::path> folders_;         // of data_["variants"]
  std::set<int> shown_ids_;
  std::map<fs::path, size_t> sequence_of_, symmetry_of_;  // by resolved path
};

}  // namespace

json PageData(const DatasetResult& dataset, const ImageSourceOf& images, size_t max_bytes,
              int threads) {
  return DatasetPage(dataset, images).Fitted(max_bytes, threads);
}

json OverviewData(const std::vector<json>& pages) {
  json datasets = json::array();
  for (const json& page : pages) {
    json dataset = {{"counts", CountsOfDataset(page)}, {"variants", json::array()}};
    for (const char* key :
         {"dataset", "url", "has_true_objects", "unfinished", "notes", "problems", "findings"}) {
      dataset[key] = page.at(key);
    }
    for (const json& variant : page.at("variants")) {
      json metrics = variant.at("metrics");
      metrics.erase("objects");
      if (metrics.contains("map_quality")) {
        for (const char* rows : {"objects", "landmarks"}) metrics["map_quality"].erase(rows);
      }
      dataset["variants"].push_back(
          {{"name", variant.at("name")}, {"kind", variant.at("kind")}, {"metrics", metrics}});
    }
    datasets.push_back(std::move(dataset));
  }
  return {{"datasets", std::move(datasets)}};
}

}  // namespace soslam
