// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/pose_readings.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <numbers>

namespace soslam {
namespace {

Rigid3d Inverted(const Rigid3d& pose) { return pose.Inverse(); }

// Quaternion w x y z that was read as x y z w.
Rigid3d WithScalarFirst(const Rigid3d& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  return {Eigen::Quaterniond(q.x(), q.y(), q.z(), q.w()), pose.translation};
}

// Pose of a camera with x right, y up, z backward.
Rigid3d OfOpenGlCamera(const Rigid3d& pose) {
  const Eigen::Quaterniond half_turn_about_x(0.0, 1.0, 0.0, 0.0);
  return {pose.rotation * half_turn_about_x, pose.translation};
}

Rigid3d ScalarFirstInverted(const Rigid3d& pose) { return WithScalarFirst(pose).Inverse(); }
Rigid3d OpenGlInverted(const Rigid3d& pose) { return OfOpenGlCamera(pose.Inverse()); }
Rigid3d OpenGlScalarFirst(const Rigid3d& pose) { return OfOpenGlCamera(WithScalarFirst(pose)); }

Rigid3d WithInverseRotation(const Rigid3d& pose) {
  return {pose.rotation.conjugate(), pose.translation};
}

// Pose with camera centre -R t, for a translation t of the inverse pose.
Rigid3d WithInverseTranslation(const Rigid3d& pose) {
  return {pose.rotation, -(pose.rotation * pose.translation)};
}

// Pose with a translation that was inverted although it was the centre.
Rigid3d WithCentreInverted(const Rigid3d& pose) {
  return {pose.rotation, pose.Inverse().translation};
}

Rigid3d TurnedAboutZ(const Rigid3d& pose, double turns) {
  const Eigen::AngleAxisd turn(2.0 * std::numbers::pi * turns, Eigen::Vector3d::UnitZ());
  return {pose.rotation * turn, pose.translation};
}
Rigid3d HalfTurned(const Rigid3d& pose) { return TurnedAboutZ(pose, 0.5); }
Rigid3d QuarterTurned(const Rigid3d& pose) { return TurnedAboutZ(pose, 0.25); }
Rigid3d QuarterTurnedBack(const Rigid3d& pose) { return TurnedAboutZ(pose, -0.25); }

// Pose of a body with x forward, y left, z up.
Rigid3d OfRosBody(const Rigid3d& pose) {
  const Eigen::Quaterniond body_from_camera(0.5, -0.5, 0.5, -0.5);
  return {pose.rotation * body_from_camera, pose.translation};
}

Rigid3d WithCentreMirrored(const Rigid3d& pose) {
  const Eigen::Vector3d& t = pose.translation;
  return {pose.rotation, {-t.x(), t.y(), t.z()}};
}

Rigid3d WithCentreSwapped(const Rigid3d& pose) {
  const Eigen::Vector3d& t = pose.translation;
  return {pose.rotation, {t.x(), t.z(), t.y()}};
}

Rigid3d AsRead(const Rigid3d& pose) { return pose; }

constexpr bool kMirrored = true;
constexpr bool kTurnedInBody = true;
constexpr const char* kTurned =
    "images or boxes that are turned against the poses, or another camera's axes";

constexpr std::array kReadings = {
    PoseReading{"the poses are the inverse, camera_from_world",
                "poses the other way round, as COLMAP has them", "invert the poses", &Inverted},
    PoseReading{"the poses are with qw first", "quaternions qw qx qy qz",
                "write quaternions as qx qy qz qw", &WithScalarFirst},
    PoseReading{"the poses are the inverse with qw first", "poses of COLMAP's images.txt",
                "write quaternions as qx qy qz qw, and invert the poses", &ScalarFirstInverted},
    PoseReading{"the poses are those of a camera with y up and z backward",
                "cameras of OpenGL, as NeRFs have them",
                "turn the cameras by half a turn about their x axis", &OfOpenGlCamera},
    PoseReading{"the poses are the inverse of those of a camera with y up and z backward",
                "view matrices of OpenGL",
                "invert the poses, then turn the cameras by half a turn about their x axis",
                &OpenGlInverted},
    PoseReading{"the poses are with qw first and of a camera with y up and z backward",
                "cameras of OpenGL, with quaternions qw qx qy qz",
                "write quaternions as qx qy qz qw, and turn the cameras by half a turn about their "
                "x axis",
                &OpenGlScalarFirst},
    PoseReading{"the poses are with the inverse rotation",
                "rotation matrices that were transposed, or rotations of camera_from_world beside "
                "the centres of the cameras",
                "transpose the rotations, and keep the translations", &WithInverseRotation},
    PoseReading{"the poses are with the translation of camera_from_world",
                "translations of camera_from_world beside rotations of world_from_camera",
                "give the centre of the camera, -R t, as the translation", &WithInverseTranslation},
    PoseReading{"the poses are with the centre inverted once more",
                "centres of cameras that were taken for the translation of camera_from_world",
                "keep the translations when the rotations are inverted", &WithCentreInverted},
    PoseReading{"the poses are turned by half a turn about the camera's z axis", kTurned,
                "turn the cameras by half a turn about their z axis, or the boxes with the images",
                &HalfTurned, !kMirrored, kTurnedInBody},
    PoseReading{"the poses are turned by a quarter about the camera's z axis", kTurned,
                "turn the cameras by 90 degrees about their z axis, or the boxes with the images",
                &QuarterTurned, !kMirrored, kTurnedInBody},
    PoseReading{"the poses are turned back by a quarter about the camera's z axis", kTurned,
                "turn the cameras by -90 degrees about their z axis, or the boxes with the images",
                &QuarterTurnedBack, !kMirrored, kTurnedInBody},
    PoseReading{"the poses are those of a body with x forward, y left and z up",
                "poses of a robot's body, as ROS has them",
                "give the poses of the camera, with x right, y down and z forward", &OfRosBody,
                !kMirrored, kTurnedInBody},
    PoseReading{"boxes are mirrored left to right",
                "images or boxes are mirrored, as selfie cameras do, or poses of a left-handed "
                "world",
                "mirror the boxes (x to width - 1 - x) or take images that are not mirrored",
                &AsRead, kMirrored},
    PoseReading{"boxes are mirrored top to bottom",
                "boxes with y up, or poses of a left-handed world, as Unity has them",
                "write boxes with y down, and poses of a right-handed world, camera y down",
                &HalfTurned, kMirrored},
    PoseReading{"the poses are with x of the other sign",
                "translations of a left-handed world beside rotations of a right-handed one",
                "turn the sign of the translations' x", &WithCentreMirrored},
    PoseReading{"the poses are with y and z swapped",
                "translations with y and z swapped, beside rotations that are not",
                "swap y and z of the translations", &WithCentreSwapped}};

}  // namespace

std::span<const PoseReading> PoseReadings() { return kReadings; }

}  // namespace soslam
