// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/covariance.h"

#include <ceres/covariance.h>

#include <utility>
#include <vector>

namespace soslam {

std::optional<std::vector<Covariance9>> LandmarkCovariances(
    const std::vector<const double*>& landmark_blocks, ceres::Problem* problem) {
  std::vector<std::pair<const double*, const double*>> pairs;
  for (const double* block : landmark_blocks) pairs.emplace_back(block, block);
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::SPARSE_QR;
  ceres::Covariance covariance(options);
  if (!covariance.Compute(pairs, problem)) return std::nullopt;

  // Ceres' rotation tangent is half the rotation vector.
  Eigen::Matrix<double, 9, 1> scale = Eigen::Matrix<double, 9, 1>::Ones();
  scale.head<3>().setConstant(2.0);
  std::vector<Covariance9> covariances;
  for (const double* block : landmark_blocks) {
    Eigen::Matrix<double, 9, 9, Eigen::RowMajor> tangent;
    if (!covariance.GetCovarianceBlockInTangentSpace(block, block, tangent.data())) {
      return std::nullopt;
    }
    covariances.push_back(scale.asDiagonal() * tangent * scale.asDiagonal());
    if (!covariances.back().allFinite()) return std::nullopt;
  }
  return covariances;
}

}  // namespace soslam
