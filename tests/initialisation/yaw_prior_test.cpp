// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/yaw_prior.h"

#include <gtest/gtest.h>

#include "soslam/geometry/angles.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/initialisation/object_evidence.h"

namespace soslam {
namespace {

constexpr int kFrames = 11;

// Where a car is in frame `i`: its centre above the ground, x to the right and z ahead of the first
// camera, and its yaw about the upward normal in the world.
struct Place {
  double x;
  double z;
  double yaw;
};

const ShapePrior kCar{{2.5, 1.1}, {0.05, 0.05}, kCuboidExponent};

// A car seen by a camera 1.6 m above the ground that drives ahead by `step` m a frame, 10 frames a
// second.
template <typename PlaceOf>
Sequence Drive(double step, const PlaceOf& place_of) {
  Sequence sequence;
  sequence.camera = {1242, 375, 720.0, 720.0, 610.0, 173.0};
  const Plane ground{-Eigen::Vector3d::UnitY(), 1.6};
  sequence.planes.push_back({0, ground});
  Object car{0, "car", 0, {}};
  for (int i = 0; i < kFrames; ++i) {
    Frame frame;
    frame.id = i;
    frame.timestamp = 0.1 * i;
    frame.world_from_camera.translation = {0.0, 0.0, step * i};
    sequence.frames.push_back(frame);
    const Place place = place_of(i);
    Landmark landmark;
    landmark.half_axes = {1.875, 0.825, 0.75};
    landmark.shape_exponents = kCuboidExponent;
    landmark.frame_from_object = {UprightRotation(ground.normal, place.yaw),
                                  {place.x, 1.6 - landmark.half_axes.z(), place.z}};
    const Landmark in_camera = Transform(frame.world_from_camera.Inverse(), landmark);
    Detection detection{i, 0, 1.0, *OutlineBox(sequence.camera, in_camera), ground, {}};
    detection.true_landmark_in_camera = in_camera;
    sequence.detections.push_back(detection);
    if (i == 0) car.ground_truth.emplace().landmark_in_world = landmark;
  }
  sequence.objects.push_back(car);
  return sequence;
}

double TrueYaw(const Detection& detection) {
  return Yaw(detection.plane_in_camera.normal,
             detection.true_landmark_in_camera->frame_from_object.rotation);
}

std::vector<std::optional<YawPrior>> Priors(const Sequence& sequence, YawPriorSource source) {
  return YawPriors(sequence, {kCar}, {.source = source}, {.view_correlation_deg = 0.0}, 2);
}

// Degrees, of the middle frame.
double YawErrorOfPrior(const Sequence& sequence, YawPriorSource source) {
  const auto prior = Priors(sequence, source)[kFrames / 2];
  return std::abs(YawDifferenceModuloPi(prior->yaw, TrueYaw(sequence.detections[kFrames / 2]))) /
         kRadPerDeg;
}

// The yaw of the direction (x, z) in the world.
double YawAlong(double x, double z) {
  return Yaw(-Eigen::Vector3d::UnitY(),
             RotationBetween(Eigen::Vector3d::UnitX(), Eigen::Vector3d(x, 0, z)));
}

TEST(YawPriors, TheTruthIsThatOfEachFrame) {
  const Sequence sequence = Drive(1.0, [](int i) { return Place{3.0, 18.0 + i, 0.3 + 0.05 * i}; });
  const auto priors = Priors(sequence, YawPriorSource::kGroundTruth);
  for (size_t i = 0; i < priors.size(); ++i) {
    EXPECT_NEAR(YawDifferenceModuloPi(priors[i]->yaw, TrueYaw(sequence.detections[i])), 0.0, 1e-9);
  }
  Sequence without = sequence;
  for (Detection& detection : without.detections) detection.true_landmark_in_camera.reset();
  without.objects[0].ground_truth.reset();
  EXPECT_FALSE(Priors(without, YawPriorSource::kGroundTruth)[0]);
}

// The middle of a box's lower edge is not a point of the car, but it goes where the car goes.
TEST(YawPriors, WhatDrivesPointsWhereItGoes) {
  for (const double angle : {60.0, 90.0, 120.0}) {
    const double x = std::cos(angle * kRadPerDeg);
    const double z = std::sin(angle * kRadPerDeg);
    const Sequence sequence = Drive(1.0, [&](int i) {
      return Place{-3.0 + 0.8 * x * i, 16.0 + 1.2 * z * i, YawAlong(0.8 * x, 1.2 * z)};
    });
    EXPECT_LT(YawErrorOfPrior(sequence, YawPriorSource::kMotion), 5.0) << angle;
  }
}

TEST(YawPriors, ALongWayIsSurerThanAShortOne) {
  const auto sigma = [](double speed) {
    const Sequence sequence = Drive(1.0, [&](int i) {
      return Place{-3.0, 16.0 + speed * i, YawAlong(0.0, 1.0)};
    });
    return Priors(sequence, YawPriorSource::kMotion)[kFrames / 2]->sigma;
  };
  EXPECT_NEAR(sigma(1.0), std::atan(0.3 / 10.0), 3e-3);
  EXPECT_GT(sigma(0.4), 2.0 * sigma(1.0));
}

TEST(YawPriors, WhatStandsIsSeenFromSeveralSides) {
  for (const double yaw : {-1.2, -0.4, 0.2, 0.9}) {
    const Sequence sequence = Drive(1.0, [&](int) { return Place{3.5, 22.0, yaw}; });
    EXPECT_LT(YawErrorOfPrior(sequence, YawPriorSource::kMotion), 2.0) << yaw;
  }
}

TEST(YawPriors, OneBoxSaysNothing) {
  Sequence sequence = Drive(1.0, [](int) { return Place{3.5, 22.0, 0.4}; });
  sequence.detections.resize(1);
  EXPECT_FALSE(Priors(sequence, YawPriorSource::kMotion)[0]);
}

// The prior decides between yaws that explain a box equally well.
TEST(InitialiseUpright, HeedsTheYawPrior) {
  const Sequence sequence = Drive(1.0, [](int) { return Place{3.5, 22.0, 0.9}; });
  UprightOptions options;
  options.axes_weight = 0.0;
  const auto estimates = InitialiseUpright(sequence, {kCar}, options, 2,
                                           Priors(sequence, YawPriorSource::kGroundTruth));
  for (const ObservationEstimate& observation : estimates.observations) {
    const auto index = static_cast<size_t>(observation.detection_index);
    const Landmark& landmark = observation.hypotheses.at(0).landmark_in_camera;
    EXPECT_NEAR(
        YawDifferenceModuloPi(Yaw(-Eigen::Vector3d::UnitY(), landmark.frame_from_object.rotation),
                              TrueYaw(sequence.detections[index])),
        0.0, 0.5 * kRadPerDeg);
  }
}

}  // namespace
}  // namespace soslam
