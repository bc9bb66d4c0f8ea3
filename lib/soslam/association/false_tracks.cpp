// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <vector>

#include "soslam/association/association_model.h"
#include "soslam/association/moved_things.h"
#include "soslam/base/parallel.h"
#include "soslam/model/occlusion.h"

namespace soslam {
namespace {

constexpr int kNoObject = -1;
// A box counts as occluded when a nearer one covers this share of it.
constexpr double kHiddenShare = 0.5;

}  // namespace

std::vector<Miss> FindMisses(const AssociationModel& model, const Track& track) {
  const Sequence& sequence = model.sequence();
  std::vector<bool> is_detected(sequence.frames.size(), false);
  for (const int index : track.detections) {
    is_detected[model.DetectionAt(index).frame_index] = true;
  }
  std::vector<Miss> misses;
  for (int frame = 0; frame < static_cast<int>(sequence.frames.size()); ++frame) {
    if (is_detected[frame]) continue;
    const auto prediction = model.Predict(track, frame);
    if (!prediction) continue;
    const Box& box = prediction->outline;
    const Camera& camera = sequence.CameraOf(sequence.frames[frame]);
    const double border_px = DistanceToBorder(box, camera.width, camera.height);
    if (border_px < 0.0) continue;
    Detection expected;
    expected.frame_index = frame;
    expected.object_index = kNoObject;
    expected.box = box;
    expected.plane_in_camera = ComputeSupportPlane(prediction->landmark_in_camera);
    const std::vector<Box> nearer = NearerBoxes(sequence, expected);
    const bool is_hidden = std::ranges::any_of(
        nearer, [&](const Box& by) { return CommonArea(box, by) / box.Area() >= kHiddenShare; });
    if (!is_hidden) misses.push_back({frame, box, border_px});
  }
  return misses;
}

void DropFalseTracks(const AssociationModel& model, int threads, Association* association) {
  const double border_px = SmallestDistanceToBorder(model.sequence());
  ParallelFor("tracks", association->tracks.size(), threads, [&](size_t i) {
    Track& track = association->tracks[i];
    bool is_whole = false;
    double best_score = 0.0;
    double smallest_height = std::numeric_limits<double>::infinity();
    for (const int index : track.detections) {
      const Detection& detection = model.DetectionAt(index);
      if (std::ranges::count(detection.is_one_sided, true) == 0) is_whole = true;
      best_score = std::max(best_score, detection.score);
      smallest_height = std::min(smallest_height, detection.box.Height());
    }
    const AssociateOptions& options = model.options();
    const bool has_detections = std::ssize(track.detections) >= options.min_observations;
    if (track.fit && has_detections) {
      if (!is_whole && !track.by_hand) track.overlap_by_boxes = model.OverlapByBoxes(track);
      track.frames_in_sight = static_cast<int>(
          track.detections.size() +
          std::ranges::count_if(FindMisses(model, track), [&](const Miss& miss) {
            return miss.border_px >= border_px && miss.outline.Height() >= smallest_height;
          }));
    }
    const auto fate = [&] {
      if (track.by_hand && track.by_hand->is_deleted) return TrackFate::kDeleted;
      if (track.by_hand) return track.fit ? TrackFate::kObject : TrackFate::kNoLandmark;
      if (!has_detections) return TrackFate::kTooFewDetections;
      if (!track.fit) return TrackFate::kNoLandmark;
      if (track.overlap_by_boxes && *track.overlap_by_boxes < options.min_overlap_by_boxes) {
        return TrackFate::kUndetermined;
      }
      if (!track.has_support) return TrackFate::kNoSupport;
      if (model.Moves(track)) return TrackFate::kMoves;
      if (best_score < options.min_best_score) return TrackFate::kLowScores;
      const double least = options.min_detection_share * track.frames_in_sight.value();
      return static_cast<double>(track.detections.size()) < least ? TrackFate::kRarelyDetected
                                                                  : TrackFate::kObject;
    };
    track.fate = fate();
  });
}

}  // namespace soslam
