// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/iou.h"
#include "soslam/initialisation/body_at_yaw.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/initialisation/svd.h"
#include "support/cuboid_map.h"
#include "support/one_body.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

constexpr double kSigmaFraction = 0.02;

Landmark RandomBodyOnFloor(const ShapeExponents& shape_exponents) {
  Landmark body;
  body.shape_exponents = shape_exponents;
  body.half_axes = RandomVector(0.2, 0.6);
  body.frame_from_object = {
      UprightRotation(Eigen::Vector3d::UnitZ(), RandomUniform(-3, 3)),
      {RandomUniform(-0.3, 0.3), RandomUniform(-0.3, 0.3), body.half_axes.z()}};
  return body;
}

std::vector<Rigid3d> Arc(int views) { return CamerasOnArc(views, 1.5); }

// An upright body on the floor, seen with exact boxes, and what is known of it.
struct World {
  World(const ShapeExponents& shape_exponents, const std::vector<Rigid3d>& world_from_camera)
      : truth(RandomBodyOnFloor(shape_exponents)),
        sequence(ViewsOfBody(truth, world_from_camera)) {}

  ShapePrior Prior(double log_sigma) const {
    return {truth.half_axes.head<2>() / truth.half_axes.z(),
            {log_sigma, log_sigma},
            truth.shape_exponents};
  }
  ObjectEvidence Evidence(const std::optional<ShapePrior>& prior) const {
    return EvidenceInWorld(sequence, DetectionsByObject(sequence)[0], prior,
                           {.detection_sigma_fraction = kSigmaFraction, .axes_weight = 0.0});
  }
  double TrueYaw() const { return Yaw(Eigen::Vector3d::UnitZ(), truth.frame_from_object.rotation); }

  Landmark truth;
  Sequence sequence;
};

void ExpectSame(const Landmark& found, const Landmark& expected, double tolerance) {
  EXPECT_LT((found.Centre() - expected.Centre()).norm(), tolerance);
  EXPECT_LT((found.half_axes - expected.half_axes).norm(), tolerance);
  EXPECT_EQ(found.shape_exponents, expected.shape_exponents);
}

// Expects the true body from the views at its yaw.
void ExpectTruth(const World& world, const ObjectEvidence& evidence, double tolerance = 1e-4) {
  const auto found = BodyAtYaw(evidence).Solve(world.TrueYaw());
  ASSERT_TRUE(found);
  ExpectSame(*found, world.truth, tolerance);
  EXPECT_LT(EvaluateCost(evidence, *found).total, tolerance);
}

// The plane is given one metre too low.
TEST(WeighViews, APlaneCountsOnlyWhereItsHeightIsKnown) {
  const World world(kCuboidExponent, Arc(5));
  const auto weights_at = [&](double offset, bool height_is_free) {
    ObjectEvidence evidence = world.Evidence(world.Prior(0.3));
    evidence.plane.offset = offset;
    evidence.height_is_free = height_is_free;
    WeighViews(0.3, &evidence);
    std::vector<double> weights;
    for (const BoxView& view : evidence.views) weights.push_back(view.weight);
    return weights;
  };
  EXPECT_EQ(weights_at(0.0, true), weights_at(3.0, true));
  EXPECT_NE(weights_at(0.0, false), weights_at(3.0, false));
}

TEST(BodyAtYaw, FindsTheHeightOfTheFootWhereItIsFree) {
  for (const double exponent : {kCuboidExponent, 1.4, kEllipsoidExponent}) {
    World world(exponent, Arc(8));
    ObjectEvidence evidence = world.Evidence(world.Prior(0.2));
    evidence.plane.offset += 1.0;
    evidence.height_is_free = true;
    ExpectTruth(world, evidence, 1e-3);
  }
}

// How high a body is says how far away it is, also where the camera was in one place only.
TEST(BodyAtYaw, AKnownSizeTellsDepthFromOneBox) {
  World world(kCuboidExponent, {LookingAt({4, 0, 1.6}, {0, 0, 0.4})});
  ObjectEvidence evidence = world.Evidence(world.Prior(0.02));
  evidence.height_is_free = true;
  EXPECT_FALSE(BodyAtYaw(evidence).Solve(world.TrueYaw()));
  evidence.prior->height_m = LogNormal{2.0 * world.truth.half_axes.z(), 0.02};
  EXPECT_FALSE(BodyAtYaw(evidence).Solve(world.TrueYaw()));
  evidence.size_is_known = true;
  ExpectTruth(world, evidence, 1e-3);
}

// The grid of yaws is no coarser or finer, and begins nowhere else, in a world that is turned.
TEST(ProfileOverYaw, TurnsAlongWithTheWorld) {
  for (int i = 0; i < 20; ++i) {
    World world(1.1, Arc(5));
    const auto optima =
        ProfileOverYaw(world.Evidence(world.Prior(0.3)), 10.0 * kRadPerDeg).Minima(1);
    const Rigid3d turn{
        Eigen::Quaterniond(Eigen::AngleAxisd(RandomUniform(-3, 3), Eigen::Vector3d::UnitZ())),
        {RandomUniform(-5, 5), RandomUniform(-5, 5), 0.0}};
    for (Frame& frame : world.sequence.frames) {
      frame.world_from_camera = turn * frame.world_from_camera;
    }
    const auto turned =
        ProfileOverYaw(world.Evidence(world.Prior(0.3)), 10.0 * kRadPerDeg).Minima(1);
    ASSERT_FALSE(optima.empty());
    ASSERT_EQ(turned.size(), optima.size());
    for (size_t k = 0; k < optima.size(); ++k) {
      const Landmark expected = Transform(turn, optima[k]);
      ExpectSame(turned[k], expected, 1e-6);
      EXPECT_LT(
          turned[k].frame_from_object.rotation.angularDistance(expected.frame_from_object.rotation),
          1e-6);
    }
  }
}

TEST(BodyAtYaw, RecoversTheBodyFromExactBoxes) {
  for (const ShapeExponents& p : kShapeExponents) {
    SCOPED_TRACE(p);
    for (int i = 0; i < 20; ++i) {
      const World world(p, Arc(6));
      ExpectTruth(world, world.Evidence(world.Prior(0.3)));
    }
  }
}

TEST(BodyAtYaw, FindsTheRatioOfACuboidWithoutAPrior) {
  for (int i = 0; i < 20; ++i) {
    const World world(kCuboidExponent, Arc(6));
    ExpectTruth(world, world.Evidence(std::nullopt));
  }
}

TEST(BodyAtYaw, IsNotMisledByOneWrongBox) {
  World world(kCuboidExponent, Arc(12));
  world.sequence.detections[5].box.x_max += 150.0;
  world.sequence.detections[5].box.y_min -= 80.0;
  const auto found = BodyAtYaw(world.Evidence(world.Prior(0.3))).Solve(world.TrueYaw());
  ASSERT_TRUE(found);
  EXPECT_GT(BoxIou(*found, world.truth), 0.9);
}

TEST(BodyAtYaw, LetsTheBodyReachBeyondOneSidedEdges) {
  World world(kCuboidExponent, Arc(8));
  for (Detection& detection : world.sequence.detections) {
    detection.box.y_max -= 0.3 * detection.box.Height();
  }
  const auto taken_for_measured =
      BodyAtYaw(world.Evidence(world.Prior(0.3))).Solve(world.TrueYaw());
  EXPECT_TRUE(!taken_for_measured || BoxIou(*taken_for_measured, world.truth) < 0.95);
  for (Detection& detection : world.sequence.detections) detection.is_one_sided[3] = true;
  ExpectTruth(world, world.Evidence(world.Prior(0.3)));
}

TEST(BodyAtYaw, IsExactWithBoxesOfAKnownBias) {
  World world(kCuboidExponent, Arc(8));
  for (Detection& detection : world.sequence.detections) {
    detection.box.y_max -= 0.2 * detection.box.Height();
  }
  ShapePrior prior = world.Prior(0.3);
  prior.edge_bias = {0.0, 0.0, 0.0, -0.25};  // of the height that is left
  ExpectTruth(world, world.Evidence(prior));
}

TEST(FitObject, PolishesTheYaw) {
  for (int i = 0; i < 10; ++i) {
    World world(kCuboidExponent, Arc(8));
    const auto found = FitObject(world.Evidence(world.Prior(0.05)), 3.0 * kRadPerDeg, 1);
    ASSERT_FALSE(found.empty());
    EXPECT_GT(BoxIou(found.front().landmark, world.truth), 0.97);
  }
}

// Moving straight ahead, parallax is too small for the dual quadric of noisy boxes.
TEST(InitialiseMultiView, NeedsNoWideBaseline) {
  double multi_view = 0.0;
  double svd = 0.0;
  constexpr int kWorlds = 20;
  std::vector<Rigid3d> straight_ahead;
  for (int i = 0; i < 8; ++i) {
    straight_ahead.push_back(LookingAt({6.0 - 0.3 * i, 0.2, 1.2}, {-2.0, 0.2, 0.2}));
  }
  for (int i = 0; i < kWorlds; ++i) {
    World world(kCuboidExponent, straight_ahead);
    world.sequence = WithBoxNoise(world.sequence, 1.0);
    UprightOptions options;
    options.axes_weight = 0.0;
    const auto iou = [&](const LandmarkEstimates& estimates) {
      const auto& landmark = estimates.objects.at(0).landmark_in_world;
      return landmark ? BoxIou(*landmark, world.truth) / kWorlds : 0.0;
    };
    multi_view += iou(InitialiseMultiView(world.sequence, {world.Prior(0.1)}, options, 1));
    svd += iou(InitialiseSvd(world.sequence));
  }
  EXPECT_GT(multi_view, 0.7);
  EXPECT_LT(svd, 0.3);
}

TEST(InitialiseMultiView, SaysWhichObjectsAreNotDetermined) {
  World world(kCuboidExponent, {LookingAt({3.0, 1.0, 1.5}, {0, 0, 0.4})});
  const LandmarkEstimates estimates =
      InitialiseMultiView(world.sequence, {std::nullopt}, UprightOptions(), 1);
  ASSERT_EQ(estimates.objects.size(), 1u);
  EXPECT_FALSE(estimates.objects[0].landmark_in_world);
  EXPECT_EQ(estimates.objects[0].failure, "not_determined_by_its_views");
}

}  // namespace
}  // namespace soslam
