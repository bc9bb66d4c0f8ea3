// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/true_views.h"

namespace soslam {

TrueViews::TrueViews(const Sequence& sequence) : sequence_(sequence) {
  for (const TruthInFrame& truth : sequence.truth_in_frames) {
    of_frames_[truth.true_object_id][truth.frame_index] = &truth.landmark_in_camera;
  }
}

std::optional<Landmark> TrueViews::FromPose(const Rigid3d& world_from_camera, int frame_index,
                                            const TrueObject& object) const {
  const Frame& frame = sequence_.frames[frame_index];
  if (!object.is_static || object.segment != frame.segment) return std::nullopt;
  return Transform(world_from_camera.Inverse(), object.truth.landmark_in_world);
}

std::optional<Landmark> TrueViews::KnownInCamera(int frame_index, int true_index) const {
  const TrueObject& object = sequence_.true_objects[true_index];
  if (const auto own = of_frames_.find(object.id); own != of_frames_.end()) {
    const auto known = own->second.find(frame_index);
    return known == own->second.end() ? std::nullopt : std::optional(*known->second);
  }
  const auto& pose = sequence_.frames[frame_index].true_world_from_camera;
  return pose ? FromPose(*pose, frame_index, object) : std::nullopt;
}

std::optional<Landmark> TrueViews::InCamera(int frame_index, int true_index) const {
  const Frame& frame = sequence_.frames[frame_index];
  const TrueObject& object = sequence_.true_objects[true_index];
  if (of_frames_.contains(object.id) || frame.true_world_from_camera) {
    return KnownInCamera(frame_index, true_index);
  }
  if (sequence_.odometry_world != OdometryWorld::kOfTruth) return std::nullopt;
  return FromPose(frame.world_from_camera, frame_index, object);
}

ViewsOfTruth FindViews(const Sequence& sequence, const TrueViews& views) {
  // Assumed shape exponent of true objects, whose shape is unknown: between a cuboid and an
  // ellipsoid, like most things.
  constexpr double kOutlineShapeExponent = 1.25;
  // A raw detection, used or not.
  struct RawBox {
    TrueView view;
    Box box;
  };
  ViewsOfTruth found;
  found.of_object.resize(sequence.true_objects.size());
  found.detected_frames.resize(sequence.true_objects.size());
  found.object_of_detection.resize(sequence.detections.size());
  std::vector<std::vector<RawBox>> raw_boxes(sequence.frames.size());
  const auto add = [&](const TrueView& view, double score, const Box& box) {
    if (score >= kMinViewScore) raw_boxes[view.frame_index].push_back({view, box});
  };
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& seen = sequence.detections[i];
    add({seen.frame_index, static_cast<int>(i), std::nullopt}, seen.score, seen.box);
  }
  for (size_t i = 0; i < sequence.rejected.size(); ++i) {
    const RejectedDetection& seen = sequence.rejected[i];
    add({seen.frame_index, std::nullopt, static_cast<int>(i)}, seen.score, seen.box);
  }
  for (size_t frame = 0; frame < raw_boxes.size(); ++frame) {
    if (raw_boxes[frame].empty()) continue;
    const Camera& camera = sequence.CameraOf(sequence.frames[frame]);
    std::vector<std::optional<Box>> outlines(sequence.true_objects.size());
    for (size_t i = 0; i < outlines.size(); ++i) {
      auto landmark = views.InCamera(static_cast<int>(frame), static_cast<int>(i));
      if (!landmark) continue;
      landmark->shape_exponents = kOutlineShapeExponent;
      const auto box = OutlineBox(camera, *landmark);
      if (box) outlines[i] = CutToImage(*box, camera.width, camera.height);
    }
    std::vector<bool> is_detected(outlines.size());
    for (const RawBox& raw : raw_boxes[frame]) {
      double best = kMinViewIou;
      std::optional<size_t> object;
      for (size_t i = 0; i < outlines.size(); ++i) {
        const double overlap = outlines[i] ? BoxOverlap(raw.box, *outlines[i]) : 0.0;
        if (overlap >= kMinViewIou) is_detected[i] = true;
        if (overlap < best || (object && overlap == best)) continue;
        best = overlap;
        object = i;
      }
      if (!object) continue;
      found.of_object[*object].push_back(raw.view);
      if (raw.view.detection_index) {
        found.object_of_detection[*raw.view.detection_index] = static_cast<int>(*object);
      }
    }
    for (size_t i = 0; i < outlines.size(); ++i) found.detected_frames[i] += is_detected[i] ? 1 : 0;
  }
  return found;
}

}  // namespace soslam
