// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "geometry/rigid3.h"

namespace soslam {

// The text lists of the TUM RGB-D benchmark: one row a line, # starts a comment.

// A row "timestamp filename" of rgb.txt.
struct ListedImage {
  double timestamp;   // seconds
  std::string image;  // path relative to the dataset folder
};

// The rows in the order of the file; also rows "timestamp,filename" with nanoseconds, as EuRoC has
// them. Throws InputError naming the line; also when there is no row.
std::vector<ListedImage> ReadImageList(const std::filesystem::path& path);

// Rows as above, or "timestamp filename timestamp filename" as tools write them that associate
// colour images with depth images: the first pair is the image, or else the second.
enum class PairOrder { kImageFirst, kImageSecond };
std::vector<ListedImage> ReadPairedImageList(const std::filesystem::path& path, PairOrder order);

// A row "timestamp tx ty tz qx qy qz qw" of a trajectory.
struct TimedPose {
  double timestamp;  // seconds
  Rigid3d world_from_camera;
};

// The poses by ascending timestamp, quaternions normalised; of those of one time, which a
// recorder's clock may give to two, the first. Throws InputError naming the line, for two poses of
// one time that are not about the same, and when there is no pose.
std::vector<TimedPose> ReadTrajectory(const std::filesystem::path& path);

// What a reader of `path` does with its poses at the end, as said above.
std::vector<TimedPose> SortedTrajectory(std::vector<TimedPose> trajectory,
                                        const std::filesystem::path& path);

// The pose of `trajectory` (ascending) that is nearest in time, none when it is further away than
// `max_difference_s`.
std::optional<TimedPose> NearestPose(const std::vector<TimedPose>& trajectory, double timestamp,
                                     double max_difference_s);

}  // namespace soslam
