// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/planes/planes_estimate.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "soslam/geometry/angles.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/planes/plane_heights.h"
#include "soslam/planes/standing_body.h"
#include "support/random.h"
#include "support/scene.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

Sequence ShelfSequence() {
  return SyntheticSequence(WithShelf(RandomScene(1, 4, 12, {Shape::kBox}), 0.3), false);
}

// Two planes of any attitude; objects stand on one and the other in turn.
PlanesEstimate AnyEstimate(const Sequence& sequence) {
  PlanesEstimate estimate;
  for (int i = 0; i < 2; ++i) {
    EstimatedPlane plane;
    plane.plane_in_world = RandomPlane();
    plane.point_in_world = -plane.plane_in_world.offset * plane.plane_in_world.normal;
    estimate.planes.push_back(plane);
  }
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    estimate.objects.push_back({static_cast<int>(i % 2), SupportReason::kOwnHeight, {}, {}, {}});
  }
  return estimate;
}

TEST(WithPlanes, CarriesThePlanesIntoEveryFrame) {
  const Sequence sequence = ShelfSequence();
  const PlanesEstimate estimate = AnyEstimate(sequence);
  const Sequence with = WithPlanes(sequence, estimate);
  ASSERT_EQ(with.planes.size(), 2u);
  EXPECT_EQ(with.planes[1].id, 1);
  ASSERT_EQ(with.detections.size(), sequence.detections.size());
  for (const Detection& detection : with.detections) {
    const int plane_index = detection.object_index % 2;
    EXPECT_EQ(with.objects[detection.object_index].plane_index, plane_index);
    const Plane& in_world = estimate.planes[plane_index].plane_in_world;
    const Frame& frame = with.frames[detection.frame_index];
    const Eigen::Vector3d point_in_camera = RandomVector(-2, 2);
    EXPECT_NEAR(detection.plane_in_camera.SignedDistance(point_in_camera),
                in_world.SignedDistance(frame.world_from_camera * point_in_camera), 1e-9);
  }
}

TEST(CompareWithGiven, MeasuresAgainstThePlaneOfMost) {
  const Sequence sequence = ShelfSequence();
  PlanesEstimate estimate = AnyEstimate(sequence);
  // Tilted by 0.02 rad, 0.1 m over the shelf at its point.
  estimate.planes[1].plane_in_world.normal = {std::sin(0.02), 0.0, std::cos(0.02)};
  estimate.planes[1].point_in_world = {1.0, 2.0, 0.4};
  const auto error = CompareWithGiven(sequence, estimate, 1);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->given_plane_index, 1);
  EXPECT_NEAR(error->angle, 0.02, 1e-12);
  EXPECT_NEAR(error->offset, 0.1, 1e-12);
}

// A camera that drives level 1.65 m over z = 0, and an object beside the way.
TEST(PlanesBelowCameras, IsTheGroundUnderALevelDrive) {
  Sequence sequence;
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // forward along x
  for (int i = 0; i < 5; ++i) {
    Frame frame;
    frame.id = i;
    frame.world_from_camera = {Eigen::Quaterniond(axes), {i * 1.0, 0.3, 1.65}};
    sequence.frames.push_back(frame);
  }
  sequence.planes = {{0, RandomPlane()}};
  sequence.objects = {{1, "car", 0, {}}, {2, "car", 0, {}}};
  sequence.detections = {{1, 0, 1.0, {10, 10, 50, 50}, {}, {}, {}}};
  const PlanesEstimate estimate = PlanesBelowCameras(sequence, 1.65);
  ASSERT_EQ(estimate.planes.size(), 2u);
  for (const EstimatedPlane& plane : estimate.planes) {
    EXPECT_LT((plane.plane_in_world.normal - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(plane.plane_in_world.offset, 0.0, 1e-12);
    EXPECT_FALSE(plane.covariance);
  }
  EXPECT_NEAR(estimate.planes[0].point_in_world.x(), 1.0, 1e-12);
  EXPECT_EQ(estimate.objects[0].reason, SupportReason::kCameraHeight);
  EXPECT_EQ(estimate.objects[1].reason, SupportReason::kNoViews);
  const Plane in_camera = WithPlanes(sequence, estimate).detections[0].plane_in_camera;
  const Plane ground = GroundInCamera(1.65);
  EXPECT_LT((in_camera.normal - ground.normal).norm(), 1e-12);
  EXPECT_NEAR(in_camera.offset, ground.offset, 1e-12);
}

using testing::ElementsAre;

constexpr double kMaxTilt = 0.1;
constexpr double kNewLevel = 10.0;

// An object with its foot at (x, y) from the pivot on the plane z = height + slope . (x, y), its
// height known to sigma and its tilt not at all. A motion of the plane raises it at the foot by
// turn_x y - turn_y x + rise.
PlaneEvidence FootAt(double x, double y, double sigma) {
  const Eigen::Vector3d d_motion(y, -x, 1.0);
  PlaneEvidence evidence;
  evidence.information = d_motion * d_motion.transpose() / (sigma * sigma);
  return evidence;
}

TEST(ClusterPlaneHeights, GroupsHeightsByTheirUncertainty) {
  const auto levels_of = [](double sigma) {
    const std::vector<PlaneEvidence> evidence(4, FootAt(0, 0, sigma));
    return ClusterPlaneHeights(evidence, {0.51, 0.0, 0.50, 0.01}, {}, kMaxTilt, kNewLevel);
  };
  const PlaneHeights sure = levels_of(0.02);
  EXPECT_THAT(sure.level_of, ElementsAre(1, 0, 1, 0));
  ASSERT_EQ(sure.heights.size(), 2u);
  EXPECT_NEAR(sure.heights[0], 0.005, 1e-9);
  EXPECT_NEAR(sure.heights[1], 0.505, 1e-9);
  EXPECT_THAT(levels_of(0.5).level_of, ElementsAre(0, 0, 0, 0));
  EXPECT_THAT(levels_of(0.0001).level_of, ElementsAre(3, 0, 2, 1));
}

// Heights at the pivot of objects far apart differ as the tilt is wrong: with the right one they
// agree. Steps of the grid are max_tilt / 32.
TEST(ClusterPlaneHeights, FindsTheTiltInWhichFewLevelsDo) {
  const Eigen::Vector2d tilt(0.05, -0.025);
  const std::vector<Eigen::Vector2d> feet = {{2, 0}, {-2, 1}, {0, 3}, {1, -2}, {-1, -1}};
  std::vector<PlaneEvidence> evidence;
  std::vector<double> heights;
  for (const Eigen::Vector2d& foot : feet) {
    evidence.push_back(FootAt(foot.x(), foot.y(), 0.01));
    heights.push_back(tilt.x() * foot.y() - tilt.y() * foot.x());
  }
  heights[4] += 0.4;
  const PlaneHeights levels = ClusterPlaneHeights(evidence, heights, {}, kMaxTilt, kNewLevel);
  EXPECT_LT((levels.tilt - tilt).norm(), kMaxTilt / 32);
  EXPECT_THAT(levels.level_of, ElementsAre(0, 0, 0, 0, 1));
  EXPECT_NEAR(levels.heights[1] - levels.heights[0], 0.4, 0.02);
}

TEST(ClusterPlaneHeights, HoldsTheTiltToItsPrior) {
  PlaneEvidence prior;
  prior.information.diagonal() << 1e6, 1e6, 0.0;
  const Eigen::Vector2d expected(0.05, 0.0);
  prior.gradient.head<2>() = -1e6 * expected;
  const PlaneHeights levels =
      ClusterPlaneHeights({FootAt(1, 2, 0.01)}, {0.3}, prior, kMaxTilt, kNewLevel);
  EXPECT_LT((levels.tilt - expected).norm(), kMaxTilt / 32);
}

// The partition against all others: numbers of levels are few enough to try.
TEST(ClusterPlaneHeights, NoOtherGroupingCostsLess) {
  for (int trial = 0; trial < 20; ++trial) {
    constexpr size_t kObjects = 5;
    std::vector<PlaneEvidence> evidence;
    std::vector<double> heights, weights;
    for (size_t i = 0; i < kObjects; ++i) {
      const double sigma = RandomUniform(0.02, 0.2);
      evidence.push_back(FootAt(0, 0, sigma));
      heights.push_back(RandomUniform(0, 1));
      weights.push_back(1.0 / (sigma * sigma));
    }
    double lowest = std::numeric_limits<double>::infinity();
    for (int code = 0; code < 3125; ++code) {  // 5^5 labellings
      std::array<double, kObjects> weight{}, first{}, second{};
      int rest = code;
      for (size_t i = 0; i < kObjects; ++i, rest /= 5) {
        const auto level = static_cast<size_t>(rest % 5);
        weight[level] += weights[i];
        first[level] += weights[i] * heights[i];
        second[level] += weights[i] * heights[i] * heights[i];
      }
      double cost = 0.0;
      for (size_t level = 0; level < kObjects; ++level) {
        if (weight[level] == 0.0) continue;
        cost += kNewLevel + 0.5 * (second[level] - first[level] * first[level] / weight[level]);
      }
      lowest = std::min(lowest, cost);
    }
    EXPECT_NEAR(ClusterPlaneHeights(evidence, heights, {}, kMaxTilt, kNewLevel).cost, lowest, 1e-6);
  }
}

// A body that may float by sigma says as much about the plane's height as the variances together.
TEST(WithHeightNoise, AddsTheVariances) {
  PlaneEvidence evidence = FootAt(1.0, 2.0, 0.03);
  evidence.cost = 7.0;
  evidence.gradient = evidence.information.col(2) * 0.01;
  const PlaneEvidence loose = WithHeightNoise(evidence, 0.04);
  EXPECT_LT((loose.information - FootAt(1.0, 2.0, 0.05).information).norm(), 1e-9);
  // The plane is 0.01 m from where the body would have it, at either looseness.
  EXPECT_LT((loose.gradient - loose.information.col(2) * 0.01).norm(), 1e-9);
  EXPECT_NEAR(evidence.cost - loose.cost,
              0.5 * 0.01 * 0.01 * (1.0 / (0.03 * 0.03) - 1.0 / (0.05 * 0.05)), 1e-9);
  EXPECT_EQ(WithHeightNoise(evidence, 0.0).information, evidence.information);
}

constexpr double kStep = 3.0 * kRadPerDeg;

// An object of a random scene with noisy boxes.
ObjectEvidence RandomEvidence(int seed, bool noise = true) {
  Scene scene = RandomScene(seed, 1, 12, {Shape::kBox});
  scene.noise.box_edge_sigma = 0.02;
  const Sequence sequence = SyntheticSequence(scene, noise);
  return EvidenceInWorld(sequence, DetectionsByObject(sequence)[0],
                         TrueCuboidPriors(sequence, 0.1)[0], {.axes_weight = 0.0});
}

// After a body is carried along, it is as upright on its plane as before.
TEST(ApplyMotion, KeepsBodiesOnTheirPlanes) {
  for (int i = 0; i < 20; ++i) {
    const Plane plane = RandomPlane();
    UprightVector parameters;
    parameters << RandomUniform(-3, 3), RandomVector(-2, 2).head<2>(), RandomVector(-1, 1), 0.0;
    const Landmark landmark = UprightParametrisation(plane).LandmarkAt(parameters, kCuboidExponent);
    const Eigen::Vector3d pivot = RandomVector(-3, 3);
    const PlaneMotion motion = RandomVector(-0.5, 0.5);
    const Plane moved = ApplyMotion(plane, pivot, motion);
    const Landmark body = ApplyMotion(plane, pivot, motion, landmark);
    EXPECT_NEAR(moved.SignedDistance(body.Centre()), body.half_axes.z(), 1e-12);
    EXPECT_LT((body.frame_from_object.rotation * Eigen::Vector3d::UnitZ() - moved.normal).norm(),
              1e-12);
    // The rise is at the pivot.
    EXPECT_NEAR(plane.SignedDistance(pivot) - moved.SignedDistance(pivot), motion.z(), 1e-12);
  }
}

// Gradient and curvature of the cost of the best body against differences of that cost. The
// information leaves out second derivatives of the residuals, which count by their size: it is
// exact where boxes are. A motion of 1e-3 rad or m changes noisy costs by about 1, and the gradient
// by a few per cent of a standard deviation.
TEST(ComputePlaneEvidence, IsHowTheBestCostChanges) {
  const Eigen::Vector3d pivot(0.5, -0.5, 0.0);
  constexpr double kMotion = 1e-3;
  for (int trial = 0; trial < 10; ++trial) {
    SCOPED_TRACE(trial);
    const bool noise = trial % 2 == 0;
    ObjectEvidence evidence = RandomEvidence(trial / 2, noise);
    evidence.huber_delta = 1e6;
    const auto start = FitObject(evidence, kStep, 1);
    ASSERT_FALSE(start.empty());
    const auto at = [&](const PlaneMotion& motion) {
      StandingBody body{evidence, ApplyMotion(Plane(), pivot, motion, start.front().landmark)};
      body.evidence.plane = ApplyMotion(Plane(), pivot, motion);
      return ComputePlaneEvidence(*FitOnPlane(body), pivot);
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
        FitBodyAtFreeHeight(RandomEvidence(seed, false), Eigen::Vector3d::UnitZ(), kStep);
    ASSERT_TRUE(body);
    EXPECT_NEAR(body->evidence.plane.offset, 0.0, 0.005);
    EXPECT_LT(ComputePlaneEvidence(*body, body->landmark.Centre()).cost, 0.01);
  }
}

}  // namespace
}  // namespace soslam
