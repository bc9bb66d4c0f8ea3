// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <numbers>
#include <utility>

#include "model/sequence.h"

namespace soslam {

// What the same places look like from cameras that are turned by a quarter clockwise about their
// optical axis: the image turns counterclockwise.
inline Sequence RolledByAQuarter(Sequence sequence) {
  const double width = sequence.camera.width;
  Camera& camera = sequence.camera;
  std::swap(camera.width, camera.height);
  std::swap(camera.fx, camera.fy);
  camera = {camera.width, camera.height, camera.fx, camera.fy, camera.cy, width - 1.0 - camera.cx};
  const Rigid3d old_from_new{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ())),
      Eigen::Vector3d::Zero()};
  for (Frame& frame : sequence.frames) {
    frame.world_from_camera = frame.world_from_camera * old_from_new;
    if (frame.true_world_from_camera) {
      frame.true_world_from_camera = *frame.true_world_from_camera * old_from_new;
    }
  }
  for (Detection& detection : sequence.detections) {
    const Box box = detection.box;
    detection.box = {box.y_min, width - 1.0 - box.x_max, box.y_max, width - 1.0 - box.x_min};
    detection.plane_in_camera = Transform(old_from_new.Inverse(), detection.plane_in_camera);
    const auto [left, top, right, bottom] = detection.is_bound;
    detection.is_bound = {top, right, bottom, left};
  }
  return sequence;
}

inline Sequence Rolled(Sequence sequence, int quarters) {
  for (int i = 0; i < quarters; ++i) sequence = RolledByAQuarter(std::move(sequence));
  return sequence;
}

}  // namespace soslam
