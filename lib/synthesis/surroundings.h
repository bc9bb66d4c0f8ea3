// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "synthesis/scene.h"

namespace soslam {

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

}  // namespace soslam
