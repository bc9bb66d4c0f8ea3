// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "initialisation/semantic_table.h"
#include "synthesis/random_scene.h"
#include "synthesis/simulate.h"

namespace soslam {

// Each object's true ratio, known to log_sigma, and a cuboid's shape.
inline std::vector<std::optional<ShapePrior>> TrueCuboidPriors(const Sequence& sequence,
                                                               double log_sigma) {
  std::vector<std::optional<ShapePrior>> priors;
  for (const Object& object : sequence.objects) {
    const Eigen::Vector3d& half_axes = object.ground_truth->landmark_in_world.half_axes;
    priors.push_back(ShapePrior{half_axes.head<2>() / half_axes.z(),
                                Eigen::Vector2d::Constant(log_sigma), kCuboidExponent});
  }
  return priors;
}

// The scene with the objects of odd index on a shelf this much higher (m).
inline Scene WithShelf(Scene scene, double height) {
  scene.planes.push_back({1, "shelf", {Eigen::Vector3d::UnitZ(), -height}, std::nullopt});
  for (size_t i = 1; i < scene.objects.size(); i += 2) scene.objects[i].plane_index = 1;
  return scene;
}

// The scene with the objects of odd index hanging from a ceiling at this height (m) over where they
// stood.
inline Scene WithCeiling(Scene scene, double height) {
  const Plane floor = scene.planes[0].plane_in_world;
  const Plane ceiling{-Eigen::Vector3d::UnitZ(), height};
  const Rigid3d ceiling_from_floor = WorldFromPlane(ceiling).Inverse() * WorldFromPlane(floor);
  scene.planes.push_back({1, "ceiling", ceiling, std::nullopt});
  for (size_t i = 1; i < scene.objects.size(); i += 2) {
    SceneObject& object = scene.objects[i];
    object.plane_index = 1;
    const Eigen::Vector3d place(object.position_on_plane.x(), object.position_on_plane.y(), 0.0);
    object.position_on_plane = (ceiling_from_floor * place).head<2>();
  }
  return scene;
}

// The sequence with all planes turned by a degree or so and raised by 5 cm, as if estimated, under
// hardly any knowledge of up.
inline Sequence OnPlanesToEstimate(Sequence sequence) {
  const Eigen::Quaterniond turn = ExpRotation(Eigen::Vector3d(0.015, -0.02, 0.0));
  for (SupportPlane& plane : sequence.planes) {
    plane.plane_in_world.normal = turn * plane.plane_in_world.normal;
    plane.plane_in_world.offset -= 0.05;
    plane.attitude_information = 1e-3 * Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  }
  return sequence;
}

// The sequence in another world.
inline Sequence Moved(const Rigid3d& new_from_old, Sequence sequence) {
  for (Frame& frame : sequence.frames) {
    frame.world_from_camera = new_from_old * frame.world_from_camera;
    if (frame.true_world_from_camera) {
      frame.true_world_from_camera = new_from_old * *frame.true_world_from_camera;
    }
  }
  for (SupportPlane& plane : sequence.planes) {
    plane.plane_in_world = Transform(new_from_old, plane.plane_in_world);
  }
  for (Object& object : sequence.objects) {
    if (!object.ground_truth) continue;
    Landmark& landmark = object.ground_truth->landmark_in_world;
    landmark = Transform(new_from_old, landmark);
  }
  return sequence;
}

}  // namespace soslam
