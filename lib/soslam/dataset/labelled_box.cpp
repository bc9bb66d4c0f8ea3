// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/labelled_box.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/table.h"
#include "soslam/dataset/class_names.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/json_entry.h"
#include "soslam/dataset/text_file.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

constexpr std::array kBoxColumns = {"frame", "label", "score", "x1", "y1", "x2", "y2"};
constexpr const char* kIdColumn = "object_id";

// Keys and columns with the angle of a box in programs that write oriented boxes.
constexpr std::array kAngles = {"rotation", "angle", "theta"};
constexpr const char* kUprightBoxes = "no angle: oriented boxes are not read, save upright ones";

// Other names of columns that may be absent. Tables that have only these are refused, as their
// values would be ignored.
constexpr std::pair<const char*, const char*> kOtherNames[] = {
    {"confidence", "score"}, {"conf", "score"}, {"track_id", kIdColumn}, {"track", kIdColumn}};

// Required columns, and their names in other programs.
const std::pair<const char*, std::vector<const char*>> kLikelyNames[] = {
    {"frame",
     {"frame_id", "frame_index", "frame_number", "image_id", "filename", "file_name", "image",
      "image_name", "image_path"}},
    {"label", {"class", "class_name", "category", "name"}},
    {"x1", {"xmin", "x_min", "left"}},
    {"y1", {"ymin", "y_min", "top"}},
    {"x2", {"xmax", "x_max", "right"}},
    {"y2", {"ymax", "y_max", "bottom"}}};
constexpr std::array kSizes = {"w", "width", "bb_width"};

constexpr const char* kTracks =
    "rows of MOTChallenge and trackers (frame from 1, id, left, top, width, height, score) have no "
    "labels: docs/detections.md has the command that converts them";

// The likely origin of a table without all columns, as the end of a message.
std::string LikelyTable(const std::vector<std::string>& header) {
  const auto has = [&](const char* name) { return std::ranges::count(header, name) > 0; };
  std::vector<std::string> likely;
  bool has_label = has("label");
  for (const auto& [name, others] : kLikelyNames) {
    const auto other = std::ranges::find_if(others, has);
    if (other == others.end() || has(name)) continue;
    has_label = has_label || std::string_view(name) == "label";
    const bool is_frame = std::string_view(name) == "frame";
    likely.push_back(
        fmt::format("{} for {}{}", *other, name,
                    is_frame ? " (the row of its image in the image list, from 0)" : ""));
  }
  if (!has_label && std::ranges::any_of(kSizes, has)) return fmt::format("; {}", kTracks);
  return likely.empty() ? "" : fmt::format("; it may have {}", fmt::join(likely, ", "));
}

LabelledBox ParseBox(const CsvRow& row) {
  for (const char* angle : kAngles) {
    if (!row.fields.contains(angle) || ParseNumber(row.fields.at(angle)).value_or(0.0) == 0.0)
      continue;
    throw InputError(fmt::format("{}: {} is {}; expected {}", row.place, angle,
                                 row.fields.at(angle), kUprightBoxes));
  }
  for (const auto& [other, name] : kOtherNames) {
    if (row.fields.contains(name) || !row.fields.contains(other)) continue;
    throw InputError(fmt::format("{}: column '{}' would be ignored; expected its name to be {}",
                                 row.place_of_header, other, name));
  }
  LabelledBox box{row.place,
                  ParseInteger(row.fields.at("frame"), row.place, "frame"),
                  row.fields.at("label"),
                  row.fields.contains("score") ? row.Real("score") : 1.0,
                  {row.Real("x1"), row.Real("y1"), row.Real("x2"), row.Real("y2")}};
  if (box.label.empty()) throw InputError(row.place + ": label is empty; expected a category");
  const auto field = row.fields.find(kIdColumn);
  if (field != row.fields.end() && !field->second.empty()) {
    // Some programs write a column with gaps as real numbers: 7 is "7.0".
    std::string_view id = field->second;
    if (id.ends_with(".0")) id.remove_suffix(2);
    box.object_id = ParseInteger(id, row.place, kIdColumn);
  }
  return box;
}

}  // namespace

std::vector<LabelledBox> ReadDetectionsCsv(const std::filesystem::path& path) {
  CsvColumns columns{{"frame", "label", "x1", "y1", "x2", "y2"},
                     {"score", kIdColumn},
                     fmt::format("; {}", kTracks),
                     &LikelyTable,
                     "; for other formats set detections_format"};
  columns.optional.insert(columns.optional.end(), kAngles.begin(), kAngles.end());
  for (const auto& [other, name] : kOtherNames) columns.optional.emplace_back(other);
  std::vector<LabelledBox> boxes;
  ForEachCsvRow(path, columns, [&](const CsvRow& row) { boxes.push_back(ParseBox(row)); });
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
  std::map<int, ImageSize> image_sizes;
};

bool HasValue(const JsonEntry& entry, const char* name) {
  return entry.Has(name) && !entry.Field(name).is_null();
}

// The names of the ids in a list; entries without a name count as not there.
std::map<int, std::string> ReadNames(const JsonEntry& document, const char* list_name,
                                     const char* text_name) {
  const std::string place = fmt::format("{}#/{}", document.place(), list_name);
  std::map<int, std::string> names;
  for (const JsonEntry& entry : ListEntries(document.List(list_name), place)) {
    if (!HasValue(entry, text_name)) continue;
    const auto* text = entry.Field(text_name).get_ptr<const std::string*>();
    if (text != nullptr && text->empty()) continue;
    if (!names.emplace(entry.Integer("id"), entry.Text(text_name)).second) {
      entry.Refuse("id", "one that no other entry has");
    }
  }
  return names;
}

CocoNames ReadCocoNames(const json& document, const fs::path& path) {
  const JsonEntry entry(document, path.string());
  CocoNames names;
  if (HasValue(entry, "images")) {
    names.images = ReadNames(entry, "images", "file_name");
    for (const JsonEntry& image : ListEntries(entry.List("images"), entry.place())) {
      // Programs write 0 or null if they do not know a size.
      const auto number = [&](const char* name) {
        return image.Has(name) && image.Field(name).is_number() ? image.Real(name) : 0.0;
      };
      const double width = number("width"), height = number("height");
      if (!IsWholeImageSize(width, height)) continue;
      names.image_sizes[image.Integer("id")] = {static_cast<std::int64_t>(width),
                                                static_cast<std::int64_t>(height)};
    }
  }
  if (HasValue(entry, "categories")) names.categories = ReadNames(entry, "categories", "name");
  return names;
}

const std::string& FindName(const std::map<int, std::string>& names, const JsonEntry& entry,
                            const char* field, const char* list) {
  const auto found = names.find(entry.Integer(field));
  if (found == names.end()) {
    entry.Refuse(field, fmt::format("an id with a name of \"{}\" in the JSON file of the data "
                                    "set{}",
                                    list, names.empty() ? ", which has none" : ""));
  }
  return found->second;
}

FrameKey ParseFrame(const JsonEntry& entry, const std::optional<CocoNames>& names) {
  if (entry.Field("image_id").is_string()) return entry.Text("image_id");
  if (names) return FindName(names->images, entry, "image_id", "images");
  return entry.Integer("image_id");
}

std::string ParseLabel(const JsonEntry& entry, const std::optional<CocoNames>& names) {
  if (names) return FindName(names->categories, entry, "category_id", "categories");
  const auto index = CocoClassIndex(entry.Integer("category_id"));
  if (!index) entry.Refuse("category_id", "a category of COCO, 1 to 90");
  return CocoLabels()[*index];
}

// The number of a field, also as text; none for words and without a value, as attributes have any
// names.
std::optional<double> ReadNumber(const JsonEntry& entry, const char* name) {
  if (!entry.Has(name)) return std::nullopt;
  const json& value = entry.Field(name);
  if (value.is_string()) return ParseNumber(value.get<std::string>());
  return value.is_number() ? std::optional(value.get<double>()) : std::nullopt;
}

// The four numbers of a box, which has no angle. Throws InputError naming what was `expected`.
Eigen::Vector4d BoxNumbers(const JsonEntry& entry, const char* expected) {
  for (const char* angle : kAngles) {
    if (HasValue(entry, angle) && ReadNumber(entry, angle) != 0.0)
      entry.Refuse(angle, kUprightBoxes);
  }
  const json& bbox = entry.Field("bbox");
  if (bbox.is_array() && bbox.size() == 5) {
    entry.Refuse("bbox", fmt::format("{} and {}", expected, kUprightBoxes));
  }
  return entry.Vector<4>("bbox");
}

Box ParseBox(const JsonEntry& entry) {
  constexpr const char* kNumbers = "[x, y, width, height]";
  constexpr const char* kMode = "bbox_mode";  // of detectron2
  if (HasValue(entry, kMode) && entry.Field(kMode) != 1) entry.Refuse(kMode, "1, XYWH_ABS");
  const Eigen::Vector4d xywh = BoxNumbers(entry, kNumbers);
  if (xywh[2] < 0.0 || xywh[3] < 0.0) entry.Refuse("bbox", kNumbers);
  return FromCornerOrigin({xywh[0], xywh[1], xywh[0] + xywh[2], xywh[1] + xywh[3]});
}

// The score under this name; 1 without one. Throws InputError for a score under another name.
double ReadScore(const JsonEntry& entry, const char* name) {
  if (HasValue(entry, name)) return entry.Real(name);
  for (const char* other : {"score", "confidence", "conf"}) {
    if (HasValue(entry, other)) entry.Refuse(other, fmt::format("the score as {}", name));
  }
  return 1.0;
}

std::optional<int> ParseTrack(const JsonEntry& entry, const std::optional<JsonEntry>& attributes) {
  if (HasValue(entry, "track_id")) return entry.Integer("track_id");
  if (!attributes || !HasValue(*attributes, "track_id")) return std::nullopt;
  const json& track = attributes->Field("track_id");
  if (!track.is_string()) return attributes->Integer("track_id");
  const auto text = track.get<std::string>();
  if (text.empty()) return std::nullopt;
  return ParseInteger(text, attributes->place(), "track_id");
}

bool IsTrue(const JsonEntry& entry, const char* name) {
  if (!entry.Has(name)) return false;
  const json& value = entry.Field(name);
  if (value.is_boolean()) return value.get<bool>();
  if (!value.is_string()) return value == 1;
  const std::string word = LowerCase(value.get<std::string>());
  return word == "true" || word == "1";
}

// The first image that has another name in the other file, apart from folders, endings and what
// tools add to the names of copies.
std::optional<int> OtherImage(const CocoNames& names, const CocoNames& others) {
  for (const auto& [id, name] : names.images) {
    const auto other = others.images.find(id);
    const auto is_found = [](const std::string& in, const std::string& key) {
      return FrameLookup({{0.0, in}}).Find(key, "").has_value();
    };
    if (other == others.images.end() || is_found(name, other->second)) continue;
    if (!is_found(other->second, name)) return id;
  }
  return std::nullopt;
}

// Adds what the results' own file has to the names of another file. Its images are those of its
// boxes: if the other file has other ones, it is not used for images.
void AddOwnNames(CocoNames own, const fs::path& results, const fs::path& dataset, CocoNames* names,
                 std::vector<Finding>* findings) {
  for (const auto& [id, name] : names->categories) {
    const auto other = own.categories.find(id);
    if (other == own.categories.end() || AreSameLabel(name, other->second)) continue;
    throw InputError(
        fmt::format("{}: category {} is '{}', but '{}' in {}; expected the same names: leave "
                    "class_names empty if the boxes' own file is right",
                    dataset.string(), id, name, other->second, results.string()));
  }
  names->categories.merge(own.categories);
  if (const auto id = OtherImage(own, *names)) {
    findings->push_back(
        {"image_ids", Severity::kWarning,
         fmt::format("{}: image {} is '{}', but '{}' in {}", results.string(), *id,
                     own.images.at(*id), names->images.at(*id), dataset.string()),
         "the same images in both files; used are those of the boxes' own file",
         "class_names of another data set, or boxes that another program numbered",
         "leave class_names empty if the boxes' own file has categories; otherwise name the file "
         "that the boxes were made with"});
    names->images.clear();
    names->image_sizes.clear();
  }
  own.images.merge(names->images);
  own.image_sizes.merge(names->image_sizes);
  names->images = std::move(own.images);
  names->image_sizes = std::move(own.image_sizes);
}

void ReadEntry(const JsonEntry& entry, const std::optional<CocoNames>& names, FolderBoxes* read) {
  std::optional<JsonEntry> attributes;  // that CVAT adds
  if (entry.Has("attributes") && entry.Field("attributes").is_object()) {
    attributes.emplace(entry.Field("attributes"), entry.place() + "/attributes");
  }
  const bool is_crowd = IsTrue(entry, "iscrowd") || IsTrue(entry, "ignore");
  if (is_crowd || (attributes && IsTrue(*attributes, "outside"))) {
    ++read->left_out[NameOf(is_crowd ? RejectReason::kCrowd : RejectReason::kOutOfView)];
    return;
  }
  LabelledBox box{entry.place(),
                  ParseFrame(entry, names),
                  ParseLabel(entry, names),
                  ReadScore(entry, "score"),
                  ParseBox(entry),
                  ParseTrack(entry, attributes)};
  if (names && entry.Field("image_id").is_number()) {
    const auto size = names->image_sizes.find(entry.Integer("image_id"));
    if (size != names->image_sizes.end()) box.image_size = size->second;
  }
  if (const double angle_deg = attributes ? ReadNumber(*attributes, "rotation").value_or(0.0) : 0.0;
      angle_deg != 0.0) {
    box.as_drawn = {box.box, angle_deg};
    box.box = box.as_drawn->Around();
  }
  read->boxes.push_back(std::move(box));
}

json ParseDatasetFile(const fs::path& path) {
  try {
    return ParseJsonFile(path);
  } catch (const InputError& error) {
    throw InputError(fmt::format(
        "{}: class_names of COCO's results is the file with their \"images\" and \"categories\"",
        error.what()));
  }
}

}  // namespace

FolderBoxes ReadCocoResults(const fs::path& results, const std::optional<fs::path>& dataset) {
  const json document = ParseJsonFile(results);
  auto names =
      dataset ? std::optional(ReadCocoNames(ParseDatasetFile(*dataset), *dataset)) : std::nullopt;
  const bool is_list = document.is_array();
  if (!is_list && (!document.is_object() || !document.contains("annotations"))) {
    throw InputError(results.string() +
                     ": is not a list of results, nor a data set with \"images\", "
                     "\"annotations\" and \"categories\"");
  }
  FolderBoxes read;
  if (!is_list) {
    CocoNames own = ReadCocoNames(document, results);
    if (names) {
      AddOwnNames(std::move(own), results, *dataset, &*names, &read.findings);
    } else {
      names = std::move(own);
    }
  }
  if (names && names->categories.empty()) {
    throw InputError(
        dataset.value_or(results).string() +
        ": categories is missing; expected the names of the classes, {\"id\", \"name\"}");
  }
  const json& list = is_list ? document : JsonEntry(document, results.string()).List("annotations");
  if (!names) read.class_names = CocoLabels();
  for (const JsonEntry& entry :
       ListEntries(list, results.string() + (is_list ? "#" : "#/annotations"))) {
    ReadEntry(entry, names, &read);
  }
  return read;
}

std::vector<LabelledBox> ReadOaSlamBoxes(const std::filesystem::path& path,
                                         const std::vector<std::string>& labels) {
  constexpr const char* kNumbers = "[x1, y1, x2, y2] with x1 <= x2 and y1 <= y2";
  const json images = ParseJsonFile(path);
  if (!images.is_array()) throw InputError(path.string() + ": is not a list of images");
  std::vector<LabelledBox> boxes;
  for (const JsonEntry& image : ListEntries(images, path.string() + "#")) {
    const std::string name = image.Text("file_name");
    for (const JsonEntry& entry :
         ListEntries(image.List("detections"), image.place() + "/detections")) {
      const int category = entry.Integer("category_id");
      if (category < 0 || category >= static_cast<int>(labels.size())) {
        entry.Refuse("category_id", fmt::format("0 to {}", labels.size() - 1));
      }
      const Eigen::Vector4d corners = BoxNumbers(entry, kNumbers);
      if (corners[2] < corners[0] || corners[3] < corners[1]) entry.Refuse("bbox", kNumbers);
      boxes.push_back({entry.place(), name, labels[category], ReadScore(entry, "detection_score"),
                       FromCornerOrigin({corners[0], corners[1], corners[2], corners[3]})});
    }
  }
  return boxes;
}

}  // namespace soslam
