// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/rigid3.h"

namespace soslam {

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

// Reads a trajectory, sorted by timestamp, with normalised quaternions; of several poses with one
// timestamp the first. Throws InputError naming the line for two clearly different poses with one
// timestamp, and when there is no pose.
std::vector<TimedPose> ReadTrajectory(const std::filesystem::path& path);

// Final step of a trajectory reader, as above: sorts, removes duplicates, checks.
std::vector<TimedPose> SortedTrajectory(std::vector<TimedPose> trajectory,
                                        const std::filesystem::path& path);

// The pose of `trajectory` (ascending) nearest in time; none when it is further away than
// `max_difference_s`.
std::optional<TimedPose> NearestPose(const std::vector<TimedPose>& trajectory, double timestamp,
                                     double max_difference_s);

}  // namespace soslam
