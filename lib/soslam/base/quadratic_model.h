// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace soslam {

// Least squares problem of few parameters to second order (Gauss-Newton) about a point, from its
// residuals r and their Jacobian J.
template <int kSize>
struct QuadraticModel {
  using Vector = Eigen::Matrix<double, kSize, 1>;
  using Matrix = Eigen::Matrix<double, kSize, kSize>;

  double cost = 0.0;                    // half the sum of r^2; not finite where undefined
  Vector gradient = Vector::Zero();     // J^T r
  Matrix information = Matrix::Zero();  // J^T J

  void Add(double residual, const Vector& d_parameters) {
    cost += 0.5 * residual * residual;
    gradient += residual * d_parameters;
    information.noalias() += d_parameters * d_parameters.transpose();
  }
  void Add(const QuadraticModel& other, double weight = 1.0) {
    cost += weight * other.cost;
    gradient += weight * other.gradient;
    information += weight * other.information;
  }
  // Fixes a parameter: sets all derivatives by it to zero.
  void Hold(int parameter) {
    gradient[parameter] = 0.0;
    information.row(parameter).setZero();
    information.col(parameter).setZero();
  }
  // The problem in other variables that the parameters depend on; `d_others` is the Jacobian
  // of the parameters by them.
  template <int kOthers>
  QuadraticModel<kOthers> Chained(const Eigen::Matrix<double, kSize, kOthers>& d_others) const {
    const Eigen::Matrix<double, kSize, kOthers> mixed = information.lazyProduct(d_others);
    QuadraticModel<kOthers> chained;
    chained.cost = cost;
    chained.gradient = d_others.transpose().lazyProduct(gradient);
    chained.information = d_others.transpose().lazyProduct(mixed);
    return chained;
  }
};

}  // namespace soslam
