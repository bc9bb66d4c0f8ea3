// SPDX-License-Identifier: BSD-3-Clause
#include "ground/estimate_ground.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "geometry/angles.h"
#include "support/prior_scene.h"

namespace soslam {
namespace {

SemanticTable ShippedTable() {
  return ReadSemanticTable(SOSLAM_SOURCE_DIR "/pipelines/priors/semantic_table.json");
}

// Furniture and things of rooms.
const std::vector<std::string> kLabels = {
    "armchair",        "chair",       "sofa",         "nightstand", "stool", "suitcase",
    "trunk",           "backpack",    "trash can",    "bookcase",   "crate", "wardrobe",
    "washing machine", "piano",       "cup",          "bottle",     "bowl",  "microwave",
    "teddy bear",      "vase",        "speaker",      "printer",    "radio", "monitor",
    "laptop",          "milk carton", "potted plant", "toaster"};

PriorScene SceneOf(unsigned seed) {
  std::mt19937 random(seed);
  PriorSceneOptions options;
  options.objects = std::uniform_int_distribution<int>(4, 14)(random);
  options.has_table = std::uniform_int_distribution<int>(0, 3)(random) != 0;
  static const SemanticTable table = ShippedTable();
  return PriorSceneBuilder(table, kLabels, seed, options).Build();
}

GroundEstimate Estimate(const PriorScene& scene) {
  static const SemanticTable table = ShippedTable();
  return EstimateGround(scene.sequence, scene.points, {}, table, {}, 2);
}

TEST(SlowGroundTest, ScalesOfScenesFromThePriorAreWithinTheirIntervals) {
  const char* count = std::getenv("SOSLAM_SCENES");
  const int scenes = count ? std::atoi(count) : 40;
  for (int seed = 1; seed <= scenes; ++seed) {
    const PriorScene scene = SceneOf(static_cast<unsigned>(seed));
    const GroundEstimate estimate = Estimate(scene);
    const double truth = std::log(scene.metres_per_unit);
    std::string planes;
    for (const EstimatedPlane& plane : estimate.planes) {
      planes += fmt::format(" {:.3f}", plane.point_in_world.z());
    }
    std::string true_planes;
    for (double h : scene.plane_heights_m) true_planes += fmt::format(" {:.3f}", h);
    if (!estimate.scale) {
      fmt::print("{} none\n", seed);
      continue;
    }
    fmt::print(
        "{:3} boxes {} objects {} found {} ({:.1f})  err {:+.3f} sigma {:.3f} in {} width {:.2f} "
        "misfit {:.2f} modes {:.2f} up {:.2f} sigma {:.2f} cams {:.2f} planes{} (of {}) true{}\n",
        seed, scene.sequence.detections.size(), scene.objects, estimate.objects.size(),
        estimate.independent_objects, estimate.scale->log_scale - truth, estimate.scale->log_sigma,
        int(truth > estimate.scale->low && truth < estimate.scale->high),
        (estimate.scale->high - estimate.scale->low) / (2 * 1.96 * scene.prior_log_sigma),
        estimate.scale->misfit, estimate.scale->second_mode_share,
        AngleBetweenDeg(estimate.up_in_input, scene.up_in_world), kDegPerRad * estimate.tilt_sigma,
        kDegPerRad * estimate.attitude_tilt_sigma, planes, estimate.planes_of_points, true_planes);
  }
}

}  // namespace
}  // namespace soslam
