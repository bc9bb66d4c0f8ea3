// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/kitti_trajectory.h"

#include <fmt/format.h>

#include <Eigen/Dense>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

Eigen::Quaterniond NearestRotation(const Eigen::Matrix3d& matrix, const std::string& place) {
  constexpr double kTolerance = 1e-3;  // of each entry of R R^T: three digits were kept at least
  const double deviation =
      (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(deviation <= kTolerance)) {
    throw InputError(
        fmt::format("{}: rotation is not orthonormal, R R^T is off by {:.3g}; expected at most {}",
                    place, deviation, kTolerance));
  }
  if (matrix.determinant() < 0.0) {
    throw InputError(place +
                     ": rotation has determinant -1; expected 1, a matrix without mirroring");
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return Eigen::Quaterniond(Eigen::Matrix3d(svd.matrixU() * svd.matrixV().transpose()))
      .normalized();
}

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
