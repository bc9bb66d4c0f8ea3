// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/result_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "soslam/geometry/angles.h"
#include "support/lists.h"

namespace soslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

// One landmark with each of these half axes.
LandmarkEstimates Landmarks(const std::vector<Eigen::Vector3d>& half_axes) {
  LandmarkEstimates estimates;
  for (const Eigen::Vector3d& axes : half_axes) {
    ObjectEstimate& estimate = estimates.objects.emplace_back();
    estimate.object_index = static_cast<int>(estimates.objects.size()) - 1;
    estimate.landmark_in_world = Landmark{{}, axes};
  }
  return estimates;
}

// Objects of label "crate", which are 0.5 m high give or take a fifth.
class ResultChecksTest : public testing::Test {
 protected:
  ResultChecksTest() {
    ShapePrior crate;
    crate.height_m = LogNormal{0.5, 0.2};
    table.priors["crate"] = crate;
  }

  // One object of each height.
  std::string SizeFindings(const std::vector<double>& heights) {
    std::vector<Eigen::Vector3d> half_axes;
    Sequence sequence;
    for (size_t i = 0; i < heights.size(); ++i) {
      sequence.objects.push_back({static_cast<int>(i) + 10, "crate", 0, {}});
      half_axes.emplace_back(0.2, 0.2, 0.5 * heights[i]);
    }
    std::string words;
    for (const Finding& finding : CheckSizes(Landmarks(half_axes), sequence, table)) {
      words += finding.check + ": " + InWords(finding);
    }
    return words;
  }

  SemanticTable table;
};

// Labels are those of detections.
TEST_F(ResultChecksTest, AThirdOfTheLabelsWithoutEntry) {
  table.priors["coffeetable"] = {};
  Sequence sequence;
  const auto add = [&](const std::string& label) {
    sequence.objects.push_back({static_cast<int>(sequence.objects.size()), label, 0, {}});
    sequence.detections.push_back(
        {0, static_cast<int>(sequence.objects.size()) - 1, 1.0, {}, {}, {}});
  };
  for (const char* label : {"crate", "Crate", "coffee table", "CRATE"}) add(label);
  EXPECT_THAT(CheckLabels(sequence, table, "table.json"), IsEmpty());
  add("Cofee Tabel");
  EXPECT_THAT(CheckLabels(sequence, table, "table.json"), IsEmpty());
  add("whisk");
  const Finding finding = Only(CheckLabels(sequence, table, "table.json"));
  EXPECT_THAT(finding.found, AllOf(HasSubstr("2 of 6 labels are not in table.json"),
                                   HasSubstr("whisk; their objects are left out")));
  table.default_prior = ShapePrior();
  sequence.objects.back().label = "crat";
  EXPECT_THAT(Only(CheckLabels(sequence, table, "table.json")).found,
              HasSubstr("crat (crate?); its default is used"));
}

// A box of another object in each of ten images; single images have no objects in common.
TEST(CheckObjectIdsTest, BoxesWithoutIds) {
  Sequence sequence;
  for (int i = 0; i < 10; ++i) {
    Frame frame;
    frame.id = i;
    sequence.frames.push_back(frame);
    Object object;
    object.id = i;
    sequence.objects.push_back(object);
    Detection detection;
    detection.frame_index = detection.object_index = i;
    sequence.detections.push_back(detection);
  }
  const auto findings = CheckObjectIds(sequence);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_THAT(findings[0].found, HasSubstr("none of 10 objects"));
  Sequence apart = sequence;
  for (Frame& frame : apart.frames) frame.segment = static_cast<int>(frame.id);
  EXPECT_THAT(CheckObjectIds(apart), IsEmpty());
  sequence.detections[7].object_index = 3;
  EXPECT_THAT(CheckObjectIds(sequence), IsEmpty());
}

TEST_F(ResultChecksTest, SizesWithinTheirLabelsSpread) {
  EXPECT_THAT(SizeFindings({0.4, 0.5, 0.6, 0.45, 0.7}), IsEmpty());
}

TEST_F(ResultChecksTest, AllObjectsOffByOneFactor) {
  EXPECT_THAT(SizeFindings({0.14, 0.15, 0.16, 0.15}),
              AllOf(HasSubstr("scale: 4 objects are 0.3 times as high"), HasSubstr("about 3.3")));
  EXPECT_THAT(SizeFindings({14, 15, 16, 15}), HasSubstr("30 times as high"));
}

TEST_F(ResultChecksTest, OneObjectThatIsAMultiple) {
  EXPECT_THAT(SizeFindings({0.5, 0.5, 0.5, 2.0}),
              AllOf(HasSubstr("object_size: 1 of 4 objects"), HasSubstr("13 (crate) 4 times")));
}

TEST_F(ResultChecksTest, LabelsWithoutAHeightSayNothing) {
  table.priors["crate"].height_m.reset();
  EXPECT_THAT(SizeFindings({14, 15, 16, 15}), IsEmpty());
}

TEST(CheckFailuresTest, MoreThanAThirdWithoutALandmark) {
  LandmarkEstimates estimates;
  for (int i = 0; i < 3; ++i) estimates.observations.push_back({i, {{Landmark(), 0.0}}, ""});
  estimates.observations[0] = {0, {}, "no_solution"};
  EXPECT_THAT(CheckFailures(estimates), IsEmpty());
  estimates.observations[1] = {1, {}, "no_solution"};
  Finding finding = Only(CheckFailures(estimates));
  EXPECT_EQ(finding.found, "2 of 3 tries gave no landmark: 2 no_solution");
  EXPECT_THAT(finding.cause, HasSubstr("poses the other way round"));
  for (int i : {0, 1}) estimates.observations[i].failure = "fewer_than_three_measured_edges";
  finding = Only(CheckFailures(estimates));
  EXPECT_THAT(finding.cause, HasSubstr("cuts off"));
  EXPECT_THAT(finding.remedy, HasSubstr("farther away"));
}

TEST(CheckDegenerateTest, LandmarksThatViewsDoNotDetermine) {
  const Eigen::Vector3d low(0.2, 0.3, 0.1), flat(0.2, 0.3, 1e-9), high(0.2, 0.3, 1.0);
  EXPECT_THAT(Only(CheckDegenerate(Landmarks({low, flat, high}))).found,
              HasSubstr("1 of 3 landmarks are a hundred times"));
  EXPECT_THAT(CheckDegenerate(Landmarks({low, high})), IsEmpty());
}

TEST(CheckCollapsedTest, LandmarksThatShrankToAPoint) {
  const Eigen::Vector3d thin(2e-4, 3e-4, 0.1), point(2e-4, 3e-4, 1e-4), large(1.0, 1.0, 1.0);
  EXPECT_THAT(Only(CheckCollapsed(Landmarks({thin, point, large}))).found,
              HasSubstr("1 of 3 landmarks have three half axes below"));
  EXPECT_THAT(CheckCollapsed(Landmarks({thin, large})), IsEmpty());
}

TEST(CheckFailuresTest, MovingObjectsAreNoFailures) {
  LandmarkEstimates estimates = Landmarks({Eigen::Vector3d::Ones()});
  for (const int index : {1, 2}) estimates.objects.push_back({index, 0, {}, {}, kMovingObject});
  EXPECT_THAT(CheckFailures(estimates), IsEmpty());
}

TEST(CheckCostTest, FarAboveWhatNoiseGives) {
  SolverSummary solver;
  solver.expected_box_cost = 20.0;
  solver.box_cost = 199.0;
  EXPECT_THAT(CheckCost(solver), IsEmpty());
  solver.box_cost = 210.0;
  EXPECT_THAT(Only(CheckCost(solver)).found, HasSubstr("210, 10.5 times"));
}

// 40 effective residuals that cost 4 times what their noise gives, with one landmark on a plane.
class CheckInputsTest : public testing::Test {
 protected:
  CheckInputsTest() {
    sequence.camera.fx = 700.0;
    sequence.frames.resize(1);
    sequence.planes.push_back({.id = 3, .plane_in_world = {}});
    sequence.objects.push_back({});
    map.objects.emplace_back().landmark_in_world = Landmark{};
    map.solver.expected_box_cost = 20.0;
    map.input_alternatives = {{.cost = 80.0, .box_cost = 80.0}};
  }

  Sequence sequence;
  MapEstimate map;
};

TEST_F(CheckInputsTest, NothingWithoutAnotherExplanation) {
  EXPECT_THAT(CheckInputs(sequence, map), IsEmpty());
  EXPECT_THAT(CheckInputs(sequence, MapEstimate()), IsEmpty());
}

// log(0.7) is 18 times the least correction that matters.
TEST_F(CheckInputsTest, AFocalLengthFarBetterThanChanceGives) {
  map.input_alternatives.push_back(
      {.degrees = 1, .cost = 66.0, .box_cost = 66.0, .focal_factor = 0.7});
  EXPECT_THAT(CheckInputs(sequence, map), IsEmpty());
  map.input_alternatives.back() = {
      .degrees = 1, .cost = 30.0, .box_cost = 30.0, .focal_factor = 0.7};
  const Finding finding = Only(CheckInputs(sequence, map));
  EXPECT_EQ(finding.check, "focal_length");
  EXPECT_THAT(finding.found,
              AllOf(HasSubstr("0.700 times"), HasSubstr("fx = 490 in place of 700"),
                    HasSubstr("deviation 21 px"), HasSubstr("1.5 times"), HasSubstr("of 4 times")));
}

TEST_F(CheckInputsTest, CorrectionsThatAreTooSmallToMatter) {
  map.input_alternatives.push_back(
      {.degrees = 1, .cost = 20.0, .box_cost = 20.0, .focal_factor = 1.015});
  EXPECT_THAT(CheckInputs(sequence, map), IsEmpty());
}

TEST_F(CheckInputsTest, WhatStillFitsBadlyIsNoExplanation) {
  map.input_alternatives = {{.cost = 8000.0, .box_cost = 8000.0},
                            {.degrees = 1, .cost = 250.0, .box_cost = 250.0, .focal_factor = 0.7}};
  EXPECT_THAT(CheckInputs(sequence, map), IsEmpty());
}

TEST_F(CheckInputsTest, TheMostProbableAndWhatIsNearlyAsProbable) {
  const PlaneAlternative lower{.plane_in_world = {Eigen::Vector3d::UnitZ(), 0.3},
                               .height_change_m = -0.3};
  const double angle = 10.0 * kRadPerDeg;
  const PlaneAlternative turned{.plane_in_world = {{0.0, std::sin(angle), std::cos(angle)}, 0.3},
                                .tilt_rad = angle};
  map.input_alternatives.push_back(
      {.degrees = 1, .cost = 35.0, .box_cost = 35.0, .focal_factor = 0.7});
  map.input_alternatives.push_back(
      {.degrees = 1, .cost = 26.0, .box_cost = 26.0, .planes = {{0, lower}}});
  map.input_alternatives.push_back(
      {.degrees = 3, .cost = 25.5, .box_cost = 25.5, .planes = {{0, turned}}});
  // The dispersion is 25.5 / 20, and two further degrees cost log(40).
  const Finding finding = Only(CheckInputs(sequence, map));
  EXPECT_EQ(finding.check, "support_planes");
  EXPECT_THAT(finding.found, HasSubstr("with plane 3 0.300 m against its normal, d = 0.300:"));
  EXPECT_THAT(finding.found, Not(HasSubstr("; or")));
  // log(40) - 3.5 * 20 / 22.5 = 0.58, a probability of 1 / (1 + exp(0.58)) = 0.36.
  map.input_alternatives.back().cost = map.input_alternatives.back().box_cost = 22.5;
  EXPECT_THAT(Only(CheckInputs(sequence, map)).found,
              AllOf(HasSubstr("fit best with plane 3 0.300 m against its normal"),
                    HasSubstr("; or (probability 0.36) with plane 3 turned by 10.0 degrees")));
  map.input_alternatives.back().cost = map.input_alternatives.back().box_cost = 5.0;
  EXPECT_THAT(Only(CheckInputs(sequence, map)).found,
              HasSubstr("turned by 10.0 degrees, to the normal (0.000, 0.174, 0.985) and d = 0.3"));
}

// Three frames of one segment and one of another: two steps, 12 degrees of freedom, of which the
// 99 % quantile is 26.2 (tables).
TEST(CheckPoseCorrectionsTest, FarFromTheOdometryForItsNoise) {
  Sequence sequence;
  sequence.frames.resize(4);
  sequence.frames[3].segment = 1;
  std::vector<Rigid3d> poses(4);
  poses[3].translation.x() = 100.0;
  const OdometryNoise noise{.rotation_rad = 0.01, .translation_m = 0.1};
  EXPECT_THAT(CheckPoseCorrections(sequence, poses, noise), IsEmpty());
  poses[1].translation.x() = 0.36;  // there and back: 2 * 3.6^2 = 25.9
  EXPECT_THAT(CheckPoseCorrections(sequence, poses, noise), IsEmpty());
  poses[1].translation.x() = 0.37;  // 27.4
  const Finding finding = Only(CheckPoseCorrections(sequence, poses, noise));
  EXPECT_THAT(finding.found, AllOf(HasSubstr("2 pairs"), HasSubstr("27.38")));
  EXPECT_THAT(finding.expected, HasSubstr("at most 26.2"));
}

TEST(CheckPlaneCountTest, NearlyAPlaneForEachObject) {
  EXPECT_THAT(CheckPlaneCount(2, 2), IsEmpty());
  EXPECT_THAT(CheckPlaneCount(4, 24), IsEmpty());
  EXPECT_THAT(CheckPlaneCount(3, 4), IsEmpty());
  EXPECT_THAT(CheckPlaneCount(3, 5), IsEmpty());
  EXPECT_EQ(Only(CheckPlaneCount(4, 5)).found, "4 planes of 5 objects");
}

TEST(CheckUpTest, OtherWaysToHoldTheCameraThatAreAboutAsProbable) {
  TriedOrientation level, rolled;
  level.probability = 0.25;
  rolled.orientation = CameraOrientation::kRolled90;
  rolled.probability = 0.75;
  EXPECT_THAT(CheckUp(CameraOrientation::kRolled90, {level, rolled}, 0.0), IsEmpty());
  EXPECT_EQ(Only(CheckUp(CameraOrientation::kRolled90, {level, rolled}, 0.5)).found,
            "cameras are taken to be held rolled_90; probabilities: level 0.25, rolled_90 0.75");
}

TEST(WorstFirstTest, ErrorsComeFirstAndNothingComesTwice) {
  const Finding warning{"a", Severity::kWarning, "found", "expected", "cause", "remedy"};
  Finding error = warning;
  error.severity = Severity::kError;
  EXPECT_EQ(WorstFirst({warning, error, warning}), (std::vector<Finding>{error, warning}));
}

}  // namespace
}  // namespace soslam
