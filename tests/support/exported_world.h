// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "soslam/exchange/world.h"
#include "support/random.h"

namespace soslam {

inline WorldObject ExportedObject(int id, const std::string& label, const Landmark& landmark) {
  WorldObject object{id, label, 4, RandomVector(-1, 1).normalized(), 0.25, {}};
  object.estimate.observations = 10 + id;
  object.estimate.landmark_in_world = landmark;
  return object;
}

// A cuboid with a covariance, an ellipsoid, a cylinder whose label wants quoting, and an object
// without a landmark. The first two frames look at them; the last one, which has no image, looks
// away.
inline World ExportedWorld() {
  const auto landmark = [](const ShapeExponents& shape_exponents) {
    Landmark body = RandomLandmarkInCamera();
    body.shape_exponents = shape_exponents;
    return body;
  };
  World world;
  world.segment = 4;
  world.objects = {ExportedObject(2, "Dining_Table", landmark(kCuboidExponent)),
                   ExportedObject(3, "cup", landmark(kEllipsoidExponent)),
                   ExportedObject(5, "a \"b\", c", landmark({2.0, 1.0})),
                   {8, "cup", 4, Eigen::Vector3d::UnitZ(), 0.5, {}}};
  const Covariance9 root = Covariance9::Random();
  world.objects[0].estimate.covariance = 1e-2 * root * root.transpose();
  world.objects[3].estimate.failure = "no_start";
  const Eigen::Quaterniond away(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitY()));
  world.frames = {{10, 1311868164.3631, "rgb/a.png", TestCamera(), {}},
                  {15, 1311868164.3999, "rgb/b.png", TestCamera(), {}},
                  {20, 1311868165.0 + 1.0 / 3.0, "", TestCamera(), {away, {0.1, 0.2, 0.3}}}};
  world.frames[1].world_from_camera.translation = {1.5, -1.0, 1.0 / 3.0};
  return world;
}

}  // namespace soslam
