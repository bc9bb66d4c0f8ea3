// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "soslam/synthesis/scene.h"

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

// The camera's view of the scene, CV_8UC3 in blue, green, red, by casting 3 x 3 rays per pixel:
// soft light from above, no reflections, shadows only where objects touch their plane. Without
// noise.
cv::Mat RenderFrame(const Scene& scene, const Rigid3d& world_from_camera);

}  // namespace soslam
