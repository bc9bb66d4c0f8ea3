// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/ratio_rows.h"

#include <cmath>

namespace soslam {

RatioRows::RatioRows(const ShapePrior& prior) {
  const double correlation = prior.log_correlation;
  const double unexplained = std::sqrt(1.0 - correlation * correlation);
  Eigen::Matrix2d whiten;
  whiten << 1.0, 0.0, -correlation / unexplained, 1.0 / unexplained;
  whiten *= prior.log_sigma.cwiseInverse().asDiagonal();
  by_log_half_axes << whiten, -whiten.rowwise().sum();
  at_prior = whiten * prior.ratio.array().log().matrix();
  information = by_log_half_axes.transpose() * by_log_half_axes;
}

}  // namespace soslam
