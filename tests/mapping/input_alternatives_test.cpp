// SPDX-License-Identifier: BSD-3-Clause
// What the boxes say of a focal length and of planes that are given wrongly.
#include "soslam/mapping/input_alternatives.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "soslam/evaluation/result_checks.h"
#include "soslam/geometry/angles.h"
#include "support/cuboid_map.h"
#include "support/looking_at.h"
#include "support/one_body.h"

namespace soslam {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

// Cuboids on a floor and a shelf, boxes with the noise of an ordinary detector.
Sequence NoisySequence(int seed, int objects = 6) {
  Scene scene = WithShelf(RandomScene(seed, objects, 20, {Shape::kBox}), 0.4);
  scene.noise.box_edge_sigma = 0.02;
  scene.noise.odometry_translation_sigma = 0.002;
  scene.noise.odometry_rotation_sigma_deg = 0.05;
  Sequence sequence = SyntheticSequence(scene, /*noise=*/true);
  for (Object& object : sequence.objects) {
    object.ground_truth->landmark_in_world.shape_exponents = kCuboidExponent;
    object.label = fmt::format("thing {}", object.id);
  }
  return sequence;
}

void TurnPlane(double angle_deg, Plane* plane) {
  plane->normal = ExpRotation(Eigen::Vector3d(angle_deg * kRadPerDeg, 0.0, 0.0)) * plane->normal;
}

std::vector<Finding> FindingsOf(const Sequence& sequence) {
  return CheckInputs(sequence, OptimiseMap(TruthInput(sequence), TangencyOptions()));
}

TEST(InputAlternativesTest, RightInputsNeedNoOther) {
  for (int seed = 1; seed <= 4; ++seed) EXPECT_THAT(FindingsOf(NoisySequence(seed)), IsEmpty());
}

// Thirty equal cuboids of a label on a floor, which a camera passes sideways, looking level.
Sequence EqualThings() {
  std::vector<Rigid3d> cameras;
  for (int i = 0; i < 20; ++i) {
    const double x = -0.8 + 0.09 * i;
    cameras.push_back(LookingAt({x, 0.0, 1.0}, {x, 4.0, 1.0}));
  }
  Sequence sequence;
  for (int i = 0; i < 30; ++i) {
    Landmark body;
    body.shape_exponents = kCuboidExponent;
    body.half_axes = {0.35, 0.335, 0.44};
    body.frame_from_object.translation = {RandomUniform(-1.5, 1.5), RandomUniform(2.5, 5.0), 0.44};
    const Sequence views = ViewsOfBody(body, cameras);
    if (i == 0) {
      sequence = views;
    } else {
      sequence.objects.push_back(views.objects.front());
      sequence.objects.back().id = i;
      for (Detection detection : views.detections) {
        detection.object_index = i;
        sequence.detections.push_back(detection);
      }
    }
    sequence.objects.back().label = "chair";
  }
  return WithBoxNoise(sequence, 2.0);
}

TEST(InputAlternativesTest, EqualThingsMayAllDifferFromTheTable) {
  constexpr double kLogSigma = 0.2;
  OptimiseOptions options = TangencyOptions();
  options.upright.view_correlation_deg = OptimiseOptions().upright.view_correlation_deg;
  for (int i = 0; i < 2; ++i) {
    const Sequence sequence = EqualThings();
    BackEndInput input = TruthInput(sequence, kLogSigma);
    for (auto& prior : input.priors) prior->ratio *= std::exp(-2.0 * kLogSigma);
    EXPECT_THAT(CheckInputs(sequence, OptimiseMap(input, options)), IsEmpty());
  }
}

TEST(InputAlternativesTest, AFocalLengthThatIsTooLongOrTooShort) {
  for (const double factor : {0.8, 1.3}) {
    Sequence sequence = NoisySequence(1);
    sequence.camera.fx *= factor;
    sequence.camera.fy *= factor;
    const MapEstimate map = OptimiseMap(TruthInput(sequence), TangencyOptions());
    ASSERT_GE(map.input_alternatives.size(), 2u);
    EXPECT_NEAR(map.input_alternatives[1].focal_factor, 1.0 / factor, 0.02);
    const auto findings = CheckInputs(sequence, map);
    ASSERT_EQ(findings.size(), 1u) << factor;
    EXPECT_EQ(findings[0].check, "focal_length");
  }
}

TEST(InputAlternativesTest, PlanesThatAreAllTooHigh) {
  Sequence sequence = NoisySequence(2);
  for (SupportPlane& plane : sequence.planes) plane.plane_in_world.offset -= 0.2;
  const MapEstimate map = OptimiseMap(TruthInput(sequence), TangencyOptions());
  const auto findings = CheckInputs(sequence, map);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_EQ(findings[0].check, "support_planes");
  EXPECT_THAT(findings[0].found, HasSubstr("plane 0 0.2"));
  EXPECT_THAT(findings[0].found, HasSubstr("plane 1 0."));
  EXPECT_THAT(findings[0].found, HasSubstr("m against its normal"));
}

TEST(InputAlternativesTest, OnePlaneOfTwoThatIsTooLow) {
  Sequence sequence = NoisySequence(3);
  sequence.planes[1].plane_in_world.offset += 0.2;
  const auto findings = FindingsOf(sequence);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_THAT(findings[0].found, HasSubstr("fit best with plane 1 0."));
  EXPECT_THAT(findings[0].found, HasSubstr("m along its normal, d = "));
}

TEST(InputAlternativesTest, PlanesThatAreTurned) {
  Sequence sequence = NoisySequence(4);
  for (SupportPlane& plane : sequence.planes) TurnPlane(8.0, &plane.plane_in_world);
  const auto findings = FindingsOf(sequence);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_THAT(findings[0].found, HasSubstr("turned by"));
}

TEST(InputAlternativesTest, PlanesThatAreEstimatedNeedNone) {
  const Sequence sequence = OnPlanesToEstimate(NoisySequence(5));
  for (const InputAlternative& found :
       OptimiseMap(TruthInput(sequence), TangencyOptions()).input_alternatives) {
    EXPECT_THAT(found.planes, IsEmpty());
  }
}

}  // namespace
}  // namespace soslam
