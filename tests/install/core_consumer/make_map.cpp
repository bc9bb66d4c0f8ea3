// SPDX-License-Identifier: BSD-3-Clause
// A map from memory: twelve cameras around a crate on the floor, with the boxes of a detector.
#include <cmath>
#include <cstdio>

#include "soslam/mapping/back_end.h"
#include "soslam/mapping/initial_landmarks.h"

using namespace soslam;

// A camera that looks at the origin: x right, y down, z forward.
Rigid3d LookingAtOrigin(const Eigen::Vector3d& position) {
  Eigen::Matrix3d axes;
  axes.col(2) = -position.normalized();
  axes.col(0) = axes.col(2).cross(Eigen::Vector3d::UnitZ()).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return {Eigen::Quaterniond(axes), position};
}

int main() {
  Landmark crate;  // the truth, 0.4 x 0.6 x 0.5 m
  crate.half_axes = {0.2, 0.3, 0.25};
  crate.frame_from_object.translation = {0.1, 0.0, 0.25};
  crate.shape_exponents = kCuboidExponent;

  Sequence sequence;
  sequence.camera = {640, 480, 525.0, 525.0, 319.5, 239.5};  // width, height, fx, fy, cx, cy
  sequence.planes.emplace_back().plane_in_world = {Eigen::Vector3d::UnitZ(), 0.0};  // the floor
  sequence.objects.emplace_back().label = "crate";                                  // stands on it
  for (int i = 0; i < 12; ++i) {
    Frame& frame = sequence.frames.emplace_back();
    frame.id = i;
    const double angle = 0.4 * i;
    frame.world_from_camera = LookingAtOrigin({2.5 * std::cos(angle), 2.5 * std::sin(angle), 1.5});
    Detection& detection = sequence.detections.emplace_back();
    detection.frame_index = i;
    detection.box =
        OutlineBox(sequence.camera, Transform(frame.world_from_camera.Inverse(), crate)).value();
  }

  ShapePrior prior;  // of crates: depth and width relative to the height, to a third
  prior.ratio = {0.7, 1.0};
  prior.log_sigma.setConstant(0.3);
  prior.shape_exponents = kCuboidExponent;
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;  // bodies of any shape
  options.hold_poses = true;
  BackEndInput input{sequence, {}, {prior}};
  input.initial_landmarks = ChooseInitialUprightLandmarks(input, {}, options, /*threads=*/1);
  const MapEstimate map = OptimiseMap(input, options);

  const Landmark& found = map.objects.front().landmark_in_world.value();
  const Eigen::Vector3d& at = found.Centre();
  std::printf("crate at (%.3f, %.3f, %.3f), %.3f x %.3f x %.3f m\n", at.x(), at.y(), at.z(),
              2.0 * found.half_axes.x(), 2.0 * found.half_axes.y(), 2.0 * found.half_axes.z());
  return (at - crate.Centre()).norm() < 0.01 ? 0 : 1;
}
