// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/schur_complement.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/wide_loops.h"

namespace soslam {
namespace {

// The complement is made in tiles of so many columns of two registers each, whose sums stay in
// registers until they are complete.
constexpr int kColumns = 4;
template <typename Register>
constexpr int kRows = 2 * sizeof(Register) / sizeof(double);
// Two numbers side by side, as registers of processors without AVX2 have them: of Fours, compilers
// would keep the sums in memory there, and take ten times as long.
using Two [[gnu::vector_size(2 * sizeof(double))]] = double;

// Panels of so many rows one after the other, each by column; zeros make up the last one.
void Pack(const Eigen::Ref<const Eigen::MatrixXd>& matrix, int panel_rows,
          std::vector<double>* panels) {
  const Eigen::Index count = (matrix.rows() + panel_rows - 1) / panel_rows;
  panels->resize(static_cast<size_t>(count * panel_rows * matrix.cols()));
  double* next = panels->data();
  for (Eigen::Index first = 0; first < matrix.rows(); first += panel_rows) {
    const Eigen::Index rows = std::min<Eigen::Index>(panel_rows, matrix.rows() - first);
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
      const double* column = &matrix.coeffRef(first, k);
      std::fill(std::copy_n(column, rows, next), next + panel_rows, 0.0);
      next += panel_rows;
    }
  }
}

// Products of two panels of `depth` columns: all rows of one with kColumns rows of the other.
template <typename Register>
SOSLAM_FORCE_INLINE void Multiply(const double* rows, const double* columns, Eigen::Index depth,
                                  double* tile) {
  std::array<std::array<Register, 2>, kColumns> sums{};
  for (Eigen::Index k = 0; k < depth; ++k) {
    Register upper, lower;
    std::memcpy(&upper, rows + k * kRows<Register>, sizeof upper);
    std::memcpy(&lower, rows + k * kRows<Register> + kRows<Register> / 2, sizeof lower);
    for (int j = 0; j < kColumns; ++j) {
      sums[j][0] += upper * columns[k * kRows<Register> + j];
      sums[j][1] += lower * columns[k * kRows<Register> + j];
    }
  }
  std::memcpy(tile, &sums, sizeof sums);
}

struct Matrices {
  Eigen::Index size;
  const double* corner;
  Eigen::Index corner_stride;
  double* complement;
  Eigen::Index complement_stride;
};

template <typename Register>
SOSLAM_FORCE_INLINE void Subtract(const double* panels, Eigen::Index depth,
                                  const Matrices& matrices) {
  constexpr Eigen::Index kHeight = kRows<Register>;
  std::array<double, kHeight * kColumns> tile;
  for (Eigen::Index j = 0; j < matrices.size; j += kColumns) {
    const double* columns = panels + j / kHeight * kHeight * depth + j % kHeight;
    for (Eigen::Index i = j / kHeight * kHeight; i < matrices.size; i += kHeight) {
      Multiply<Register>(panels + i * depth, columns, depth, tile.data());
      for (Eigen::Index c = 0; c < std::min<Eigen::Index>(kColumns, matrices.size - j); ++c) {
        const double* from = matrices.corner + (j + c) * matrices.corner_stride + i;
        double* to = matrices.complement + (j + c) * matrices.complement_stride + i;
        const Eigen::Index first = std::max<Eigen::Index>(0, j + c - i);  // below the diagonal
        const Eigen::Index end = std::min(kHeight, matrices.size - i);
        for (Eigen::Index r = first; r < end; ++r) to[r] = from[r] - tile[c * kHeight + r];
      }
    }
  }
}

SOSLAM_FOR_AVX2 void SubtractWide(const double* panels, Eigen::Index depth,
                                  const Matrices& matrices) {
  Subtract<Four>(panels, depth, matrices);
}

void SubtractNarrow(const double* panels, Eigen::Index depth, const Matrices& matrices) {
  Subtract<Two>(panels, depth, matrices);
}

}  // namespace

void SchurComplement(const Eigen::Ref<const Eigen::MatrixXd>& corner,
                     const Eigen::Ref<const Eigen::MatrixXd>& below, std::vector<double>* panels,
                     Eigen::Ref<Eigen::MatrixXd> complement, bool in_wide_registers) {
  eigen_assert(corner.rows() == corner.cols() && below.rows() == corner.rows());
  eigen_assert(complement.rows() == corner.rows() && complement.cols() == corner.cols());
  eigen_assert(below.cols() > 0);
  Pack(below, in_wide_registers ? kRows<Four> : kRows<Two>, panels);
  (in_wide_registers ? SubtractWide : SubtractNarrow)(
      panels->data(), below.cols(),
      {corner.rows(), corner.data(), corner.outerStride(), complement.data(),
       complement.outerStride()});
}

}  // namespace soslam
