// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/start_in_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <vector>

#include "constraints/parameters.h"
#include "geometry/angles.h"
#include "mapping/back_end_problem.h"
#include "support/cuboid_map.h"
#include "support/curve_term.h"
#include "support/drive.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr int kFrames = 300;
constexpr size_t kFramesPerPart = 50;
constexpr double kTurnSigma = 0.08;  // rad a frame: level is lost at once

class StartInPartsTest : public testing::Test {
 protected:
  StartInPartsTest() { options_.odometry_rotation_sigma_deg = kTurnSigma * kDegPerRad; }
  void MakeProblem() { problem_.emplace(input_, options_); }
  BackEndVariables& Variables() { return problem_->variables(); }
  bool Start(size_t max_frames_per_part = kFramesPerPart) {
    return StartInParts(drive_.sequence, problem_->AllTerms(), max_frames_per_part, &Variables());
  }
  double Cost() const {
    double cost = 0.0;
    for (const Term* term : problem_->AllTerms()) cost += term->Cost();
    return cost;
  }
  bool IsMoved(size_t frame) {
    const Eigen::Matrix4d before = drive_.sequence.frames[frame].world_from_camera.Matrix();
    return !Variables().PoseValue(frame).Matrix().isApprox(before, 1e-9);
  }
  void StartAtTheTruth() {
    const auto set = [&](int index, const auto& values) {
      std::ranges::copy(values, Variables().all()[static_cast<size_t>(index)].values);
    };
    for (size_t i = 0; i < drive_.sequence.frames.size(); ++i) {
      set(Variables().Pose(i), ToParameterBlock(*drive_.sequence.frames[i].true_world_from_camera));
    }
    for (size_t i = 0; i < drive_.sequence.objects.size(); ++i) {
      set(Variables().Landmark(i),
          ToParameterBlock(drive_.sequence.objects[i].ground_truth->landmark_in_world));
    }
  }

  Drive drive_{kFrames, kFrames / 2, kTurnSigma};
  BackEndInput input_{drive_.sequence, drive_.starts, drive_.priors, {}, {}};
  OptimiseOptions options_ = TangencyOptions();
  std::optional<BackEndProblem> problem_;
};

TEST_F(StartInPartsTest, LeadsToTheMinimumThatIsFoundFromTheTruth) {
  MakeProblem();
  StartAtTheTruth();
  problem_->Solve();
  const double lowest = problem_->summary().final_cost;

  MakeProblem();
  const double before = Cost();
  EXPECT_TRUE(Start());
  EXPECT_LT(Cost(), 1e-3 * before);
  problem_->Solve(500, /*hardly_damped_near=*/true);
  EXPECT_TRUE(problem_->summary().converged);
  EXPECT_LT(problem_->summary().final_cost, 1.005 * lowest);  // no landmark is lost on the way
}

TEST_F(StartInPartsTest, LeavesPlanesAndBiasWhereTheyAre) {
  SupportPlane& floor = drive_.sequence.planes.front();
  floor.attitude_information = 1e-3 * Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  options_.detector_bias_sigma_px = 2.0;
  MakeProblem();
  const double before = Cost();
  Start();
  EXPECT_LT(Cost(), 1e-3 * before);
  EXPECT_EQ(Variables().PlaneValue(0).normal, floor.plane_in_world.normal);
  EXPECT_EQ(Variables().PlaneValue(0).offset, floor.plane_in_world.offset);
  EXPECT_EQ(Variables().BiasValues(), (std::array<double, 4>{}));
}

TEST_F(StartInPartsTest, LeavesWhatIsHeldAsItIs) {
  MakeProblem();
  // Not the one that is held anyway, and its rotation not quite a unit quaternion, as files have
  // it.
  const auto held = static_cast<size_t>(Variables().Pose(kFramesPerPart + 7));
  const auto held_landmark = static_cast<size_t>(Variables().Landmark(0));
  Variable& pose = Variables().all()[held];
  Variable& landmark = Variables().all()[held_landmark];
  pose.is_held = landmark.is_held = true;
  pose.values[0] *= 1.0 + 1e-9;
  const std::vector<double> before(pose.values, pose.values + kPoseSize);
  const std::vector<double> landmark_before(landmark.values, landmark.values + kLandmarkSize);
  Start();
  EXPECT_TRUE(IsMoved(kFramesPerPart + 8));
  EXPECT_EQ(std::vector<double>(pose.values, pose.values + kPoseSize), before);
  EXPECT_EQ(std::vector<double>(landmark.values, landmark.values + kLandmarkSize), landmark_before);
}

TEST_F(StartInPartsTest, StartsEllipsoidsFromTheirQuadricsAsWell) {
  for (auto& start : input_.starts) start->shape_exponent = kEllipsoidExponent;
  options_.detection_model = DetectionModel::kQuadric;
  MakeProblem();
  const double before = Cost();
  Start();
  EXPECT_LT(Cost(), 0.1 * before);
}

TEST_F(StartInPartsTest, LeavesSegmentsOfFourPartsWhereTheyAre) {
  MakeProblem();
  Start(kFrames / 4);
  for (size_t i = 0; i < kFrames; ++i) EXPECT_FALSE(IsMoved(i)) << i;
}

// Its dead reckoning costs 2 x 10^7, the minimum 10^4.
TEST(StartInPartsOfALongDrive, IsWhereTheBackEndStarts) {
  const Drive drive(1010, 505);
  const BackEndInput input{drive.sequence, drive.starts, drive.priors, {}, {}};
  const MapEstimate map = OptimiseMap(input, TangencyOptions());
  EXPECT_LT(map.solver.initial_cost, 1e5);
  EXPECT_LT(map.solver.final_cost, map.solver.initial_cost);
}

// Each part makes its own map of a table that all frames see; together they cost more than the
// truth with a little drift.
TEST(StartInPartsOfARoom, MovesNothingWhereThatCostsMore) {
  Sequence sequence = SyntheticSequence(RandomScene(3, 5, 60), true);
  for (Detection& detection : sequence.detections) {
    detection.box.x_min += RandomUniform(-5, 5);
    detection.box.y_max += RandomUniform(-5, 5);
  }
  const BackEndInput input = TruthInput(sequence);
  const OptimiseOptions options = TangencyOptions();
  BackEndProblem problem(input, options);
  const auto is_where_it_was = [&](size_t frame) {
    return problem.variables().PoseValue(frame).Matrix().isApprox(
        sequence.frames[frame].world_from_camera.Matrix(), 1e-9);
  };
  EXPECT_FALSE(StartInParts(sequence, problem.AllTerms(), 10, &problem.variables()));
  for (size_t i = 0; i < sequence.frames.size(); ++i) EXPECT_TRUE(is_where_it_was(i)) << i;
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    EXPECT_TRUE(
        problem.variables().LandmarkValue(i)->Centre().isApprox(input.starts[i]->Centre(), 1e-9));
  }
}

// Each segment's first pose defines a world of its own.
TEST_F(StartInPartsTest, StartsASegmentWhereItStarts) {
  constexpr size_t kSecond = kFrames / 2;
  constexpr size_t kFifthOfSegment = kSecond / 5;
  // In so short parts and with the fixture's turns, rounding decides whether a landmark is lost.
  drive_ = Drive(kFrames, kFrames / 2, 0.25 * kTurnSigma);
  options_.odometry_rotation_sigma_deg *= 0.25;
  input_.starts = drive_.starts;
  for (size_t i = kSecond; i < kFrames; ++i) drive_.sequence.frames[i].segment = 1;
  MakeProblem();
  Start(kFifthOfSegment);
  EXPECT_TRUE(IsMoved(kSecond - 1));
  EXPECT_FALSE(IsMoved(kSecond));
  EXPECT_TRUE(IsMoved(kSecond + kFifthOfSegment));
}

TEST_F(StartInPartsTest, IsNotDoneWhereASegmentIsLeftAsItWas) {
  for (size_t i = kFrames - 20; i < kFrames; ++i) drive_.sequence.frames[i].segment = 1;
  MakeProblem();
  EXPECT_FALSE(Start());
  EXPECT_TRUE(IsMoved(kFramesPerPart));
}

// What a part with few views makes of a landmark is not left.
TEST_F(StartInPartsTest, LandmarksFitThePartThatSeesThemMostOften) {
  MakeProblem();
  Start();
  const auto part_of = [](const Detection& detection) {
    return static_cast<size_t>(detection.frame_index) / kFramesPerPart;
  };
  std::vector<std::map<size_t, int>> views(drive_.sequence.objects.size());
  for (const Detection& detection : drive_.sequence.detections) {
    ++views[static_cast<size_t>(detection.object_index)][part_of(detection)];
  }
  int in_several = 0;
  for (const Detection& detection : drive_.sequence.detections) {
    const auto object = static_cast<size_t>(detection.object_index);
    const auto& of_object = views[object];
    if (of_object.size() < 2 || 2 * of_object.at(part_of(detection)) <= kDriveViews) continue;
    ++in_several;
    const Rigid3d pose = Variables().PoseValue(static_cast<size_t>(detection.frame_index));
    const double off_px = OutlineEdgeRms(
        drive_.sequence.camera, Transform(pose.Inverse(), *Variables().LandmarkValue(object)),
        detection.box);
    EXPECT_LT(off_px, 0.2 * (detection.box.Width() + detection.box.Height())) << object;
  }
  EXPECT_GT(in_several, 100);
}

// Five parts: poses and one landmark, which start at 0 and have costs of their x alone.
class PartsOfALine : public testing::Test {
 protected:
  explicit PartsOfALine(size_t frames_per_part = 1) : frames_per_part_(frames_per_part) {
    sequence_.frames.resize(5 * frames_per_part);
    sequence_.objects.emplace_back();
    variables_.emplace(input_);
  }
  // Adds a cost of a pose.
  const CurveTerm& Add(size_t frame, const CurveOf& curve) {
    return AddTerm({variables_->Pose(frame)}, curve);
  }
  // Adds a cost of the landmark, which that frame sees.
  void AddView(size_t frame, const CurveOf& curve) {
    AddTerm({variables_->Pose(frame), variables_->Landmark(0)}, curve);
  }
  bool Start() {
    Terms terms;
    for (const auto& curve : curves_) terms.push_back(curve.get());
    return StartInParts(sequence_, terms, frames_per_part_, &*variables_);
  }
  double Pose(size_t frame) const { return variables_->PoseValue(frame).translation.x(); }
  double Landmark() const { return variables_->LandmarkValue(0)->Centre().x(); }

 private:
  const CurveTerm& AddTerm(const std::vector<int>& variables, const CurveOf& curve) {
    const Variable& last = variables_->all()[static_cast<size_t>(variables.back())];
    curves_.push_back(std::make_unique<CurveTerm>(variables, last, curve));
    return *curves_.back();
  }

  Sequence sequence_;
  BackEndInput input_{sequence_, {soslam::Landmark{}}, {}, {}, {}};
  size_t frames_per_part_;
  std::optional<BackEndVariables> variables_;
  std::vector<std::unique_ptr<CurveTerm>> curves_;
};

// Drawn to a place, by steps that lead there at once or a share of the way.
CurveOf DrawnTo(double place, double share = 1.0) {
  return [=](double x) {
    const double off = x - place, curvature = 100.0;
    return Curve{0.5 * curvature * off * off, curvature * off, curvature / share,
                 curvature / share};
  };
}

// Valleys at all whole numbers, the lowest at `lowest`.
CurveOf Valleys(double lowest) {
  return [=](double x) {
    constexpr double kTurn = 2.0 * std::numbers::pi;
    const double off = x - lowest;
    return Curve{1.0 - std::cos(kTurn * x) + 0.05 * off * off,
                 kTurn * std::sin(kTurn * x) + 0.1 * off, kTurn * kTurn, kTurn * kTurn};
  };
}

// A tenth of the way with each step: after one round, half of the way is left.
TEST_F(PartsOfALine, APartIsSolvedAgainUntilItSettles) {
  const CurveTerm& slow = Add(1, DrawnTo(1.0, 0.1));
  const CurveTerm& fast = Add(3, DrawnTo(2.0));
  EXPECT_TRUE(Start());
  EXPECT_NEAR(Pose(1), 1.0, 0.05);
  EXPECT_NEAR(Pose(3), 2.0, 1e-3);
  EXPECT_GT(slow.times_linearised(), 20);
  EXPECT_LT(fast.times_linearised(), 5);
}

// It would take hundreds of steps.
TEST_F(PartsOfALine, APartThatDoesNotSettleIsLeftAfterSomeRounds) {
  const CurveTerm& creeping = Add(1, DrawnTo(1.0, 0.02));
  Start();
  EXPECT_GT(creeping.times_linearised(), 20);
  EXPECT_LT(creeping.times_linearised(), 100);
}

// From 60 to 10: a part may only have taken its own view of something.
TEST_F(PartsOfALine, NothingIsMovedWhereThatDoesNotCostMuchLess) {
  Add(1, [](double x) {
    Curve curve = DrawnTo(1.0)(x);
    curve.cost += 10.0;
    return curve;
  });
  EXPECT_FALSE(Start());
  EXPECT_EQ(Pose(1), 0.0);
}

// Where its frames are now, it would end in the valley at 1.
TEST_F(PartsOfALine, ALandmarkThatIsFittedAnewMustCostLess) {
  Add(2, DrawnTo(1.0));
  AddView(2, Valleys(0.0));
  EXPECT_TRUE(Start());
  EXPECT_NEAR(Pose(2), 1.0, 1e-3);
  EXPECT_NEAR(Landmark(), 0.0, 1e-3);
}

class LongPartsOfALine : public PartsOfALine {
 protected:
  LongPartsOfALine() : PartsOfALine(5) {}
};

// They have moved differently; where the first or the last of them have moved to, it finds other
// valleys.
TEST_F(LongPartsOfALine, ALandmarkIsFittedAnewWhereTheMiddleOfItsFramesIs) {
  for (const size_t view : {1, 2, 3}) {
    Add(5 + view, DrawnTo(static_cast<double>(view)));
    AddView(5 + view, Valleys(2.0));
  }
  EXPECT_TRUE(Start());
  EXPECT_NEAR(Landmark(), 2.0, 1e-3);
}

}  // namespace
}  // namespace soslam
