// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/fronts.h"

#include <numbers>

#include "soslam/initialisation/object_evidence.h"

namespace soslam {

void FaceFront(const Sequence& in_map, const std::vector<std::optional<ShapePrior>>& priors,
               MapEstimate* map) {
  const auto detections_by_object = DetectionsByObject(in_map);
  for (ObjectEstimate& object : map->objects) {
    const auto index = static_cast<size_t>(object.object_index);
    const auto& prior = priors[index];
    const int plane_index = in_map.objects[index].plane_index;
    if (!object.landmark_in_world || !prior || !prior->has_front || plane_index == kNoPlane ||
        object.landmark_in_world->rests_on != RestingFace::kBottom) {
      continue;
    }
    const Plane& plane = in_map.planes[static_cast<size_t>(plane_index)].plane_in_world;
    const auto costs = PictureCosts(PicturesInWorld(in_map, detections_by_object[index]), plane);
    if (costs.empty()) continue;
    double probability = FrontProbability(costs, plane, *object.landmark_in_world);
    if (probability < 0.5) {
      object.landmark_in_world = RotatedAboutZ(*object.landmark_in_world, std::numbers::pi);
      probability = 1.0 - probability;
    }
    object.front_probability = probability * (1.0 - object.quarter_turn.value_or(0.0));
  }
}

}  // namespace soslam
