// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/dataset/soslam_folder.h"

namespace soslam {
std::vector<LabelledBox> SeparateUntrackedBoxes(std::vector<LabelledBox> boxes,
                                                const std::vector<ListedObject>& objects,
                                                const std::filesystem::path& file,
                                                std::vector<LabelledBox>* left_out,
                                                std::vector<Finding>* findings) {
  if (!HaveObjectIds(boxes)) return boxes;
  std::set<int> listed;
  for (const ListedObject& object : objects) listed.insert(object.id);
  std::map<std::pair<FrameKey, int>, int> counts;
  std::map<int, int> images;  // number of images in which an id occurs more than once
  bool has_others = false;
  for (const LabelledBox& box : boxes) {
    if (!box.object_id || *box.object_id < 0) continue;
    if (++counts[{box.frame, *box.object_id}] == 2) ++images[*box.object_id];
    has_others = has_others || *box.object_id > 0;
  }
  const bool zero_is_of_none =
      images.size() == 1 && images.contains(0) && images.at(0) >= (has_others ? 2 : 1);
  std::set<int> ids_of_none;
  for (LabelledBox& box : boxes) {
    if (!box.object_id || listed.contains(*box.object_id)) continue;
    if (*box.object_id > 0 || (*box.object_id == 0 && !zero_is_of_none)) continue;
    ids_of_none.insert(*box.object_id);
    box.object_id.reset();
  }
  const std::string which = ids_of_none.empty()
                                ? "no object_id"
                                : fmt::format("object_id {}", fmt::join(ids_of_none, ", "));
  if (!HaveObjectIds(boxes)) {
    findings->push_back(
        {"object_ids", Severity::kWarning,
         fmt::format("{}: all {} boxes have {}, that of no track", file.filename().string(),
                     boxes.size(), which),
         "an id for each object, or no object_id",
         "boxes of a detector, or of a tracker that found no track: nobody has said which are of "
         "one object",
         "leave object_id away, and let association be estimated (setting of soslam-associate)"});
    return boxes;
  }
  const auto first_without = std::stable_partition(
      boxes.begin(), boxes.end(), [](const LabelledBox& box) { return box.object_id.has_value(); });
  left_out->assign(std::make_move_iterator(first_without), std::make_move_iterator(boxes.end()));
  boxes.erase(first_without, boxes.end());
  const size_t without = left_out->size();
  if (without == 0) return boxes;
  fmt::print("{}: {} of {} boxes have {}, that of no track, and are not used\n",
             file.filename().string(), without, without + boxes.size(), which);
  return boxes;
}

bool HaveObjectIds(const std::vector<LabelledBox>& boxes) {
  return std::ranges::any_of(boxes,
                             [](const LabelledBox& box) { return box.object_id.has_value(); });
}

int UnifyLabels(const std::vector<ListedObject>& objects, std::vector<DetectionRow>* rows) {
  struct Votes {
    int rows = 0;
    double score = 0.0;
  };
  std::map<int, std::map<std::string, Votes>> ballots;  // by object and label
  for (const DetectionRow& row : *rows) {
    Votes& votes = ballots[row.object_id][row.label];
    ++votes.rows;
    votes.score += row.score;
  }
  const auto rows_and_score = [](const auto& entry) {
    return std::pair(entry.second.rows, entry.second.score);
  };
  std::map<int, std::string> labels;
  for (const auto& [id, ballot] : ballots) {
    labels[id] = std::ranges::max_element(ballot, {}, rows_and_score)->first;
  }
  for (const ListedObject& object : objects) {
    const auto ballot = ballots.find(object.id);
    if (ballot == ballots.end()) continue;
    int all = 0, others = 0;
    for (const auto& [label, votes] : ballot->second) {
      all += votes.rows;
      if (label != object.label) others += votes.rows;
    }
    if (2 * others > all) {
      const auto other = std::ranges::find_if(*rows, [&](const DetectionRow& row) {
        return row.object_id == object.id && row.label != object.label;
      });
      throw InputError(fmt::format(
          "{}: label of object {} is '{}', as another than '{}' is in {} of its {} boxes; expected "
          "'{}', as in objects.json",
          other->place, object.id, other->label, object.label, others, all, object.label));
    }
    labels[object.id] = object.label;
  }
  int changed = 0;
  for (DetectionRow& row : *rows) {
    if (row.label == labels.at(row.object_id)) continue;
    row.label = labels.at(row.object_id);
    ++changed;
  }
  return changed;
}

namespace {

int PlaneIndex(const ListedObject& object, const std::vector<SupportPlane>& planes,
               const std::string& file, bool may_be_unknown) {
  if (planes.empty()) return kNoPlane;
  if (!object.plane_id) {
    if (planes.size() == 1) return 0;
    if (may_be_unknown) return kNoPlane;
    throw InputError(
        fmt::format("{}: object {} ('{}') has no support_plane; expected one, as there are {} "
                    "planes; or no planes.json, where they are to be estimated",
                    file, object.id, object.label, planes.size()));
  }
  const auto plane = std::ranges::find(planes, *object.plane_id, &SupportPlane::id);
  if (plane != planes.end()) return static_cast<int>(plane - planes.begin());
  throw InputError(
      fmt::format("{}: support_plane of object {} is {}; expected an id of planes.json", file,
                  object.id, *object.plane_id));
}

}  // namespace

std::vector<Object> ListObjects(const DatasetFiles& files, const std::vector<ListedObject>& given,
                                const std::vector<DetectionRow>& rows,
                                const std::vector<SupportPlane>& planes, bool has_object_ids) {
  std::vector<Object> objects;
  std::set<int> ids;
  const auto add = [&](const ListedObject& object, const std::filesystem::path& file) {
    if (!ids.insert(object.id).second) return;
    const int plane = PlaneIndex(object, planes, file.string(), !has_object_ids);
    objects.push_back({object.id, object.label, plane, object.ground_truth});
  };
  for (const ListedObject& object : given) add(object, files.objects.value_or(files.detections));
  for (const DetectionRow& row : rows) {
    add({row.object_id, row.label, std::nullopt, std::nullopt}, files.detections);
  }
  std::ranges::sort(objects, {}, &Object::id);
  return objects;
}

}  // namespace soslam
