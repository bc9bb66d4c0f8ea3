// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/pose_readings.h"

#include <array>

namespace soslam {
namespace {

Rigid3d Inverted(const Rigid3d& pose) { return pose.Inverse(); }

// Four numbers w x y z that were read as x y z w.
Rigid3d WithScalarFirst(const Rigid3d& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  return {Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
}

// A camera with x right, y up, z backward.
Rigid3d OfOpenGlCamera(const Rigid3d& pose) {
  const Eigen::Quaterniond half_turn_about_x(0.0, 1.0, 0.0, 0.0);
  return {pose.rotation * half_turn_about_x, pose.translation};
}

Rigid3d ScalarFirstInverted(const Rigid3d& pose) { return WithScalarFirst(pose).Inverse(); }

constexpr std::array kReadings = {
    PoseReading{"the inverse, camera_from_world", "poses the other way round, as COLMAP has them",
                "invert the poses", &Inverted},
    PoseReading{"with qw first", "quaternions qw qx qy qz", "write quaternions as qx qy qz qw",
                &WithScalarFirst},
    PoseReading{"the inverse with qw first", "poses of COLMAP's images.txt",
                "write quaternions as qx qy qz qw, and invert the poses", &ScalarFirstInverted},
    PoseReading{"those of a camera with y up and z backward",
                "cameras of OpenGL, as NeRFs have them",
                "turn the cameras by half a turn about their x axis", &OfOpenGlCamera}};

}  // namespace

std::span<const PoseReading> PoseReadings() { return kReadings; }

}  // namespace soslam
