// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/levenberg_marquardt.h"

#include <gtest/gtest.h>

#include <limits>

namespace soslam {
namespace {

using Matrix = Eigen::Matrix<double, 6, 6>;
using Vector = Eigen::Matrix<double, 6, 1>;

TEST(SolveForNegative, LeavesNothingOfTheRightHandSide) {
  for (int i = 0; i < 100; ++i) {
    const Matrix root = Matrix::Random();
    const Matrix a = root * root.transpose() + 0.01 * Matrix::Identity();
    const Vector b = Vector::Random();
    Matrix lower = a;
    lower.triangularView<Eigen::StrictlyUpper>().setConstant(
        std::numeric_limits<double>::quiet_NaN());
    Vector x;
    ASSERT_TRUE(SolveForNegative(lower, b, &x));
    EXPECT_LT((a * x + b).norm(), 1e-12 * (1.0 + a.norm() * x.norm()));
  }
}

TEST(SolveForNegative, RefusesWhatIsNotPositiveDefinite) {
  const Vector b = Vector::Ones();
  Vector x;
  for (int i = 0; i < 6; ++i) {
    const Matrix turn = Matrix::Random().householderQr().householderQ();
    Vector values = Vector::LinSpaced(1.0, 2.0);
    values[i] = -0.1;
    EXPECT_FALSE(SolveForNegative(Matrix(turn * values.asDiagonal() * turn.transpose()), b, &x));
    Matrix singular = Matrix::Identity();
    singular(i, i) = 0.0;
    EXPECT_FALSE(SolveForNegative(singular, b, &x));
    singular(i, i) = std::numeric_limits<double>::quiet_NaN();
    EXPECT_FALSE(SolveForNegative(singular, b, &x));
  }
}

}  // namespace
}  // namespace soslam
