// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/labelled_box.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <map>
#include <string_view>

#include "artefact/json_file.h"
#include "base/error.h"
#include "base/table.h"
#include "dataset/class_names.h"
#include "dataset/json_entry.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

constexpr std::array kBoxColumns = {"frame", "label", "score", "x1", "y1", "x2", "y2"};
constexpr const char* kIdColumn = "object_id";

// Some programs write a column with gaps as real numbers: 7 is "7.0".
std::optional<int> ParseObjectId(std::string_view text, const std::string& place) {
  if (text.empty()) return std::nullopt;
  if (text.ends_with(".0")) text.remove_suffix(2);
  return ParseInteger(text, place, kIdColumn);
}

LabelledBox ParseBox(const CsvRow& row) {
  LabelledBox box{row.place,
                  ParseInteger(row.fields.at("frame"), row.place, "frame"),
                  row.fields.at("label"),
                  row.Real("score"),
                  {row.Real("x1"), row.Real("y1"), row.Real("x2"), row.Real("y2")}};
  if (box.label.empty()) throw InputError(row.place + ": label is empty; expected a category");
  const auto id = row.fields.find(kIdColumn);
  if (id != row.fields.end()) box.object_id = ParseObjectId(id->second, row.place);
  return box;
}

}  // namespace

std::vector<LabelledBox> ReadDetectionsCsv(const std::filesystem::path& path) {
  std::vector<LabelledBox> boxes;
  ForEachCsvRow(path, {{kBoxColumns.begin(), kBoxColumns.end()}, kIdColumn},
                [&](const CsvRow& row) { boxes.push_back(ParseBox(row)); });
  return boxes;
}

std::string LabelledBoxesText(const std::vector<LabelledBox>& boxes) {
  std::string text = fmt::format("{}\n", fmt::join(kBoxColumns, ","));
  for (const LabelledBox& row : boxes) {
    text += fmt::format("{},{},{:.4f},{:.2f},{:.2f},{:.2f},{:.2f}\n", std::get<int>(row.frame),
                        CsvText(row.label), row.score, row.box.x_min, row.box.y_min, row.box.x_max,
                        row.box.y_max);
  }
  return text;
}

namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Names of the ids in a results file.
struct CocoNames {
  std::map<int, std::string> images;
  std::map<int, std::string> categories;
};

std::map<int, std::string> ReadNames(const JsonEntry& document, const char* list_name,
                                     const char* text_name) {
  const std::string place = fmt::format("{}#/{}", document.place(), list_name);
  std::map<int, std::string> names;
  for (const JsonEntry& entry : EntriesOf(document.List(list_name), place)) {
    if (!names.emplace(entry.Integer("id"), entry.Text(text_name)).second) {
      entry.Refuse("id", "one that no other entry has");
    }
  }
  return names;
}

CocoNames NamesOf(const json& document, const fs::path& path) {
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
  if (entry.Field("image_id").is_string()) return entry.Text("image_id");
  if (names) return NameOf(names->images, entry, "image_id");
  return entry.Integer("image_id");
}

std::string ParseLabel(const JsonEntry& entry, const std::optional<CocoNames>& names) {
  if (names) return NameOf(names->categories, entry, "category_id");
  const auto index = CocoClassIndex(entry.Integer("category_id"));
  if (!index) entry.Refuse("category_id", "a category of COCO, 1 to 90");
  return CocoLabels()[*index];
}

Box ParseBox(const JsonEntry& entry) {
  const Eigen::Vector4d xywh = entry.Vector<4>("bbox");
  if (xywh[2] < 0.0 || xywh[3] < 0.0) entry.Refuse("bbox", "[x, y, width, height]");
  return FromCornerOrigin({xywh[0], xywh[1], xywh[0] + xywh[2], xywh[1] + xywh[3]});
}

// Track id as CVAT writes it; none without one.
std::optional<int> ParseTrack(const JsonEntry& entry) {
  if (entry.Has("track_id")) return entry.Integer("track_id");
  if (!entry.Has("attributes") || !entry.Field("attributes").is_object()) return std::nullopt;
  const JsonEntry attributes(entry.Field("attributes"), entry.place() + "/attributes");
  return attributes.Has("track_id") ? std::optional(attributes.Integer("track_id")) : std::nullopt;
}

// True if the box is around a crowd of objects.
bool IsCrowd(const JsonEntry& entry) { return entry.Has("iscrowd") && entry.Field("iscrowd") == 1; }

std::vector<LabelledBox> ParseBoxes(const json& list, const std::string& place,
                                    const std::optional<CocoNames>& names) {
  std::vector<LabelledBox> boxes;
  for (const JsonEntry& entry : EntriesOf(list, place)) {
    if (IsCrowd(entry)) continue;
    boxes.push_back({entry.place(), ParseFrame(entry, names), ParseLabel(entry, names),
                     entry.Has("score") ? entry.Real("score") : 1.0, ParseBox(entry),
                     ParseTrack(entry)});
  }
  return boxes;
}

}  // namespace

std::vector<LabelledBox> ReadCocoResults(const fs::path& results,
                                         const std::optional<fs::path>& dataset) {
  const json document = ParseJsonFile(results);
  const auto names =
      dataset ? std::optional(NamesOf(ParseJsonFile(*dataset), *dataset)) : std::nullopt;
  if (document.is_array()) return ParseBoxes(document, results.string() + "#", names);
  if (!document.is_object() || !document.contains("annotations")) {
    throw InputError(results.string() +
                     ": is not a list of results, nor a data set with \"images\", "
                     "\"annotations\" and \"categories\"");
  }
  const JsonEntry entry(document, results.string());
  return ParseBoxes(entry.List("annotations"), results.string() + "#/annotations",
                    names ? names : NamesOf(document, results));
}

namespace {

LabelledBox ParseDetection(const JsonEntry& entry, const std::string& image,
                           const std::vector<std::string>& labels) {
  const int category = entry.Integer("category_id");
  if (category < 0 || category >= static_cast<int>(labels.size())) {
    entry.Refuse("category_id", fmt::format("0 to {}", labels.size() - 1));
  }
  const Eigen::Vector4d corners = entry.Vector<4>("bbox");
  if (corners[2] < corners[0] || corners[3] < corners[1]) {
    entry.Refuse("bbox", "[x1, y1, x2, y2] with x1 <= x2 and y1 <= y2");
  }
  return {entry.place(), image, labels[category], entry.Real("detection_score"),
          FromCornerOrigin({corners[0], corners[1], corners[2], corners[3]})};
}

}  // namespace

std::vector<LabelledBox> ReadOaSlamBoxes(const std::filesystem::path& path,
                                         const std::vector<std::string>& labels) {
  const json images = ParseJsonFile(path);
  if (!images.is_array()) throw InputError(path.string() + ": is not a list of images");
  std::vector<LabelledBox> boxes;
  for (const JsonEntry& image : EntriesOf(images, path.string() + "#")) {
    const std::string name = image.Text("file_name");
    for (const JsonEntry& entry :
         EntriesOf(image.List("detections"), image.place() + "/detections")) {
      boxes.push_back(ParseDetection(entry, name, labels));
    }
  }
  return boxes;
}

}  // namespace soslam
