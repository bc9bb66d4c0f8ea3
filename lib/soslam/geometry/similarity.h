// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "soslam/geometry/rigid3.h"

namespace soslam {

// Change of frame and unit: rigid * (scale * point).
struct Similarity {
  double scale = 1.0;
  Rigid3d rigid;

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const { return rigid * (scale * point); }
  Similarity operator*(const Similarity& other) const {
    return {
        scale * other.scale,
        {(rigid.rotation * other.rigid.rotation).normalized(), *this * other.rigid.translation}};
  }
};

}  // namespace soslam
