// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/covariance.h"

#include <ceres/covariance.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace soslam {
namespace {

// The last digits of SuiteSparse's BLAS may depend on where in memory matrices lie, Eigen's do not;
// but its time grows so fast that large problems have to do without.
ceres::Covariance::Options OptionsFor(const ceres::Problem& problem) {
  constexpr int kMaxVariablesForEigen = 1000;
  ceres::Covariance::Options options;
  options.algorithm_type = ceres::SPARSE_QR;
  options.sparse_linear_algebra_library_type =
      problem.NumParameters() <= kMaxVariablesForEigen ? ceres::EIGEN_SPARSE : ceres::SUITE_SPARSE;
  return options;
}

}  // namespace

std::optional<std::vector<Covariance9>> LandmarkCovariances(
    const std::vector<const double*>& landmark_blocks, ceres::Problem* problem) {
  std::vector<std::pair<const double*, const double*>> pairs;
  for (const double* block : landmark_blocks) pairs.emplace_back(block, block);
  ceres::Covariance covariance(OptionsFor(*problem));
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

std::optional<std::vector<Eigen::Matrix4d>> PlaneCovariances(
    const std::vector<std::pair<const double*, const double*>>& planes, ceres::Problem* problem) {
  std::vector<std::pair<const double*, const double*>> pairs;
  for (const auto& [normal, offset] : planes) {
    pairs.insert(pairs.end(), {{normal, normal}, {normal, offset}, {offset, offset}});
  }
  // Parallel planes share a normal.
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  ceres::Covariance covariance(OptionsFor(*problem));
  if (!covariance.Compute(pairs, problem)) return std::nullopt;
  std::vector<Eigen::Matrix4d> covariances;
  for (const auto& [normal, offset] : planes) {
    Eigen::Matrix<double, 3, 3, Eigen::RowMajor> of_normal;
    Eigen::Vector3d mixed;
    double of_offset = 0.0;
    covariance.GetCovarianceBlock(normal, normal, of_normal.data());
    covariance.GetCovarianceBlock(normal, offset, mixed.data());
    covariance.GetCovarianceBlock(offset, offset, &of_offset);
    Eigen::Matrix4d whole;
    whole << of_normal, mixed, mixed.transpose(), of_offset;
    covariances.push_back(whole);
  }
  return covariances;
}

}  // namespace soslam
