// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"

namespace soslam {

// The covariances of the paper's constraints, section VI: each squared residual is divided by its
// own.
struct ConstraintVariances {
  double detection = 10.0;
  double support_angle = 10.0;
  double support_tangency = 10.0;
  double ratio = 1.0;

  void Describe(OptionVisitor& visit) {
    visit.Real("detection_variance", &detection, {1e-12, 1e12}, "Sigma_det of eq. (4), m^4");
    visit.Real("support_angle_variance", &support_angle, {1e-12, 1e12}, "Sigma_theta of eq. (8)");
    visit.Real("support_tangency_variance", &support_tangency, {1e-12, 1e12},
               "Sigma_pi of eq. (8), m^4");
    visit.Real("ratio_variance", &ratio, {1e-12, 1e12}, "Sigma_ssc of eq. (11)");
  }
};

}  // namespace soslam
