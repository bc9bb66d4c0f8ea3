// SPDX-License-Identifier: BSD-3-Clause
#include "evaluation/map_rows.h"

#include <string>
#include <utility>

#include "base/assignment.h"
#include "evaluation/landmark_errors.h"
#include "evaluation/map_matching.h"
#include "evaluation/statistics.h"

namespace soslam {

RowMaker::RowMaker(const Sequence& sequence, const AlignedMap& map, const TrueViews& views)
    : sequence_(sequence), map_(map), views_(views), detections_(DetectionsByObject(sequence)) {}

// Whether most of the boxes of which the dataset says whose they are are the true object's; none
// where it says it of no box.
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
      sequence_.objects[static_cast<size_t>(row->object_index)].label == object.label;
  if (const auto& plane = map_.plane_of_landmark[landmark])
    row->plane = ComparePlane(*plane, truth);
}

std::vector<LandmarkRow> RowMaker::Rows(const std::vector<int>& truth_of_landmark) const {
  std::vector<LandmarkRow> rows;
  for (size_t i = 0; i < map_.landmarks.size(); ++i) {
    const AlignedLandmark& landmark = map_.landmarks[i];
    const std::string& label = sequence_.objects[static_cast<size_t>(landmark.object_index)].label;
    LandmarkRow row;
    row.object_index = landmark.object_index;
    const int truth = truth_of_landmark[i];
    if (truth != kUnassigned && sequence_.true_objects[static_cast<size_t>(truth)].is_ignored) {
      row.fate = LandmarkRow::Fate::kIgnored;
    } else if (truth != kUnassigned) {
      row.fate = LandmarkRow::Fate::kFound;
      row.true_index = truth;
      CompareInWorld(i, &row);
      CompareInFrames(i, &row);
      row.wrong = PartToBlame(sequence_, map_, static_cast<int>(i), *row.true_index);
      row.id_agrees = MostIdsAgree(row);
    } else if (IsIgnored(sequence_.ignored, label, landmark.landmark_in_world)) {
      row.fate = LandmarkRow::Fate::kIgnored;
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace soslam
