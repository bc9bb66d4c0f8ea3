// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/object_ids.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace soslam {
namespace {

// Number of images in which each id occurs more than once; without ids below 0.
std::map<int, int> ImagesWithSeveral(const std::vector<LabelledBox>& boxes) {
  std::map<std::pair<FrameKey, int>, int> counts;
  std::map<int, int> images;
  for (const LabelledBox& box : boxes) {
    if (!box.object_id || *box.object_id < 0) continue;
    if (++counts[{box.frame, *box.object_id}] == 2) ++images[*box.object_id];
  }
  return images;
}

bool ZeroIsOfNoTrack(const std::vector<LabelledBox>& boxes) {
  const bool has_others = std::ranges::any_of(
      boxes, [](const LabelledBox& box) { return box.object_id && *box.object_id > 0; });
  const auto images = ImagesWithSeveral(boxes);
  return images.size() == 1 && images.contains(0) && images.at(0) >= (has_others ? 2 : 1);
}

}  // namespace

std::vector<LabelledBox> WithoutIdsOfNoTrack(std::vector<LabelledBox> boxes,
                                             const std::vector<ListedObject>& objects,
                                             const std::filesystem::path& file,
                                             std::vector<LabelledBox>* left_out,
                                             std::vector<Finding>* findings) {
  if (!HaveObjectIds(boxes)) return boxes;
  std::set<int> listed;
  for (const ListedObject& object : objects) listed.insert(object.id);
  const bool zero_is_of_none = ZeroIsOfNoTrack(boxes);
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

}  // namespace soslam
