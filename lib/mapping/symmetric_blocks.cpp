// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/symmetric_blocks.h"

#include <algorithm>
#include <numeric>

namespace soslam {

SymmetricBlocks::SymmetricBlocks(std::vector<int> sizes, std::vector<std::array<int, 2>> couplings)
    : sizes_(std::move(sizes)), first_rows_(sizes_.size() + 1, 0) {
  std::partial_sum(sizes_.begin(), sizes_.end(), first_rows_.begin() + 1);
  for (int i = 0; i < NumVariables(); ++i) couplings.push_back({i, i});
  std::ranges::sort(couplings, {}, [](const auto& c) { return std::array{c[1], c[0]}; });
  couplings.erase(std::unique(couplings.begin(), couplings.end()), couplings.end());
  size_t begin = 0;
  for (const auto& [row, column] : couplings) {
    if (row == column) first_blocks_.push_back(blocks_.size());
    blocks_.push_back({row, column, begin});
    begin += static_cast<size_t>(Size(row) * Size(column));
  }
  first_blocks_.push_back(blocks_.size());
  values_.assign(begin, 0.0);
}

size_t SymmetricBlocks::Begin(int row, int column) const {
  const auto at = [&](int i) {
    return blocks_.begin() + static_cast<std::ptrdiff_t>(first_blocks_[static_cast<size_t>(i)]);
  };
  return std::ranges::lower_bound(at(column), at(column + 1), row, {}, &Block::row)->begin;
}

Eigen::VectorXd SymmetricBlocks::Diagonal() const {
  Eigen::VectorXd diagonal(NumRows());
  for (int i = 0; i < NumVariables(); ++i) {
    diagonal.segment(FirstRow(i), Size(i)) = At(i, i).diagonal();
  }
  return diagonal;
}

}  // namespace soslam
