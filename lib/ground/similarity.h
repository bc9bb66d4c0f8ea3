// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "geometry/rigid3.h"
#include "model/map_points.h"
#include "model/sequence.h"

namespace soslam {

// Change of the world's frame and unit: rigid * (scale * point).
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

// The sequence without planes, with its estimated poses in the target world. Ground truth stays.
Sequence Transformed(const Similarity& target_from_source, Sequence sequence);

std::vector<MapPoint> Transformed(const Similarity& target_from_source,
                                  std::vector<MapPoint> points);

}  // namespace soslam
