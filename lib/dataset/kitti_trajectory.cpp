// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/kitti_trajectory.h"

#include <fmt/format.h>

#include "base/error.h"
#include "dataset/nearest_rotation.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

Rigid3d ParsePose(const TextLine& line) {
  constexpr size_t kNumbers = 12;
  const auto words = SplitWords(line.text);
  if (words.size() != kNumbers) {
    throw InputError(fmt::format("{}: has {} numbers; expected {}, the upper 3 x 4 of a pose",
                                 line.place, words.size(), kNumbers));
  }
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> pose;
  for (size_t i = 0; i < kNumbers; ++i) {
    pose.data()[i] = ParseReal(words[i], line.place, fmt::format("number {}", i + 1));
  }
  return {NearestRotation(pose.leftCols<3>(), line.place), pose.col(3)};
}

}  // namespace

std::vector<Rigid3d> ReadKittiTrajectory(const std::filesystem::path& path) {
  std::vector<Rigid3d> poses;
  for (const TextLine& line : ReadTextLines(path)) poses.push_back(ParsePose(line));
  if (poses.empty()) throw InputError(path.string() + ": has no pose");
  return poses;
}

}  // namespace soslam
