// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

namespace soslam {

// None if there are no values.
std::optional<double> MeanOf(const std::vector<double>& values);
std::optional<double> MedianOf(std::vector<double> values);

}  // namespace soslam
