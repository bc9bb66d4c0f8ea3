// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/schur_complement.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "base/wide_loops.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

Eigen::MatrixXd RandomMatrix(Eigen::Index rows, Eigen::Index columns) {
  return Eigen::MatrixXd::NullaryExpr(rows, columns, [] { return RandomUniform(-1, 1); });
}

TEST(SchurComplement, IsTheProductOfLowerTrianglesAndNothingElse) {
  std::vector<double> panels;
  for (Eigen::Index size = 0; size < 30; ++size) {
    for (const Eigen::Index depth : {1, 6, 9, 20}) {
      // Parts of larger matrices, whose columns are farther apart.
      Eigen::MatrixXd corner = RandomMatrix(size + 2, size + 1);
      corner.bottomRightCorner(size, size)
          .triangularView<Eigen::StrictlyUpper>()
          .setConstant(kNone);
      const Eigen::MatrixXd factor = RandomMatrix(size + depth, depth);
      const Eigen::MatrixXd before = RandomMatrix(size + 3, size + 2);
      const auto below = factor.bottomRows(size);
      Eigen::MatrixXd expected = before;
      expected.topLeftCorner(size, size).triangularView<Eigen::Lower>() =
          corner.bottomRightCorner(size, size);
      expected.topLeftCorner(size, size).triangularView<Eigen::Lower>() -=
          below * below.transpose();
      Eigen::MatrixXd complement = before;
      SchurComplement(corner.bottomRightCorner(size, size), below, &panels,
                      complement.topLeftCorner(size, size));
      EXPECT_LT((complement - expected).cwiseAbs().maxCoeff(), 1e-13) << size << ", " << depth;
      EXPECT_EQ(complement.triangularView<Eigen::StrictlyUpper>().toDenseMatrix(),
                before.triangularView<Eigen::StrictlyUpper>().toDenseMatrix());
      EXPECT_EQ(complement.bottomRows(3), before.bottomRows(3));
      EXPECT_EQ(complement.rightCols(2), before.rightCols(2));
    }
  }
}

TEST(SchurComplement, MayTakeThePlaceOfTheCorner) {
  std::vector<double> panels;
  const Eigen::MatrixXd corner = RandomMatrix(23, 23), below = RandomMatrix(23, 7);
  Eigen::MatrixXd apart = corner, in_place = corner;
  SchurComplement(corner, below, &panels, apart);
  SchurComplement(in_place, below, &panels, in_place);
  EXPECT_EQ(in_place, apart);
}

TEST(SchurComplement, IsTheSameToTheLastBitInRegistersOfAnyWidth) {
  if (!HasAvx2()) GTEST_SKIP() << "this processor has no AVX2";
  std::vector<double> panels;
  for (const Eigen::Index size : {1, 7, 8, 9, 31, 64, 101}) {
    const Eigen::MatrixXd corner = RandomMatrix(size, size), below = RandomMatrix(size, 37);
    Eigen::MatrixXd wide = corner, narrow = corner;
    SchurComplement(corner, below, &panels, wide, /*in_wide_registers=*/true);
    SchurComplement(corner, below, &panels, narrow, /*in_wide_registers=*/false);
    EXPECT_EQ(wide, narrow) << size;
  }
}

}  // namespace
}  // namespace soslam
