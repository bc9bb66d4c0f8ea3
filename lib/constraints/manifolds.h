// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/manifold.h>
#include <ceres/product_manifold.h>
#include <ceres/sphere_manifold.h>

namespace soslam {

// The manifold of a pose block (see parameters.h): 6 tangent dimensions.
inline ceres::Manifold* NewPoseManifold() {
  return new ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<3>>;
}

// The manifold of a landmark block: 9 tangent dimensions. Its rotation part is half a rotation
// vector applied from the left (Ceres' convention).
inline ceres::Manifold* NewLandmarkManifold() {
  return new ceres::ProductManifold<ceres::EigenQuaternionManifold, ceres::EuclideanManifold<6>>;
}

// The manifold of a plane's normal: 2 tangent dimensions.
inline ceres::Manifold* NewNormalManifold() { return new ceres::SphereManifold<3>; }

}  // namespace soslam
