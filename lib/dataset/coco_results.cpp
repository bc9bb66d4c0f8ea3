// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/coco_results.h"

#include <fmt/format.h>

#include <map>
#include <string>

#include "artefact/json_file.h"
#include "base/error.h"
#include "dataset/coco_labels.h"
#include "dataset/json_entry.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// What the ids of a results file stand for.
struct CocoNames {
  std::map<int, std::string> images;
  std::map<int, std::string> categories;
};

std::map<int, std::string> ReadNames(const JsonEntry& document, const char* list_name,
                                     const char* text_name) {
  const json& list = document.List(list_name);
  std::map<int, std::string> names;
  for (size_t i = 0; i < list.size(); ++i) {
    const JsonEntry entry(list[i], fmt::format("{}#/{}/{}", document.place(), list_name, i));
    if (!names.emplace(entry.Integer("id"), entry.Text(text_name)).second) {
      entry.Refuse("id", "one that no other entry has");
    }
  }
  return names;
}

CocoNames ReadDataset(const fs::path& path) {
  const json document = ParseJsonFile(path);
  const JsonEntry entry(document, path.string());
  return {ReadNames(entry, "images", "file_name"), ReadNames(entry, "categories", "name")};
}

const std::string& NameOf(const std::map<int, std::string>& names, const JsonEntry& entry,
                          const char* field) {
  const auto found = names.find(entry.Integer(field));
  if (found == names.end()) entry.Refuse(field, "an id of the dataset's JSON file");
  return found->second;
}

FrameKey ParseFrame(const JsonEntry& entry, const std::optional<CocoNames>& names) {
  if (names) return NameOf(names->images, entry, "image_id");
  if (entry.Field("image_id").is_string()) return entry.Text("image_id");
  return entry.Integer("image_id");
}

std::string ParseLabel(const JsonEntry& entry, const std::optional<CocoNames>& names) {
  if (names) return NameOf(names->categories, entry, "category_id");
  const auto index = CocoClassIndex(entry.Integer("category_id"));
  if (!index) entry.Refuse("category_id", "a category of COCO, 1 to 90");
  return CocoLabels()[static_cast<size_t>(*index)];
}

Box ParseBox(const JsonEntry& entry) {
  const Eigen::Vector4d xywh = entry.Vector<4>("bbox");
  if (xywh[2] < 0.0 || xywh[3] < 0.0) entry.Refuse("bbox", "[x, y, width, height]");
  return FromCornerOrigin({xywh[0], xywh[1], xywh[0] + xywh[2], xywh[1] + xywh[3]});
}

}  // namespace

std::vector<LabelledBox> ReadCocoResults(const fs::path& results,
                                         const std::optional<fs::path>& dataset) {
  const json list = ParseJsonFile(results);
  if (!list.is_array()) throw InputError(results.string() + ": is not a list of results");
  const auto names = dataset ? std::optional(ReadDataset(*dataset)) : std::nullopt;
  std::vector<LabelledBox> boxes;
  for (size_t i = 0; i < list.size(); ++i) {
    const JsonEntry entry(list[i], fmt::format("{}#/{}", results.string(), i));
    boxes.push_back({entry.place(), ParseFrame(entry, names), ParseLabel(entry, names),
                     entry.Real("score"), ParseBox(entry)});
  }
  return boxes;
}

}  // namespace soslam
