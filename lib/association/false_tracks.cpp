// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "association/association_model.h"
#include "base/parallel.h"
#include "model/occlusion.h"

namespace soslam {
namespace {

constexpr int kNoObject = -1;
// A box counts as occluded when a nearer one covers this share of it.
constexpr double kHiddenShare = 0.5;

// Number of frames in which the track was detected or should have been: its outline box is inside
// the image, at least as far from the border as all detections are, at least as high as the
// smallest of the track's boxes, and not occluded by a nearer detection.
int FramesInSight(const AssociationModel& model, const Track& track, double border_px) {
  const Sequence& sequence = model.sequence();
  double smallest_height = std::numeric_limits<double>::infinity();
  std::vector<bool> is_detected(sequence.frames.size(), false);
  for (const int index : track.detections) {
    const Detection& detection = model.DetectionAt(index);
    smallest_height = std::min(smallest_height, detection.box.Height());
    is_detected[detection.frame_index] = true;
  }
  auto frames = static_cast<int>(track.detections.size());
  for (int frame = 0; frame < static_cast<int>(sequence.frames.size()); ++frame) {
    if (is_detected[frame]) continue;
    const auto prediction = model.Predict(track, frame);
    if (!prediction) continue;
    const Box& box = prediction->outline;
    const Camera& camera = sequence.CameraOf(sequence.frames[frame]);
    if (box.Height() < smallest_height ||
        DistanceToBorder(box, camera.width, camera.height) < border_px) {
      continue;
    }
    Detection expected;
    expected.frame_index = frame;
    expected.object_index = kNoObject;
    expected.box = box;
    expected.plane_in_camera = SupportPlaneOf(prediction->landmark_in_camera);
    const std::vector<Box> nearer = NearerBoxes(sequence, expected);
    const bool is_hidden = std::ranges::any_of(
        nearer, [&](const Box& by) { return CommonArea(box, by) / box.Area() >= kHiddenShare; });
    if (!is_hidden) ++frames;
  }
  return frames;
}

}  // namespace

void DropFalseTracks(const AssociationModel& model, int threads, Association* association) {
  const double border_px = SmallestDistanceToBorder(model.sequence());
  ParallelFor("tracks", association->tracks.size(), threads, [&](size_t i) {
    Track& track = association->tracks[i];
    int three_edges = 0;  // detections that show at least three of its edges
    bool is_whole = false;
    double best_score = 0.0;
    for (const int index : track.detections) {
      const Detection& detection = model.DetectionAt(index);
      const auto hidden_edges = std::ranges::count(detection.is_one_sided, true);
      if (hidden_edges <= 1) ++three_edges;
      if (hidden_edges == 0) is_whole = true;
      best_score = std::max(best_score, detection.score);
    }
    const AssociateOptions& options = model.options();
    const bool has_detections = three_edges >= options.min_observations;
    if (track.fit && has_detections) track.frames_in_sight = FramesInSight(model, track, border_px);
    const auto fate = [&] {
      if (track.by_hand && track.by_hand->is_deleted) return TrackFate::kDeleted;
      if (track.by_hand) return track.fit ? TrackFate::kObject : TrackFate::kNoLandmark;
      if (!has_detections) return TrackFate::kTooFewDetections;
      if (!is_whole) return TrackFate::kNeverWhole;
      if (!track.fit) return TrackFate::kNoLandmark;
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
