// SPDX-License-Identifier: BSD-3-Clause
#include "planes/mounts.h"

#include <Eigen/Dense>
#include <algorithm>

namespace soslam {
namespace {

// The ceiling made parallel to the floor, through its own point.
EstimatedPlane Opposite(const EstimatedPlane& floor, EstimatedPlane ceiling) {
  const Eigen::Vector3d normal = -floor.plane_in_world.normal;
  ceiling.plane_in_world = {normal, -normal.dot(ceiling.point_in_world)};
  const Eigen::Vector3d& x = ceiling.x_axis_in_world;
  ceiling.x_axis_in_world = (x - normal.dot(x) * normal).normalized();
  return ceiling;
}

}  // namespace

Mount MountOf(const std::optional<ShapePrior>& prior) { return prior.value_or(ShapePrior()).mount; }

UpPrior DownOf(const UpPrior& attitude, const std::optional<PlanesEstimate>& floors) {
  UpPrior down{attitude.information, -attitude.up_in_world};
  if (!floors) return down;
  const EstimatedPlane& floor = floors->planes.front();
  down.up_in_world = -floor.plane_in_world.normal;
  // Rotations about x move the normal by -y, those about y by x.
  Eigen::Matrix<double, 3, 2> by_turns;
  by_turns.col(0) = floor.plane_in_world.normal.cross(floor.x_axis_in_world);
  by_turns.col(1) = -floor.x_axis_in_world;
  down.information =
      by_turns * floor.covariance->topLeftCorner<2, 2>().inverse() * by_turns.transpose();
  return down;
}

PlanesEstimate JoinedPlanes(const PlanesEstimate& floors, const PlanesEstimate& ceilings,
                            bool parallel, const std::vector<std::optional<ShapePrior>>& priors) {
  PlanesEstimate joined = floors;
  for (const EstimatedPlane& ceiling : ceilings.planes) {
    joined.planes.push_back(parallel ? Opposite(floors.planes.front(), ceiling) : ceiling);
  }
  for (size_t i = 0; i < priors.size(); ++i) {
    if (MountOf(priors[i]) != Mount::kHanging) continue;
    joined.objects[i] = ceilings.objects[i];
    joined.objects[i].plane_index += static_cast<int>(floors.planes.size());
  }
  joined.cost = *floors.cost + *ceilings.cost;
  joined.expected_cost += ceilings.expected_cost;
  joined.rounds = std::max(floors.rounds, ceilings.rounds);
  joined.settled = floors.settled && ceilings.settled;
  return joined;
}

}  // namespace soslam
