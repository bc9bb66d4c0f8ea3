// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/kitti_trajectory.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

// Files round rotations; what is further from orthonormal is not one.
constexpr double kRotationTolerance = 1e-3;

Rigid3d ParsePose(const TextLine& line) {
  const auto words = SplitWords(line.text);
  if (words.size() != 12) {
    throw InputError(fmt::format("{}: has {} numbers; expected 12, a 3 x 4 matrix by rows",
                                 line.place, words.size()));
  }
  Eigen::Matrix<double, 3, 4> matrix;
  for (int i = 0; i < 12; ++i) {
    matrix(i / 4, i % 4) =
        ParseReal(words[static_cast<size_t>(i)], line.place, fmt::format("number {}", i + 1));
  }
  const Eigen::Matrix3d rotation = matrix.leftCols<3>();
  const double error = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(error < kRotationTolerance) || rotation.determinant() < 0.0) {
    throw InputError(line.place + ": the first three columns are not a rotation");
  }
  return {Eigen::Quaterniond(rotation).normalized(), matrix.col(3)};
}

}  // namespace

std::vector<Rigid3d> ReadKittiTrajectory(const std::filesystem::path& path) {
  std::vector<Rigid3d> poses;
  for (const TextLine& line : ReadTextLines(path)) poses.push_back(ParsePose(line));
  if (poses.empty()) throw InputError(path.string() + ": has no pose");
  return poses;
}

}  // namespace soslam
