// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "geometry/support_function.h"
#include "initialisation/box_on_ground.h"
#include "initialisation/quadratic_model.h"

namespace soslam {

// The tangencies of a box's edges, none of them a bound, with a body at one yaw, by the logarithms
// of its half axes. They are linear in the body's foot, which is eliminated (variable projection;
// Golub and Pereyra, 1973): of the four residuals only that part counts which no foot explains.
class TangenciesAtYaw {
 public:
  // Tangent points at these depths (m). Keeps a reference to the box.
  TangenciesAtYaw(const BoxOnGround& box, const Eigen::Array4d& depths_m, double yaw,
                  double shape_exponent);

  // Whether they tell where the foot is. If not, what follows is not defined.
  bool TellTheFoot() const;

  // Of the body on its best foot.
  QuadraticModel<3> Evaluate(const Eigen::Vector3d& log_half_axes) const;
  // In the ground's frame, m.
  Eigen::Vector2d BestFoot(const Eigen::Vector3d& log_half_axes) const;

 private:
  struct Rows {
    Eigen::Vector4d residuals;
    Eigen::Matrix<double, 4, 3> by_log_half_axes;
  };
  // Of a body whose foot is the ground's origin.
  Rows RowsAtOrigin(const Eigen::Vector3d& log_half_axes) const;

  const BoxOnGround& box_;
  Eigen::Array4d weights_;
  SupportInDirections support_;  // along the edges' normals
  // Their product is the derivative of the residuals by the foot: orthonormal columns, upper
  // triangle.
  Eigen::Matrix<double, 4, 2> foot_basis_;
  Eigen::Matrix2d foot_triangle_ = Eigen::Matrix2d::Zero();
};

}  // namespace soslam
