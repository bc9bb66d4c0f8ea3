// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/map_rows.h"

#include <string>

#include "base/assignment.h"
#include "evaluation/landmark_errors.h"
#include "evaluation/map_matching.h"
#include "evaluation/statistics.h"
#include "initialisation/semantic_table.h"

namespace soslam {

RowMaker::RowMaker(const Sequence& sequence, const AlignedMap& map, const TrueViews& views)
    : sequence_(sequence), map_(map), views_(views), detections_(DetectionsByObject(sequence)) {}

// True if most of the boxes with a true object id in the dataset have that of the row's true
// object; none if no box has an id.
std::optional<bool> RowMaker::MostIdsAgree(const LandmarkRow& row) const {
  const int true_id = sequence_.true_objects[static_cast<size_t>(row.true_index.value())].id;
  int known = 0;
  int agreeing = 0;
  for (const int index : detections_[static_cast<size_t>(row.object_index)]) {
    const auto& id = sequence_.detections[static_cast<size_t>(index)].true_object_id;
    known += id ? 1 : 0;
    agreeing += id == true_id ? 1 : 0;
  }
  return known > 0 ? std::optional(2 * agreeing > known) : std::nullopt;
}

void RowMaker::CompareInFrames(size_t landmark, LandmarkRow* row) const {
  const int true_index = row->true_index.value();
  const TrueObject& object = sequence_.true_objects[static_cast<size_t>(true_index)];
  std::vector<double> ious, centres;
  for (const int index : detections_[static_cast<size_t>(row->object_index)]) {
    const int frame = sequence_.detections[static_cast<size_t>(index)].frame_index;
    const auto truth_in_camera = views_.KnownInCamera(frame, true_index);
    if (!truth_in_camera) continue;
    const Landmark estimate_in_camera =
        Transform(map_.world_from_camera[static_cast<size_t>(frame)].Inverse(),
                  map_.landmarks[landmark].landmark_in_world);
    const LandmarkErrors errors =
        CompareLandmarks(estimate_in_camera, object.truth, *truth_in_camera);
    ious.push_back(errors.iou);
    centres.push_back(errors.centre_m);
  }
  if (ious.empty()) return;
  row->in_frames = InFrames{static_cast<int>(ious.size()), *MeanOf(ious), *MeanOf(centres)};
}

void RowMaker::CompareInWorld(size_t landmark, LandmarkRow* row) const {
  const TrueObject& object = sequence_.true_objects[static_cast<size_t>(row->true_index.value())];
  const Landmark& truth = object.truth.landmark_in_world;
  row->errors = CompareBodies(map_.landmarks[landmark].landmark_in_world, object.truth, truth);
  row->label_agrees =
      AreSameLabel(sequence_.objects[static_cast<size_t>(row->object_index)].label, object.label);
  if (const auto& plane = map_.plane_of_landmark[landmark])
    row->plane = ComparePlane(*plane, truth);
}

LandmarkRow RowMaker::Found(size_t landmark, int true_index) const {
  LandmarkRow row;
  row.object_index = map_.landmarks[landmark].object_index;
  row.fate = LandmarkRow::Fate::kFound;
  row.true_index = true_index;
  CompareInWorld(landmark, &row);
  CompareInFrames(landmark, &row);
  row.wrong = DominantError(sequence_, map_, static_cast<int>(landmark), true_index);
  row.id_agrees = MostIdsAgree(row);
  return row;
}

LandmarkRow RowMaker::NotFound(const ReasonInput& input, size_t landmark) const {
  LandmarkRow row;
  row.object_index = map_.landmarks[landmark].object_index;
  const Explanation why = ExplainFalse(input, static_cast<int>(landmark));
  const bool is_of_wanted =
      why.true_object && sequence_.true_objects[static_cast<size_t>(*why.true_object)].IsWanted();
  const std::string& label = sequence_.objects[static_cast<size_t>(row.object_index)].label;
  if (!is_of_wanted && IsIgnored(sequence_, label, map_.landmarks[landmark])) {
    row.fate = LandmarkRow::Fate::kIgnored;
    return row;
  }
  row.why_false = why;
  row.true_index = why.true_object;
  if (!is_of_wanted) return row;
  CompareInWorld(landmark, &row);
  if (IsWrong(why.reason)) CompareInFrames(landmark, &row);
  return row;
}

std::vector<LandmarkRow> RowMaker::Rows(const ReasonInput& input) const {
  std::vector<LandmarkRow> rows;
  for (size_t i = 0; i < map_.landmarks.size(); ++i) {
    const int truth = input.truth_of_landmark[i];
    rows.push_back(truth == kUnassigned ? NotFound(input, i) : Found(i, truth));
  }
  return rows;
}

}  // namespace soslam
