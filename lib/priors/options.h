// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "base/options.h"

namespace soslam {

// Treatment of rows that the base table has.
enum class BaseRows {
  kKeep,    // ratio, spread and shape stay; height and correlation are learned if they are missing
  kUpdate,  // they serve as prior and are updated with the data
};
inline constexpr std::array kBaseRowsNames = {"keep", "update"};

// Options of soslam-learn-priors.
struct LearnPriorsOptions {
  BaseRows base_rows = BaseRows::kUpdate;
  double min_log_sigma = 0.1;
  double spread_weight = 4.0;
  double correlation_weight = 8.0;
  int min_views = 10;

  void Describe(OptionVisitor& visit) {
    visit.Group("Table");
    visit.Choice("base_rows", &base_rows, kBaseRowsNames,
                 "keep: ratios, spreads and shapes of the base table stay, what it lacks is "
                 "learned; update: its ratios and heights count as so many objects as they were "
                 "learned from, at least one, its correlations as correlation_weight, its shapes "
                 "where none is learned");
    visit.Group("Ratios, heights and shapes");
    visit.Real("min_log_sigma", &min_log_sigma, {1e-3, 1.0},
               "Robust spread of a label's logarithms is taken to be at least this");
    visit.Real("spread_weight", &spread_weight, {0.1, 1e3},
               "What the spread of all labels (or of the base table's row) counts as, in objects");
    visit.Real("correlation_weight", &correlation_weight, {0.1, 1e3},
               "What the correlation over all labels counts as, in objects");
    visit.Integer("min_views", &min_views, {1, 1000000},
                  "Boxes that an object needs for its shape exponent to be learned");
  }
};

}  // namespace soslam
