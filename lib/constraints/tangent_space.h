// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "constraints/parameters.h"

namespace soslam {

// Manifolds of the estimated variables. The values of a variable are its parameter block
// (parameters.h); its steps are tangent vectors:
//   pose      (rotation vector applied from the left, translation): 6
//   landmark  the same and the logarithms of the half axes, in the order of kLandmarkDof: 9
//   normal    along two axes orthogonal to it: 2
//   offset    of a plane: 1
//   bias      of a detector's left, top, right and bottom edges: 4
enum class VariableKind { kPose, kLandmark, kNormal, kOffset, kBias };

inline constexpr int kPoseDof = 6;
inline constexpr int kNormalDof = 2;
inline constexpr int kBiasSize = 4;

constexpr int NumValues(VariableKind kind) {
  switch (kind) {
    case VariableKind::kPose:
      return kPoseSize;
    case VariableKind::kLandmark:
      return kLandmarkSize;
    case VariableKind::kNormal:
      return kNormalSize;
    case VariableKind::kOffset:
      return kOffsetSize;
    default:
      return kBiasSize;
  }
}

constexpr int NumTangents(VariableKind kind) {
  switch (kind) {
    case VariableKind::kPose:
      return kPoseDof;
    case VariableKind::kLandmark:
      return kLandmarkDof;
    case VariableKind::kNormal:
      return kNormalDof;
    default:
      return NumValues(kind);
  }
}

// Applies a tangent step to the values (boxplus).
void Move(VariableKind kind, const double* step, double* values);

// d values / d step at a step of zero, NumValues x NumTangents: converts Jacobians by a block's
// values to Jacobians by its steps.
using ValuesByStep = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                   kLandmarkSize, kLandmarkDof>;
ValuesByStep ByStep(VariableKind kind, const double* values);

// Two unit vectors that are orthogonal to a unit normal and to each other.
Eigen::Matrix<double, 3, 2> AxesAcross(const Eigen::Vector3d& normal);

// d(qx, qy, qz, qw) / dw of a unit quaternion; the reverse of RotationVectorByQuaternion.
Eigen::Matrix<double, 4, 3> QuaternionByRotationVector(const double* quaternion_xyzw);

// A Jacobian as residual blocks write it, row-major.
template <int kRows, int kColumns>
using JacobianRows =
    Eigen::Matrix<double, kRows, kColumns, kColumns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

// The product by_values ByStep(kKind, values). Except for rotations and normals, ByStep is the
// identity, so that columns are copied.
template <VariableKind kKind, int kRows>
Eigen::Matrix<double, kRows, NumTangents(kKind)> ChainedToSteps(
    const double* values, const JacobianRows<kRows, NumValues(kKind)>& by_values) {
  if constexpr (kKind == VariableKind::kPose || kKind == VariableKind::kLandmark) {
    Eigen::Matrix<double, kRows, NumTangents(kKind)> by_steps;
    by_steps.template leftCols<3>() =
        by_values.template leftCols<4>().lazyProduct(QuaternionByRotationVector(values));
    constexpr int kOthers = NumTangents(kKind) - 3;
    by_steps.template rightCols<kOthers>() = by_values.template rightCols<kOthers>();
    return by_steps;
  } else if constexpr (kKind == VariableKind::kNormal) {
    return by_values.lazyProduct(AxesAcross(Eigen::Vector3d(values)));
  } else {
    return by_values;
  }
}

}  // namespace soslam
