// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "initialisation/semantic_table.h"
#include "model/sequence.h"
#include "synthesis/random_scene.h"
#include "synthesis/simulate.h"

namespace soslam {

// Posts and mats, each label twice, whose boxes are no objects' yet.
inline Sequence PostsAndMats() {
  Scene scene = RandomScene(2, 4, 20, {Shape::kBox});
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    scene.objects[i].label = i % 2 == 0 ? "post" : "mat";
    scene.objects[i].half_axes =
        i % 2 == 0 ? Eigen::Vector3d(0.1, 0.1, 0.5) : Eigen::Vector3d(0.5, 0.5, 0.1);
  }
  Sequence sequence = SyntheticSequence(scene, false);
  sequence.planes.clear();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  return sequence;
}

// `log_sigma`: of ratios and heights.
inline SemanticTable TableOfPostsAndMats(double log_sigma = 0.3) {
  const auto prior = [log_sigma](double ratio, double height_m) {
    ShapePrior prior{Eigen::Vector2d::Constant(ratio), Eigen::Vector2d::Constant(log_sigma),
                     kCuboidExponent};
    prior.height_m = LogNormal{height_m, log_sigma};
    return prior;
  };
  SemanticTable table;
  table.priors = {{"post", prior(0.2, 1.0)}, {"mat", prior(5.0, 0.2)}};
  return table;
}

}  // namespace soslam
