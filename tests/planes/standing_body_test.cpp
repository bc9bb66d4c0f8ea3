// SPDX-License-Identifier: BSD-3-Clause
#include "planes/standing_body.h"

#include <gtest/gtest.h>

#include "geometry/angles.h"
#include "support/random.h"
#include "support/scene.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

constexpr double kStep = 3.0 * kRadPerDeg;

// An object of a random scene with noisy boxes.
MultiViewObservation RandomObservation(int seed, bool noise = true) {
  Scene scene = RandomScene(seed, 1, 12, {Shape::kBox});
  scene.noise.box_edge_sigma = 0.02;
  const Sequence sequence = SyntheticSequence(scene, noise);
  return MakeMultiViewObservation(sequence, DetectionsByObject(sequence)[0],
                                  TrueCuboidPriors(sequence, 0.1)[0], 0.02, 0.0);
}

// After a body is carried along, it is as upright on its plane as before.
TEST(Moved, KeepsBodiesOnTheirPlanes) {
  for (int i = 0; i < 20; ++i) {
    const Plane plane = RandomPlane();
    UprightVector parameters;
    parameters << RandomUniform(-3, 3), RandomVector(-2, 2).head<2>(), RandomVector(-1, 1);
    const Landmark landmark = UprightGround(plane).LandmarkAt(parameters, kCuboidExponent);
    const Eigen::Vector3d pivot = RandomVector(-3, 3);
    const PlaneMotion motion = RandomVector(-0.5, 0.5);
    const Plane moved = Moved(plane, pivot, motion);
    const Landmark body = Moved(plane, pivot, motion, landmark);
    EXPECT_NEAR(moved.SignedDistance(body.Centre()), body.half_axes.z(), 1e-12);
    EXPECT_LT((body.frame_from_object.rotation * Eigen::Vector3d::UnitZ() - moved.normal).norm(),
              1e-12);
    // The rise is at the pivot.
    EXPECT_NEAR(plane.SignedDistance(pivot) - moved.SignedDistance(pivot), motion.z(), 1e-12);
  }
}

TEST(Moved, TurnsAboutTheLevelAxes) {
  const Plane floor;
  const Eigen::Vector3d x = UprightRotation(floor.normal, 0.0) * Eigen::Vector3d::UnitX();
  const Plane moved = Moved(floor, Eigen::Vector3d::Zero(), {0.1, 0.0, 0.0});
  EXPECT_NEAR(moved.normal.dot(x), 0.0, 1e-12);
  EXPECT_NEAR(moved.normal.dot(floor.normal), std::cos(0.1), 1e-12);
}

// Gradient and curvature of the cost of the best body against differences of that cost. The
// information leaves out second derivatives of the residuals, which count by their size: it is
// exact where boxes are. A motion of 1e-3 rad or m changes noisy costs by about 1, and the gradient
// by a few per cent of a standard deviation.
TEST(EvidenceOf, IsHowTheBestCostChanges) {
  const Eigen::Vector3d pivot(0.5, -0.5, 0.0);
  constexpr double kMotion = 1e-3;
  for (int trial = 0; trial < 10; ++trial) {
    SCOPED_TRACE(trial);
    const bool noise = trial % 2 == 0;
    MultiViewObservation observation = RandomObservation(trial / 2, noise);
    observation.huber_delta = 1e6;
    const auto start = SolveViews(observation, kStep);
    ASSERT_TRUE(start);
    const auto at = [&](const PlaneMotion& motion) {
      StandingBody body{observation, Moved(Plane(), pivot, motion, start->landmark)};
      body.observation.plane_in_world = Moved(Plane(), pivot, motion);
      return EvidenceOf(*FitOnPlane(body), pivot);
    };
    const PlaneEvidence here = at(PlaneMotion::Zero());
    for (int i = 0; i < 3; ++i) {
      const PlaneMotion motion = kMotion * PlaneMotion::Unit(i);
      const double above = at(motion).cost;
      const double below = at(-motion).cost;
      const double sigma = 1.0 / std::sqrt(here.information(i, i));
      EXPECT_NEAR((above - below) / (2.0 * kMotion) * sigma, here.gradient(i) * sigma, 0.1) << i;
      if (noise) continue;
      const double curvature = (above - 2.0 * here.cost + below) / (kMotion * kMotion);
      EXPECT_NEAR(curvature / here.information(i, i), 1.0, 0.15) << i;
    }
  }
}

TEST(FitBodyAtFreeHeight, FindsHeightAndBodyFromExactBoxes) {
  for (int seed = 0; seed < 6; ++seed) {
    SCOPED_TRACE(seed);
    const auto body =
        FitBodyAtFreeHeight(RandomObservation(seed, false), Eigen::Vector3d::UnitZ(), kStep);
    ASSERT_TRUE(body);
    EXPECT_NEAR(body->observation.plane_in_world.offset, 0.0, 0.005);
    EXPECT_LT(EvidenceOf(*body, body->landmark.Centre()).cost, 0.01);
  }
}

TEST(FitBodyAtFreeHeight, IsNoneForOneView) {
  MultiViewObservation observation = RandomObservation(1);
  observation.views.resize(1);
  EXPECT_FALSE(FitBodyAtFreeHeight(observation, Eigen::Vector3d::UnitZ(), kStep));
}

}  // namespace
}  // namespace soslam
