// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "planes/up_prior.h"
#include "support/random.h"

namespace soslam {

// A camera anywhere in a room around the origin that looks somewhat downwards, not level.
inline Rigid3d CameraInRoom(double heading) {
  const Eigen::Quaterniond level =
      Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ())) *
      Eigen::Quaterniond((Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished());
  const Eigen::Vector3d attitude(RandomUniform(-0.5, -0.2), 0.0, RandomUniform(-0.1, 0.1));
  return {level * ExpRotation(attitude), RandomVector(-0.3, 0.3)};
}

// Edges along `directions` (or any, where there is none) as a camera sees them.
inline SegmentView ViewOfEdges(const Rigid3d& world_from_camera,
                               const std::vector<Eigen::Vector3d>& directions) {
  SegmentView view{TestCamera(), {}, world_from_camera};
  const Camera camera = TestCamera();
  const Rigid3d camera_from_world = world_from_camera.Inverse();
  for (const Eigen::Vector3d& direction : directions) {
    for (;;) {
      const Eigen::Vector3d point =
          world_from_camera *
          Eigen::Vector3d(RandomUniform(-1, 1), RandomUniform(-0.7, 0.7), RandomUniform(2.5, 4));
      const auto begin = camera.Project(camera_from_world * point);
      const auto end = camera.Project(camera_from_world * (point + 0.5 * direction));
      if (!begin || !end || (*end - *begin).norm() < 30.0) continue;
      view.segments.push_back({*begin, *end});
      break;
    }
  }
  return view;
}

}  // namespace soslam
