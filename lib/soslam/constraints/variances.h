// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/base/options.h"
#include "soslam/geometry/angles.h"

namespace soslam {

// The covariances of the paper's constraints, section VI: each squared residual is divided by its
// own. The paper gives the numbers 10, 10, 10 and 1 without units. In metres and radians they would
// let an object miss its box by its own size before it violated the ratio prior; docs/paper.md
// compares readings.
struct ConstraintVariances {
  double detection_dm4 = 10.0;
  double support_angle_deg2 = 10.0;
  double support_tangency_dm4 = 10.0;
  double ratio = 1.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Covariances of the constraints of the paper");
    visit.Real("detection_variance_dm4", &detection_dm4, {1e-12, 1e12},
               "Sigma_det of eq. (4): of squared lengths");
    visit.Real("support_angle_variance_deg2", &support_angle_deg2, {1e-12, 1e12},
               "Sigma_theta of eq. (8): of angles");
    visit.Real("support_tangency_variance_dm4", &support_tangency_dm4, {1e-12, 1e12},
               "Sigma_pi of eq. (8): of squared lengths");
    visit.Real("ratio_variance", &ratio, {1e-12, 1e12}, "Sigma_ssc of eq. (11): of ratios");
  }

  // Conversions to the units of the residuals.
  double DetectionM4() const { return 1e-4 * detection_dm4; }
  double SupportAngleRad2() const { return support_angle_deg2 * kRadPerDeg * kRadPerDeg; }
  double SupportTangencyM4() const { return 1e-4 * support_tangency_dm4; }
};

}  // namespace soslam
