// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/tangent_space.h"

#include <Eigen/Geometry>

#include "geometry/rigid3.h"

namespace soslam {
Eigen::Matrix<double, 3, 2> AxesAcross(const Eigen::Vector3d& normal) {
  Eigen::Matrix<double, 3, 2> axes;
  axes.col(0) = normal.unitOrthogonal();
  axes.col(1) = normal.cross(axes.col(0));
  return axes;
}

Eigen::Matrix<double, 4, 3> QuaternionByRotationVector(const double* quaternion_xyzw) {
  const Eigen::Vector3d vec(quaternion_xyzw);
  Eigen::Matrix<double, 4, 3> matrix;
  matrix.topRows<3>() = 0.5 * (quaternion_xyzw[3] * Eigen::Matrix3d::Identity() - Skew(vec));
  matrix.bottomRows<1>() = -0.5 * vec.transpose();
  return matrix;
}

void Move(VariableKind kind, const double* step, double* values) {
  switch (kind) {
    case VariableKind::kPose:
    case VariableKind::kLandmark: {
      const Eigen::Quaterniond rotation =
          ExpRotation(Eigen::Vector3d(step)) * Eigen::Quaterniond(values);
      Eigen::Map<Eigen::Quaterniond> moved(values);
      moved = rotation.normalized();
      for (int i = 4; i < NumValues(kind); ++i) values[i] += step[i - 1];
      return;
    }
    case VariableKind::kNormal: {
      Eigen::Map<Eigen::Vector3d> normal(values);
      normal = (normal + AxesAcross(normal) * Eigen::Map<const Eigen::Vector2d>(step)).normalized();
      return;
    }
    default:
      for (int i = 0; i < NumValues(kind); ++i) values[i] += step[i];
  }
}

ValuesByStep ByStep(VariableKind kind, const double* values) {
  ValuesByStep by_step = ValuesByStep::Zero(NumValues(kind), NumTangents(kind));
  switch (kind) {
    case VariableKind::kPose:
    case VariableKind::kLandmark:
      by_step.topLeftCorner<4, 3>() = QuaternionByRotationVector(values);
      by_step.bottomRightCorner(NumValues(kind) - 4, NumTangents(kind) - 3).setIdentity();
      return by_step;
    case VariableKind::kNormal:
      by_step = AxesAcross(Eigen::Vector3d(values));
      return by_step;
    default:
      by_step.setIdentity();
      return by_step;
  }
}

}  // namespace soslam
