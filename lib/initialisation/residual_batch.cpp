// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/residual_batch.h"

#include "base/wide_loops.h"

namespace soslam {
namespace {

// Products of every two columns (Jacobian, then residual): the lower triangle row by row.
constexpr size_t kNumProducts = (kLandmarkDof + 1) * (kLandmarkDof + 2) / 2;
using Products = std::array<double, kNumProducts>;
using Columns = std::array<const double*, kLandmarkDof + 1>;

// Sums of four, so that the order of additions is the same on any processor: compilers do not
// change it to use wide registers.
SOSLAM_MULTIVERSION void Multiply(const Columns& columns, Products* __restrict products) {
  size_t next = 0;
  for (size_t j = 0; j < columns.size(); ++j) {
    const double* one = columns[j];
    for (size_t k = 0; k <= j; ++k) {
      const double* other = columns[k];
      Four sums{};
      for (int i = 0; i < kBatchSize; i += 4) {
        Four a, b;
        Load(one + i, &a);
        Load(other + i, &b);
        sums += a * b;
      }
      (*products)[next++] = Sum(sums);
    }
  }
}

}  // namespace

ResidualBatch ResidualBatch::Zero() {
  ResidualBatch batch;
  batch.residual.setZero();
  for (Batch& column : batch.by_landmark) column.setZero();
  return batch;
}

void ResidualBatch::AddTo(double weight, LandmarkModel* sum) const {
  Columns columns;
  for (size_t k = 0; k < by_landmark.size(); ++k) columns[k] = by_landmark[k].data();
  columns.back() = residual.data();
  Products products;
  Multiply(columns, &products);
  size_t next = 0;
  for (int j = 0; j < kLandmarkDof; ++j) {
    for (int k = 0; k <= j; ++k) {
      const double product = weight * products[next++];
      sum->information(j, k) += product;
      if (k < j) sum->information(k, j) += product;
    }
  }
  for (int k = 0; k < kLandmarkDof; ++k) sum->gradient[k] += weight * products[next++];
  sum->cost += 0.5 * weight * products[next];
}

}  // namespace soslam
