// SPDX-License-Identifier: BSD-3-Clause
#include "association/false_tracks.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "model/occlusion.h"

namespace soslam {
namespace {

constexpr int kNoObject = -1;
// A box counts as occluded when a nearer one covers this share of it.
constexpr double kHiddenShare = 0.5;

double CoveredShare(const Box& box, const Box& by) {
  const double width = std::min(box.x_max, by.x_max) - std::max(box.x_min, by.x_min);
  const double height = std::min(box.y_max, by.y_max) - std::max(box.y_min, by.y_min);
  return std::max(0.0, width) * std::max(0.0, height) / (box.Width() * box.Height());
}

// Number of frames in which the track was detected or should have been: its outline box is inside
// the image, at least as far from the border as all detections are, at least as high as the
// smallest of the track's boxes, and not occluded by a nearer detection.
int FramesInSight(const AssociationModel& model, const Track& track, double border_px) {
  const Sequence& sequence = model.sequence();
  double smallest_height = std::numeric_limits<double>::infinity();
  std::vector<bool> is_detected(sequence.frames.size(), false);
  for (const int index : track.detections) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    smallest_height = std::min(smallest_height, detection.box.Height());
    is_detected[static_cast<size_t>(detection.frame_index)] = true;
  }
  auto frames = static_cast<int>(track.detections.size());
  for (int frame = 0; frame < static_cast<int>(sequence.frames.size()); ++frame) {
    if (is_detected[static_cast<size_t>(frame)]) continue;
    const auto prediction = model.Predict(track, frame);
    if (!prediction) continue;
    const Box& box = prediction->outline;
    const Camera& camera = sequence.CameraOf(sequence.frames[static_cast<size_t>(frame)]);
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
        nearer, [&](const Box& other) { return CoveredShare(box, other) >= kHiddenShare; });
    if (!is_hidden) ++frames;
  }
  return frames;
}

TrackFate FateOf(const AssociationModel& model, const Track& track) {
  const auto detections = static_cast<double>(track.detections.size());
  if (detections < model.options().min_observations) return TrackFate::kTooFewDetections;
  if (!track.fit) return TrackFate::kNoLandmark;
  return detections < model.options().min_detection_share * track.frames_in_sight.value()
             ? TrackFate::kRarelyDetected
             : TrackFate::kObject;
}

}  // namespace

void DropFalseTracks(const AssociationModel& model, int threads, Association* association) {
  const double border_px = SmallestDistanceToBorder(model.sequence());
  ParallelFor("tracks", static_cast<int>(association->tracks.size()), threads, [&](int i) {
    Track& track = association->tracks[static_cast<size_t>(i)];
    if (track.fate == TrackFate::kMerged) return;
    const bool is_candidate =
        track.fit && static_cast<int>(track.detections.size()) >= model.options().min_observations;
    if (is_candidate) track.frames_in_sight = FramesInSight(model, track, border_px);
    track.fate = FateOf(model, track);
  });
}

}  // namespace soslam
