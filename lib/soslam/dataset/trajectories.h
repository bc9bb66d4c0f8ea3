// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "soslam/geometry/rigid3.h"

namespace soslam {

// Normalises a quaternion that was rounded in a file. Throws InputError, naming `place`, when its
// norm differs from 1 by more than rounding.
Eigen::Quaterniond UnitQuaternion(const Eigen::Vector4d& xyzw, const std::string& place);

// The rotation nearest to a matrix that was rounded in a file. Throws InputError, naming `place`,
// when it is no rotation within rounding.
Eigen::Quaterniond NearestRotation(const Eigen::Matrix3d& matrix, const std::string& place);

// The rigid motion of a 4 x 4 matrix, with an exact rotation. Throws InputError also when its last
// row is not 0 0 0 1, as in a matrix written by columns.
Rigid3d RigidMotion(const Eigen::Matrix4d& matrix, const std::string& place);

// Pose of an image identified by name instead of time, as in structure from motion.
struct NamedPose {
  std::string place;          // "<file>:<line>" or "<file>#<JSON pointer>", for error messages
  std::string image;          // path, as the file has it
  Rigid3d world_from_camera;  // camera x right, y down, z forward
};

// Readers of the text lists of the TUM RGB-D benchmark: one row per line, # starts a comment.

// A row "timestamp filename" of rgb.txt.
struct ListedImage {
  double timestamp;   // seconds
  std::string image;  // path relative to the dataset folder
};

// Reads an image list in file order; also rows "timestamp,filename" with nanoseconds, as in EuRoC.
// Throws InputError naming the line; also when there is no row.
std::vector<ListedImage> ReadImageList(const std::filesystem::path& path);

// Reads rows as above, or "timestamp filename timestamp filename" of tools that associate colour
// with depth images; the order of the two is given by `order`.
enum class PairOrder { kImageFirst, kImageSecond };
std::vector<ListedImage> ReadPairedImageList(const std::filesystem::path& path, PairOrder order);

// A row "timestamp tx ty tz qx qy qz qw" of a trajectory.
struct TimedPose {
  double timestamp;  // seconds
  Rigid3d world_from_camera;
};

// The pose as a line of a trajectory, with its line end; all digits.
std::string TrajectoryLine(const TimedPose& pose);

// Reads a trajectory, sorted by timestamp, with normalised quaternions; of several poses with one
// timestamp the first. Throws InputError naming the line for two clearly different poses with one
// timestamp, and when there is no pose.
std::vector<TimedPose> ReadTrajectory(const std::filesystem::path& path);

// The pose of `trajectory` (ascending) nearest in time; none when it is further away than
// `max_difference_s`.
std::optional<TimedPose> NearestPose(const std::vector<TimedPose>& trajectory, double timestamp,
                                     double max_difference_s);

// Reads a trajectory in EuRoC's format (state_groundtruth_estimate0/data.csv): lines
// "timestamp,x,y,z,qw,qx,qy,qz", timestamps in nanoseconds, converted to seconds; further columns
// (velocity, biases) are ignored. The pose is world_from_body ("RS": sensor in the reference
// frame); it is that of the camera only if the body is the camera, see
// Calibration::body_from_camera. Sorted by time, see ReadTrajectory. Throws InputError naming the
// line.
std::vector<TimedPose> ReadEurocTrajectory(const std::filesystem::path& path);

// The 12 numbers of a 3 x 4 matrix by rows. Throws InputError, naming the place, for anything else.
Eigen::Matrix<double, 3, 4> ParseMatrix34(std::span<const std::string_view> words,
                                          const std::string& place);

// Reads a trajectory in the format of KITTI's odometry benchmark: one line per frame, the upper 3 x
// 4 of world_from_camera row by row, metres. The k-th pose is that of frame k, from 0. Files round
// matrices, so each is replaced by the nearest rotation. Throws InputError naming the line when a
// matrix is no rotation within rounding; also when there is no pose.
std::vector<Rigid3d> ReadKittiTrajectory(const std::filesystem::path& path);

// Conversion of ICL-NUIM (A. Handa et al., "A Benchmark for RGB-D Visual Odometry, 3D
// Reconstruction and SLAM", ICRA 2014), whose images are rendered by POV-Ray:
//
// - Both its world and its camera have y up, x right, z forward: they are left-handed. The negative
//   fy of the published intrinsics (481.20, -480.00, 319.50, 239.50; 640 x 480) shows this: it
//   projects a point with positive y to the upper half of the image.
// - Its trajectories (*.gt.freiburg) look like TUM's, but are rotations between left-handed frames,
//   and their first column, like that of associations.txt, is the frame number; the images are
//   1/30 s apart.
//
// Mirroring y in the world and in the camera makes both right-handed, with the same images, if fy
// is negated: y is then down, and up in the world is (0, -1, 0).

inline constexpr double kIclNuimFramesPerSecond = 30.0;

// Converts a pose between left-handed frames to one between the mirrored, right-handed ones.
Rigid3d MirroredInY(const Rigid3d& world_from_camera);

}  // namespace soslam
