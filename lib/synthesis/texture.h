// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "synthesis/scene.h"

namespace soslam {

// The colour of an object's surface: flat patches with sharp borders, dark on pale, all around it.
// A patch is the intersection of a ball around a surface point with the surface. Exactly
// mirror-symmetric about the object's xz plane, and about no other plane or axis.
class SurfaceTexture {
 public:
  // Determined by the object's shape, half axes and texture_seed.
  explicit SurfaceTexture(const SceneObject& object);

  // The colour at a surface point: blue, green, red, grey levels 0-255, without light.
  Eigen::Vector3d Colour(const Eigen::Vector3d& point_in_object) const;

 private:
  struct Patch {
    Eigen::Vector3d centre_in_object;  // y >= 0; the mirror image is implied
    double squared_radius;
    Eigen::Vector3d colour;
  };

  Eigen::Vector3d base_colour_;
  std::vector<Patch> patches_;  // the first patch that contains a point gives its colour
};

}  // namespace soslam
