// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "soslam/evaluation/metrics.h"
#include "soslam/geometry/angles.h"
#include "support/random.h"

namespace soslam {

// A wall of true objects, 7 in a row, 0.4 m wide and 0.4 m apart, 5 m in front of a camera that
// goes by, and a map of what the test says was made of them.
class MapQualityTest : public testing::Test {
 protected:
  static constexpr int kFrames = 6;
  inline static const Eigen::Vector3d kCube = Eigen::Vector3d::Constant(0.2);

  MapQualityTest() {
    sequence_.camera = TestCamera();
    const Eigen::Quaterniond world_from_camera(
        (Eigen::Matrix3d() << 1, 0, 0, 0, 0, 1, 0, -1, 0).finished());
    for (int i = 0; i < kFrames; ++i) {
      Frame& frame = sequence_.frames.emplace_back();
      frame.id = i;
      frame.world_from_camera = {world_from_camera,
                                 {0.1 * i - 0.25, 0.02 * i * i, 1.5 + 0.03 * std::sin(2.0 * i)}};
      frame.true_world_from_camera = frame.world_from_camera;
    }
    sequence_.planes.push_back({0, {Eigen::Vector3d::UnitZ(), 0.0}});
  }

  int AddTruth(const Eigen::Vector3d& half_axes = kCube) {
    const auto index = static_cast<int>(sequence_.true_objects.size());
    TrueObject& object = sequence_.true_objects.emplace_back();
    object.id = 10 + index;
    object.label = "box";
    object.truth.landmark_in_world.half_axes = half_axes;
    object.truth.landmark_in_world.frame_from_object.translation = {
        0.8 * (index % 7) - 2.4, 5.0, 1.1 * (index / 7) + half_axes.z()};
    return index;
  }
  Landmark Truth(int index) const { return sequence_.true_objects[index].truth.landmark_in_world; }
  Landmark Shifted(int index, const Eigen::Vector3d& shift) const {
    Landmark landmark = Truth(index);
    landmark.frame_from_object.translation += shift;
    return landmark;
  }

  int AddObject(const std::string& label = "box") {
    const auto index = static_cast<int>(sequence_.objects.size());
    sequence_.objects.push_back({100 + index, label, 0, {}});
    estimates_.push_back({index, 0, std::nullopt, std::nullopt, ""});
    return index;
  }
  int AddLandmark(const Landmark& landmark, const std::string& label = "box") {
    const int object = AddObject(label);
    estimates_[object].landmark_in_world = landmark;
    return object;
  }

  // The box of a body in a frame.
  Box BoxOf(const Landmark& landmark, int frame) const {
    Landmark in_camera =
        Transform(sequence_.frames[frame].true_world_from_camera->Inverse(), landmark);
    in_camera.shape_exponents = kCuboidExponent;
    return OutlineBox(sequence_.camera, in_camera).value();
  }
  Detection& AddDetection(int frame, int object, const Box& box) {
    Detection& detection = sequence_.detections.emplace_back();
    detection.frame_index = frame;
    detection.object_index = object;
    detection.box = box;
    return detection;
  }
  // Boxes of a true object become those of an object, in frames from first to before last.
  void Detect(int truth, int object, int first = 0, int last = kFrames) {
    for (int frame = first; frame < last; ++frame) {
      AddDetection(frame, object, BoxOf(Truth(truth), frame)).true_object_id =
          sequence_.true_objects[truth].id;
    }
  }
  void DetectNothing(int object) {
    for (int frame = 0; frame < kFrames; ++frame) {
      AddDetection(frame, object, {10.0, 10.0, 40.0, 30.0 + object});
    }
  }
  void Reject(int truth, RejectingStage stage, const std::string& reason) {
    for (int frame = 0; frame < kFrames; ++frame) {
      sequence_.rejected.push_back(
          {frame, "box", 0.5, BoxOf(Truth(truth), frame), std::nullopt, stage, reason});
    }
  }
  void SayInFrames(int truth, const Landmark& landmark) {
    for (int frame = 0; frame < kFrames; ++frame) {
      sequence_.truth_in_frames.push_back(
          {frame, sequence_.true_objects[truth].id,
           Transform(sequence_.frames[frame].world_from_camera.Inverse(), landmark)});
    }
  }
  int AddFound(const Eigen::Vector3d& half_axes = kCube, const std::string& label = "box") {
    const int truth = AddTruth(half_axes);
    Detect(truth, AddLandmark(Truth(truth), label));
    return truth;
  }

  // Moves the estimates of cameras, landmarks and the plane away from the truth.
  void Move(const Alignment& away) {
    for (Frame& frame : sequence_.frames) {
      frame.world_from_camera = away.Apply(frame.world_from_camera);
    }
    for (ObjectEstimate& estimate : estimates_) {
      if (!estimate.landmark_in_world) continue;
      estimate.landmark_in_world = away.Apply(*estimate.landmark_in_world);
    }
    sequence_.planes[0].plane_in_world = away.Apply(sequence_.planes[0].plane_in_world);
  }

  MapQuality Evaluate(AlignmentKind alignment = AlignmentKind::kAuto) {
    std::ranges::stable_sort(sequence_.detections, {}, &Detection::frame_index);
    return EvaluateMapQuality(sequence_, estimates_, PosesOf(sequence_), PlanesOf(sequence_),
                              alignment)
        .value();
  }
  const TrueObjectRow& RowOf(const MapQuality& quality, int truth) const {
    return *std::ranges::find(quality.objects, truth, &TrueObjectRow::true_index);
  }

  Sequence sequence_;
  std::vector<ObjectEstimate> estimates_;
};

}  // namespace soslam
