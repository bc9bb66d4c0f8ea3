// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/class_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/text_file.h"
#include "soslam/dataset/yaml_fields.h"
#include "soslam/image/file_kind.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// File names used by programs. The last one is also that of other lists, so that it counts only
// beside the labels.
constexpr std::array kNames = {"classes.txt", "obj.names",    "data.yaml",
                               "data.yml",    "dataset.yaml", "labels.txt"};

std::vector<std::string> SplitNames(std::string_view names) {
  const auto fields = SplitFields(names);
  return {fields.begin(), fields.end()};
}

void CheckName(const std::string& name, const std::string& place) {
  if (!name.empty() && name.find(',') == name.npos) return;
  throw InputError(
      fmt::format("{}: label is '{}'; expected names, each without a comma", place, name));
}

// The names in a text; none where it has none.
std::vector<std::string> NamesIn(const std::string& text, const std::string& name) {
  std::vector<std::string> names;
  const fs::path extension = fs::path(name).extension();
  if (extension != ".yaml" && extension != ".yml") {
    if (const std::string kind = FileKind(text); !kind.empty()) {
      throw InputError(fmt::format(
          "{}: is {}; expected the names of the classes, one a line, or data.yaml of YOLO", name,
          kind));
    }
    for (const TextLine& line : TextLines(text, name)) {
      CheckName(line.text, line.place);
      names.push_back(line.text);
    }
    return names;
  }
  const NamedFields fields = YamlFields(text, name);
  const auto list = fields.find("names");
  if (list != fields.end()) {
    names = list->second;
  } else {
    // Names under the keys "names.0", "names.1", ...
    for (;;) {
      const auto found = fields.find(fmt::format("names.{}", names.size()));
      if (found == fields.end()) break;
      names.push_back(found->second.empty() ? "" : found->second.front());
    }
    const auto numbered = std::ranges::count_if(
        fields, [](const auto& field) { return field.first.starts_with("names."); });
    if (static_cast<size_t>(numbered) != names.size()) {
      throw InputError(fmt::format(
          "{}: names has {} entries, but none for class {}; expected one for each class from 0 on",
          name, numbered, names.size()));
    }
  }
  for (const std::string& listed : names) CheckName(listed, name);
  return names;
}

}  // namespace

std::vector<std::string> ReadLabelFile(const fs::path& path) {
  return ParseLabels(ReadWholeFile(path), path.string());
}

std::vector<std::string> ParseLabels(const std::string& text, const std::string& name) {
  std::vector<std::string> names = NamesIn(text, name);
  if (names.empty()) throw InputError(name + ": has no label; expected the names of the classes");
  return names;
}

ClassNames FindLabels(const fs::path& place, const std::function<std::string()>& read) {
  try {
    return {place, NamesIn(read(), place.string())};
  } catch (const InputError& error) {
    return {place, {}, error.what()};
  }
}

namespace {

auto Depth(const ClassNames& list) { return std::distance(list.place.begin(), list.place.end()); }

// The first class with different names.
std::optional<std::string> Contradiction(const ClassNames& one, const ClassNames& other) {
  for (size_t i = 0; i < std::min(one.names.size(), other.names.size()); ++i) {
    if (AreSameLabel(one.names[i], other.names[i])) continue;
    return fmt::format("{}: class {} is '{}', but '{}' in {}", one.place.string(), i, one.names[i],
                       other.names[i], other.place.string());
  }
  return std::nullopt;
}

// The names that labelImg comes with, and writes beside labels (classes.txt) until they are
// changed.
const std::vector<std::string> kLabelImgTemplate = SplitNames(
    "dog,person,cat,tv,car,meatballs,marinara sauce,tomato sauce,chicken noodle soup,"
    "french onion soup,chicken breast,ribs,pulled pork,hamburger,cavity");

// Removes labelImg's template where another list contradicts it, which is a finding.
void RemoveTemplates(std::vector<ClassNames>* lists, std::vector<Finding>* findings) {
  const auto is_template = [](const ClassNames& list) { return list.names == kLabelImgTemplate; };
  const auto other = std::ranges::find_if(
      *lists, [&](const ClassNames& list) { return !list.names.empty() && !is_template(list); });
  if (other == lists->end()) return;
  const ClassNames used = *other;
  std::erase_if(*lists, [&](const ClassNames& list) {
    const auto contradiction = is_template(list) ? Contradiction(list, used) : std::nullopt;
    if (!contradiction) return false;
    findings->push_back({"class_names", Severity::kWarning, *contradiction,
                         fmt::format("the names in {}, which are used", used.place.string()),
                         "the names that labelImg comes with, which it writes beside its labels",
                         "remove that file, or name it as class_names if its names are right"});
    return true;
  });
}

}  // namespace

std::optional<ClassNames> NearestNames(std::vector<ClassNames> lists,
                                       std::vector<Finding>* findings) {
  std::erase_if(lists, [](const ClassNames& list) { return list.names.empty() && !list.error; });
  if (lists.empty()) return std::nullopt;
  RemoveTemplates(&lists, findings);
  std::ranges::stable_sort(lists, std::ranges::greater(), Depth);
  const auto nearest =
      std::ranges::find_if(lists, [](const ClassNames& list) { return !list.error; });
  if (nearest == lists.end() || Depth(*nearest) < Depth(lists.front())) {
    throw InputError(*lists.front().error);
  }
  for (const ClassNames& other : lists) {
    if (const auto contradiction = Contradiction(*nearest, other)) {
      throw InputError(*contradiction +
                       "; expected the same names: remove the file that is not of these boxes, or "
                       "name the right one as class_names");
    }
    if (!other.error) continue;
    findings->push_back({"class_names", Severity::kWarning, *other.error,
                         fmt::format("the names in {}, which is used as the nearest to the boxes",
                                     nearest->place.string()),
                         "a list of other boxes, or of another program",
                         "name the right list as class_names, or remove the other"});
  }
  return *nearest;
}

bool IsListed(const std::string& label, const std::string& list) {
  const auto listed = SplitFields(list);
  return Trimmed(list).empty() || std::ranges::find(listed, label) != listed.end();
}

bool IsLabelFile(const fs::path& name) {
  return std::ranges::find(kNames, name.filename().string()) != kNames.end();
}

std::vector<fs::path> FindLabelFiles(const fs::path& labels, const fs::path& dataset) {
  std::vector<fs::path> files;
  fs::path folder = IsFolder(labels) ? PlainPath(labels) : PlainPath(labels).parent_path();
  // For labels outside the dataset only their parent folder is searched.
  bool may_leave = IsFolder(labels) && !IsWithin(folder, dataset);
  for (bool is_of_labels = true;; is_of_labels = false) {
    for (const char* name : kNames) {
      if (name == kNames.back() && !is_of_labels) continue;
      if (IsFile(folder / name)) files.push_back(folder / name);
    }
    if (folder == folder.parent_path()) return files;  // the root
    folder = folder.parent_path();
    if (!IsWithin(folder, dataset) && !std::exchange(may_leave, false)) return files;
  }
}

const std::vector<std::string>& CocoLabels() {
  static const std::vector<std::string> labels = SplitNames(
      "person,bicycle,car,motorcycle,airplane,bus,train,truck,boat,traffic light,fire hydrant,"
      "stop sign,parking meter,bench,bird,cat,dog,horse,sheep,cow,elephant,bear,zebra,giraffe,"
      "backpack,umbrella,handbag,tie,suitcase,frisbee,skis,snowboard,sports ball,kite,"
      "baseball bat,baseball glove,skateboard,surfboard,tennis racket,bottle,wine glass,cup,fork,"
      "knife,spoon,bowl,banana,apple,sandwich,orange,broccoli,carrot,hot dog,pizza,donut,cake,"
      "chair,couch,potted plant,bed,dining table,toilet,tv,laptop,mouse,remote,keyboard,"
      "cell phone,microwave,oven,toaster,sink,refrigerator,book,clock,vase,scissors,teddy bear,"
      "hair drier,toothbrush");
  return labels;
}

int CocoCategoryId(int class_index) {
  // Ids of dropped categories below 90; 91 was dropped, too.
  constexpr std::array kUnusedIds = {12, 26, 29, 30, 45, 66, 68, 69, 71, 83};
  int category_id = class_index + 1;
  for (const int unused_id : kUnusedIds) {
    if (category_id >= unused_id) ++category_id;
  }
  return category_id;
}

std::optional<int> CocoClassIndex(int category_id) {
  for (int i = 0; i < std::ssize(CocoLabels()); ++i) {
    if (CocoCategoryId(i) == category_id) return i;
  }
  return std::nullopt;
}

}  // namespace soslam
