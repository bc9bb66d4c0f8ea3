// SPDX-License-Identifier: BSD-3-Clause
// The back end for bodies of any shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "soslam/evaluation/metrics.h"
#include "soslam/evaluation/result_checks.h"
#include "soslam/geometry/angles.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/mapping/initial_landmarks.h"
#include "support/cuboid_map.h"
#include "support/one_body.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

void ExpectTruth(const Sequence& sequence, const MapEstimate& map, double min_iou) {
  for (const ObjectMetrics& object : EvaluateMap(sequence, map).objects) {
    EXPECT_GT(object.iou, min_iou);
  }
}

double MeanIou(const Sequence& sequence, const MapEstimate& map) {
  return EvaluateMap(sequence, map).summary.iou_mean.value();
}

TEST(TangencyBackEnd, EstimatedPlanesSettleUnderTheirObjects) {
  Scene scene = WithShelf(RandomScene(2, 6, 30, {Shape::kBox}), 0.4);
  const Sequence given = SyntheticSequence(scene, /*noise=*/false);
  const Sequence sequence = OnPlanesToEstimate(given);
  BackEndInput input = TruthInput(sequence);
  input.initial_landmarks = ChooseInitialUprightLandmarks(input, {}, TangencyOptions(), 1);
  const MapEstimate map = OptimiseMap(input, TangencyOptions());
  ASSERT_EQ(map.planes_in_world.size(), 2u);
  for (size_t i = 0; i < 2; ++i) {
    const Plane& truth = given.planes[i].plane_in_world;
    EXPECT_LT((map.planes_in_world[i].normal - truth.normal).norm(), 1e-3);
    EXPECT_NEAR(map.planes_in_world[i].offset, truth.offset, 2e-3);
  }
  EXPECT_EQ(map.planes_in_world[0].normal, map.planes_in_world[1].normal);
}

TEST(TangencyBackEnd, PlanesThatAreGivenOrNotToBeRefinedStayAsTheyAre) {
  Sequence sequence = OnPlanesToEstimate(CuboidSequence(3, 12));
  OptimiseOptions options = TangencyOptions();
  options.refine_planes = false;
  const Plane before = sequence.planes[0].plane_in_world;
  EXPECT_EQ(OptimiseMap(TruthInput(sequence), options).planes_in_world[0].offset, before.offset);
  options.refine_planes = true;
  EXPECT_NE(OptimiseMap(TruthInput(sequence), options).planes_in_world[0].offset, before.offset);
  sequence.planes[0].attitude_information.reset();
  EXPECT_EQ(OptimiseMap(TruthInput(sequence), options).planes_in_world[0].normal, before.normal);
}

// With constant poses, boxes, ratios and planes have the same cost in both.
TEST(TangencyBackEnd, StaysWhereTheFitOfAllViewsEnded) {
  const Sequence sequence = WithBoxNoise(CuboidSequence(4, 12), 3.0);
  BackEndInput input = TruthInput(sequence, 0.1);
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.hold_poses = true;
  const LandmarkEstimates fitted = InitialiseMultiView(sequence, input.priors, options.upright, 1);
  for (size_t i = 0; i < fitted.objects.size(); ++i) {
    input.initial_landmarks[i] = fitted.objects[i].landmark_in_world;
  }
  const MapEstimate map = OptimiseMap(input, options);
  EXPECT_NEAR(map.solver.final_cost, map.solver.initial_cost, 0.02 * map.solver.initial_cost);
  for (size_t i = 0; i < fitted.objects.size(); ++i) {
    const Landmark& before = *input.initial_landmarks[i];
    const Landmark& after = *map.objects[i].landmark_in_world;
    const double size_m = MeanHalfAxis(before);
    EXPECT_LT((after.Centre() - before.Centre()).norm(), 0.02 * size_m) << i;
    EXPECT_LT((after.half_axes - before.half_axes).norm(), 0.02 * size_m) << i;
  }
}

TEST(TangencyBackEnd, HeldPosesStayAsTheyAre) {
  const Sequence sequence = CuboidSequence(4, 12);
  BackEndInput input = TruthInput(sequence);
  Disturb(&input);
  OptimiseOptions options = TangencyOptions();
  options.hold_poses = true;
  const MapEstimate map = OptimiseMap(input, options);
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    const Rigid3d& given = sequence.frames[i].world_from_camera;
    EXPECT_EQ(map.world_from_camera[i].translation, given.translation);
    EXPECT_LT(map.world_from_camera[i].rotation.angularDistance(given.rotation), 1e-12);
  }
  EXPECT_EQ(map.solver.residuals.count("odometry"), 0u);
  ExpectTruth(sequence, map, 0.99);
}

// Boxes say nothing of the yaw of a round body; what they say of the others stays.
TEST(TangencyBackEnd, ARoundCylinderLeavesTheOthersTheirCovariances) {
  Sequence sequence = CuboidSequence(4, 20);
  Landmark& round = sequence.objects[0].ground_truth->landmark_in_world;
  round.half_axes.y() = round.half_axes.x();
  round.shape_exponents = {kEllipsoidExponent, kCuboidExponent};
  for (Detection& detection : sequence.detections) {
    if (detection.object_index != 0) continue;
    detection.box =
        OutlineBox(sequence.CameraOf(detection), *TrueLandmarkInCamera(sequence, detection))
            .value();
  }
  OptimiseOptions options = TangencyOptions();
  options.covariances = true;
  const MapEstimate map = OptimiseMap(TruthInput(sequence), options);
  ExpectTruth(sequence, map, 0.98);
  for (const ObjectEstimate& object : map.objects) EXPECT_TRUE(object.covariance);
}

// Errors that are larger than the assumed noise of boxes give the covariance of their real size.
TEST(TangencyBackEnd, CovariancesGrowWithWhatBoxesCostBeyondTheirNoise) {
  Landmark body;
  body.shape_exponents = kCuboidExponent;
  body.half_axes = {0.3, 0.5, 0.4};
  body.frame_from_object.translation.z() = 0.4;
  const Sequence sequence = WithBoxNoise(ViewsOfBody(body, CamerasOnArc(100, 6.0)), 15.0);
  OptimiseOptions options = TangencyOptions();
  options.covariances = true;
  options.hold_poses = true;
  options.upright.huber_delta = 1e6;
  options.detector_bias_sigma_px = 0.0;
  const BackEndInput input = TruthInput(sequence, /*ratio_log_sigma=*/10.0);
  options.upright.detection_sigma_fraction = 0.02;
  const MapEstimate map = OptimiseMap(input, options);
  options.upright.detection_sigma_fraction = 0.04;
  const MapEstimate of_twice_the_noise = OptimiseMap(input, options);
  EXPECT_GT(of_twice_the_noise.solver.Dispersion(), 1.5);
  EXPECT_NEAR(map.solver.Dispersion(), 4.0 * of_twice_the_noise.solver.Dispersion(),
              0.4 * of_twice_the_noise.solver.Dispersion());
  const double trace = map.objects[0].covariance.value().trace();
  EXPECT_NEAR(of_twice_the_noise.objects[0].covariance.value().trace(), trace, 0.1 * trace);
}

TEST(TangencyBackEnd, CostsNearlyNothingAtTheTruth) {
  const Sequence sequence = CuboidSequence(5, 20);
  const MapEstimate map = OptimiseMap(TruthInput(sequence), TangencyOptions());
  // The support function rounds edges by a thousandth of the body's size, kEdgeRounding: by a tenth
  // of a sigma (1 px or more) of a box edge at most.
  const auto edges = 4.0 * static_cast<double>(sequence.detections.size());
  EXPECT_LT(map.solver.initial_cost, 0.5 * 0.1 * 0.1 * edges);
  EXPECT_GT(map.solver.initial_cost, 0.0);
  EXPECT_EQ(map.solver.residuals.at("detection"), static_cast<int>(sequence.detections.size()));
  EXPECT_EQ(map.solver.residuals.at("ratio"), 5);
  EXPECT_EQ(map.solver.residuals.count("edges"), 0u);
  EXPECT_TRUE(map.solver.gated.empty());
  EXPECT_EQ(map.solver.detector_bias_px, (std::array<double, 4>{}));
  for (const ObjectEstimate& object : map.objects) {
    EXPECT_EQ(object.landmark_in_world->shape_exponents, kCuboidExponent);
  }
}

// Each segment has a world of its own, which its first pose defines.
TEST(TangencyBackEnd, SegmentsHaveNoOdometryBetweenThemAndKeepTheirFirstPoses) {
  Sequence sequence = WithBoxNoise(CuboidSequence(3, 12), 3.0);
  for (size_t i = 6; i < sequence.frames.size(); ++i) sequence.frames[i].segment = 1;
  const MapEstimate map = OptimiseMap(TruthInput(sequence), TangencyOptions());
  EXPECT_EQ(map.solver.residuals.at("odometry"), 10);
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    const Eigen::Vector3d& given = sequence.frames[i].world_from_camera.translation;
    EXPECT_EQ(map.world_from_camera[i].translation == given, i == 0 || i == 6) << i;
  }
}

TEST(TangencyBackEnd, WhatMovesIsNoLandmark) {
  Sequence sequence = CuboidSequence(3, 10);
  sequence.objects[1].is_static = false;
  BackEndInput input = TruthInput(sequence);
  input.initial_landmarks = ChooseInitialUprightLandmarks(input, {}, TangencyOptions(), 1);
  EXPECT_TRUE(input.initial_landmarks[0]);
  EXPECT_FALSE(input.initial_landmarks[1]);
  const MapEstimate map = OptimiseMap(input, TangencyOptions());
  EXPECT_EQ(map.objects[1].failure, "moving");
  EXPECT_EQ(map.solver.gated.at("detection_of_moving_object"),
            static_cast<int>(DetectionsByObject(sequence)[1].size()));
  EXPECT_EQ(map.solver.residuals.at("support"), 2);
}

// A bias of all boxes looks like larger or nearer objects: ratios and poses have to be known.
TEST(TangencyBackEnd, FindsTheBiasOfTheDetector) {
  Sequence sequence = CuboidSequence(5, 20);
  for (Detection& detection : sequence.detections) detection.box.y_min -= 8.0;
  OptimiseOptions options = TangencyOptions();
  options.odometry_rotation_sigma_deg = 1e-3;
  options.odometry_translation_sigma_m = 1e-4;
  const BackEndInput input = TruthInput(sequence, 0.005);

  options.detector_bias_sigma_px = 10.0;
  const MapEstimate with = OptimiseMap(input, options);
  const std::array<double, 4>& bias = with.solver.detector_bias_px;
  // What the boxes' edges have to move outwards: the upper ones back down.
  for (size_t i = 0; i < 4; ++i) EXPECT_NEAR(bias[i], i == 1 ? -8.0 : 0.0, 1.0) << i;

  options.detector_bias_sigma_px = 0.0;
  const MapEstimate without = OptimiseMap(input, options);
  EXPECT_EQ(without.solver.detector_bias_px, (std::array<double, 4>{}));
  EXPECT_GT(without.solver.final_cost, 2.0 * with.solver.final_cost);
  EXPECT_GT(MeanIou(sequence, with), MeanIou(sequence, without));
}

// A ratio far from its prior costs what its spread says: no loss makes outliers cheap.
TEST(TangencyBackEnd, RatiosAreWithoutLoss) {
  const Sequence sequence = CuboidSequence(3, 10);
  BackEndInput input = TruthInput(sequence);
  const double at_truth = OptimiseMap(input, TangencyOptions()).solver.initial_cost;
  input.priors[0]->ratio *= 2.0;
  input.priors[0]->log_sigma = {0.1, 0.2};
  const double doubled = OptimiseMap(input, TangencyOptions()).solver.initial_cost;
  EXPECT_NEAR(doubled - at_truth, 0.5 * std::pow(std::log(2.0), 2) * (1e2 + 25.0), 1e-6);

  input.priors[0].reset();
  const MapEstimate map = OptimiseMap(input, TangencyOptions());
  EXPECT_EQ(map.solver.residuals.at("ratio"), 2);
  EXPECT_EQ(map.solver.gated.at("object_without_ratio"), 1);
}

// An object may reach beyond a bound of its box, but not stay short of it.
TEST(TangencyBackEnd, BoundsCostNothingWhereTheObjectReachesFarther) {
  const Sequence whole = CuboidSequence(4, 20);
  Sequence cut = whole;
  for (Detection& detection : cut.detections) detection.box.x_max -= 0.3 * detection.box.Width();
  const auto initial_cost = [&](const Sequence& sequence) {
    return OptimiseMap(TruthInput(sequence), TangencyOptions()).solver.initial_cost;
  };
  const double of_whole = initial_cost(whole);
  EXPECT_GT(initial_cost(cut), 100.0 * of_whole);
  for (Detection& detection : cut.detections) detection.is_one_sided[2] = true;
  EXPECT_LT(initial_cost(cut), of_whole * 1.5);

  BackEndInput input = TruthInput(cut);
  Disturb(&input);
  ExpectTruth(cut, OptimiseMap(input, TangencyOptions()), 0.97);

  for (Detection& detection : cut.detections) detection.box.x_max += 60.0;
  EXPECT_GT(initial_cost(cut), 100.0 * of_whole);
}

TEST(TangencyBackEnd, EdgesImproveWhatBoxesSay) {
  const Sequence sequence = CuboidSequence(3, 8);
  const Sequence noisy = WithBoxNoise(sequence, 4.0);
  BackEndInput input = TruthInput(noisy, 0.2);
  const MapEstimate boxes = OptimiseMap(input, TangencyOptions());
  input.images = DrawnEdges(sequence);
  const MapEstimate edges = OptimiseMap(input, TangencyOptions());
  EXPECT_EQ(edges.solver.residuals.at("edges"), static_cast<int>(sequence.detections.size()));
  const double with = MeanIou(sequence, edges);
  EXPECT_GT(with, MeanIou(sequence, boxes));
  EXPECT_GT(with, 0.9);
}

TEST(TangencyBackEnd, AllSolvesTogetherKeepToTheLimitOfIterations) {
  const Sequence sequence = CuboidSequence(3, 8);
  const Sequence noisy = WithBoxNoise(sequence, 4.0);
  BackEndInput input = TruthInput(noisy, 0.2);
  input.images = DrawnEdges(sequence);
  OptimiseOptions options = TangencyOptions();
  options.max_iterations = 3;
  const SolverSummary solver = OptimiseMap(input, options).solver;
  EXPECT_EQ(solver.iterations, 3);
  EXPECT_FALSE(solver.converged);
}

// The weight of a view is one over the sum of exp(-(angle / correlation)^2 / 2) over all views of
// the object, by the angle between the lines from the cameras to its centre, wherever the world's
// origin is.
TEST(TangencyBackEnd, ViewsFromAboutOneSideShareTheirWeight) {
  constexpr double kCorrelationDeg = 20.0;
  const Sequence sequence = TransformSequence(RandomRigid(), CuboidSequence(2, 6));
  const auto line_of_sight = [&](const Detection& detection) {
    const Eigen::Vector3d line =
        sequence.ObjectOf(detection).ground_truth->landmark_in_world.Centre() -
        sequence.FrameOf(detection).world_from_camera.translation;
    return line.normalized();
  };
  double sum_of_weights = 0.0;
  for (const Detection& one : sequence.detections) {
    double similar = 0.0;
    for (const Detection& other : sequence.detections) {
      if (other.object_index != one.object_index) continue;
      const double cosine = std::min(1.0, line_of_sight(one).dot(line_of_sight(other)));
      similar += std::exp(-0.5 * std::pow(kDegPerRad * std::acos(cosine) / kCorrelationDeg, 2));
    }
    sum_of_weights += 1.0 / similar;
  }
  OptimiseOptions options = TangencyOptions();
  options.upright.view_correlation_deg = kCorrelationDeg;
  const SolverSummary solver = OptimiseMap(TruthInput(sequence), options).solver;
  EXPECT_LT(sum_of_weights, 0.9 * static_cast<double>(sequence.detections.size()));
  EXPECT_NEAR(solver.expected_box_cost, 0.5 * 4.0 * sum_of_weights, 1e-6);
}

// Views from about one side share the errors of the body's shape: together they cost as one.
TEST(TangencyBackEnd, BoxesOfExchangedObjectsCostFarMoreThanTheirNoise) {
  const Sequence right = WithBoxNoise(CuboidSequence(4, 20), 2.0);
  Sequence exchanged = right;
  for (Detection& detection : exchanged.detections) {
    if (detection.frame_index % 2 == 1 && detection.object_index < 2) {
      detection.object_index = 1 - detection.object_index;
    }
  }
  OptimiseOptions options = TangencyOptions();
  options.upright.view_correlation_deg = 20.0;
  const SolverSummary solver = OptimiseMap(TruthInput(right), options).solver;
  EXPECT_GT(solver.box_cost, 0.0);
  EXPECT_LT(solver.box_cost, solver.final_cost);
  EXPECT_LT(solver.expected_box_cost, 2.0 * static_cast<double>(right.detections.size()));
  EXPECT_TRUE(CheckCost(solver).empty());
  EXPECT_FALSE(CheckCost(OptimiseMap(TruthInput(exchanged), options).solver).empty());
}

// Which edge points count is decided anew until nothing moves: from there, nothing does.
TEST(TangencyBackEnd, SettlesWithEdges) {
  const Sequence sequence = CuboidSequence(4, 10);
  Sequence noisy = sequence;
  for (Detection& detection : noisy.detections) detection.box.y_min += RandomUniform(0.0, 6.0);
  BackEndInput input = TruthInput(noisy, 0.2);
  input.images = DrawnEdges(sequence);
  Disturb(&input);
  const MapEstimate first = OptimiseMap(input, TangencyOptions());
  EXPECT_TRUE(first.solver.converged);
  for (size_t i = 0; i < input.initial_landmarks.size(); ++i) {
    input.initial_landmarks[i] = first.objects[i].landmark_in_world;
  }
  for (size_t i = 0; i < noisy.frames.size(); ++i) {
    noisy.frames[i].world_from_camera = first.world_from_camera[i];
  }
  OptimiseOptions once_more = TangencyOptions();
  once_more.odometry_rotation_sigma_deg = 1e-6;  // the poses stay
  once_more.odometry_translation_sigma_m = 1e-9;
  const MapEstimate second = OptimiseMap(input, once_more);
  for (size_t i = 0; i < input.initial_landmarks.size(); ++i) {
    const Landmark& before = *first.objects[i].landmark_in_world;
    const Landmark& after = *second.objects[i].landmark_in_world;
    EXPECT_LT((after.Centre() - before.Centre()).norm(), 0.01 * before.half_axes.norm());
    EXPECT_LT((after.half_axes - before.half_axes).norm(), 0.01 * before.half_axes.norm());
  }
}

// The distance map has kinks, where the solver's way depends on the last digits.
TEST(TangencyBackEnd, MovesWithTheWorld) {
  const Sequence exact = CuboidSequence(3, 8);
  const Sequence sequence = WithBoxNoise(exact, 3.0);
  BackEndInput input = TruthInput(sequence);
  input.images = DrawnEdges(exact);
  OptimiseOptions options = TangencyOptions();
  options.detector_bias_sigma_px = 2.0;
  ExpectThatTheMapMovesWithTheWorld(input, options, 0.02, 0.97);
}

}  // namespace
}  // namespace soslam
