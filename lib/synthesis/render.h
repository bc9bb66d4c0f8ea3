// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
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

// Appearance of the scene apart from its objects: floors, walls and tables in faint textures that
// an edge detector overlooks, under one soft light. Colours are blue, green, red, in grey levels.
// Keeps a reference to the scene.
class Surroundings {
 public:
  explicit Surroundings(const Scene& scene);

  // Brightness of a surface with that normal, as a factor on its colour, at most 1.
  double Light(const Eigen::Vector3d& normal_in_world) const;

  // Lit colour of a table at a point of its surface.
  Eigen::Vector3d TableColour(const Eigen::Vector3d& point_in_world,
                              const Eigen::Vector3d& normal_in_world) const;

  // Lit colour of the floor or wall that a ray meets first, or of the haze.
  Eigen::Vector3d BackgroundColour(const Eigen::Vector3d& origin_in_world,
                                   const Eigen::Vector3d& direction_in_world) const;

 private:
  Eigen::Vector3d FloorColour(int plane_index, const Eigen::Vector3d& point_in_world,
                              double distance) const;
  Eigen::Vector3d WallColour(const Plane& wall_in_world,
                             const Eigen::Vector3d& point_in_world) const;
  // Soft shadow under and around the objects on the plane, as a factor on its colour.
  double ContactShadow(int plane_index, const Eigen::Vector3d& point_in_plane) const;

  const Scene& scene_;
  std::vector<Rigid3d> plane_from_world_;  // one per plane of the scene
  Eigen::Vector3d light_in_world_;
};

// The camera's view of the scene, CV_8UC3 in blue, green, red, by casting 3 x 3 rays per pixel:
// soft light from above, no reflections, shadows only where objects touch their plane. Without
// noise.
cv::Mat RenderFrame(const Scene& scene, const Rigid3d& world_from_camera);

}  // namespace soslam
