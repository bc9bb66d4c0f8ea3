// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>

namespace soslam {

// Standard deviations per axis of the measured motion between two frames. A small rotation errs by
// a fraction of itself; a large one by no more than what images tell, `rotation_rad`.
struct OdometryNoise {
  double rotation_rad = 0.0;
  double translation_m = 0.0;
  double rotation_fraction = 0.0;  // 0: every rotation errs by rotation_rad

  double RotationSigma(const Eigen::Quaterniond& rotation) const;
};

}  // namespace soslam
