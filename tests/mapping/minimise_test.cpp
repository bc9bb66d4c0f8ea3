// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/minimise.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "constraints/manifolds.h"
#include "constraints/odometry.h"
#include "constraints/upright_on_plane.h"
#include "geometry/angles.h"
#include "mapping/back_end_problem.h"
#include "mapping/landmark_fit.h"
#include "support/cost_function_term.h"
#include "support/cuboid_map.h"
#include "support/curve_term.h"
#include "support/landmark_term_residual.h"
#include "support/random.h"
#include "support/standing_scene.h"

namespace soslam {
namespace {

// One edge of a detection, for Ceres.
class TangencyResidual final : public ceres::SizedCostFunction<1, kPoseSize, kLandmarkSize> {
 public:
  TangencyResidual(const BoxEdge& edge, const Landmark& start_in_camera)
      : edge_(edge),
        depth_by_centre_(TangentDepth(edge, start_in_camera) / start_in_camera.Centre().z()),
        shape_exponent_(start_in_camera.shape_exponent) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const RelativeObservation observation(blocks, shape_exponent_);
    LandmarkJacobian1 by_landmark;
    const double depth_m = observation.landmark_in_camera().Centre().z();
    residuals[0] = Tangency(edge_, observation.landmark_in_camera(), depth_by_centre_ * depth_m,
                            0.0, &by_landmark);
    by_landmark[5] -= residuals[0] / depth_m;
    observation.WriteJacobians<1>(by_landmark, blocks, jacobians);
    return true;
  }

 private:
  BoxEdge edge_;
  double depth_by_centre_;
  double shape_exponent_;
};

// The final cost of what BackEndProblem makes of given planes without a bias, by Ceres.
double CostByCeres(const BackEndInput& input, const OptimiseOptions& options) {
  const Sequence& sequence = input.sequence;
  BackEndVariables variables(input);
  const auto values = [&](int index) { return variables.all()[static_cast<size_t>(index)].values; };
  ceres::HuberLoss loss(options.huber_delta);
  ceres::Problem::Options borrow;
  borrow.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(borrow);
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    double* pose = values(variables.Pose(i));
    problem.AddParameterBlock(pose, kPoseSize, NewPoseManifold());
    if (i == 0) {
      problem.SetParameterBlockConstant(pose);
      continue;
    }
    const Rigid3d step =
        sequence.frames[i - 1].world_from_camera.Inverse() * sequence.frames[i].world_from_camera;
    problem.AddResidualBlock(
        new OdometryResidual(step, options.odometry_rotation_sigma_deg * kRadPerDeg,
                             options.odometry_translation_sigma_m),
        &loss, values(variables.Pose(i - 1)), pose);
  }
  for (size_t i = 0; i < input.starts.size(); ++i) {
    double* landmark = values(variables.Landmark(i));
    problem.AddParameterBlock(landmark, kLandmarkSize, NewLandmarkManifold());
    const auto plane = static_cast<size_t>(sequence.objects[i].plane_index);
    double* normal = values(variables.Normal(plane));
    double* offset = values(variables.Offset(plane));
    problem.AddResidualBlock(
        new UprightOnPlaneResidual(options.standing_angle_sigma_deg * kRadPerDeg,
                                   options.standing_height_sigma_m),
        nullptr, landmark, normal, offset);
    problem.SetParameterBlockConstant(normal);
    problem.SetParameterBlockConstant(offset);
    problem.AddResidualBlock(
        new LandmarkTermResidual(std::make_unique<RatioTerm>(*input.priors[i])), nullptr, landmark);
  }
  for (const Detection& detection : sequence.detections) {
    const auto frame = static_cast<size_t>(detection.frame_index);
    const auto object = static_cast<size_t>(detection.object_index);
    const Landmark start =
        Transform(sequence.frames[frame].world_from_camera.Inverse(), *input.starts[object]);
    for (const BoxEdge& edge : BoxEdges(sequence.camera, detection.box, detection.is_bound,
                                        options.detection_sigma_fraction)) {
      problem.AddResidualBlock(new TangencyResidual(edge, start), &loss,
                               values(variables.Pose(frame)), values(variables.Landmark(object)));
    }
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = 2000;
  solver.function_tolerance = 1e-13;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  return summary.final_cost;
}

// Both end in the same minimum when they start near it.
TEST(Minimise, FindsTheMinimumThatCeresFinds) {
  for (const double p : {1.0, 1.4, 2.0}) {
    const Sequence sequence = SyntheticSequence(RandomScene(3, 3, 8, {Shape::kBox}), true);
    BackEndInput input = TruthInput(sequence);
    for (auto& start : input.starts) {
      *start = RotatedAboutZ(*start, 0.05);
      start->shape_exponent = p;
    }
    for (auto& prior : input.priors) prior->log_sigma = {0.1, 0.1};
    const OptimiseOptions options = TangencyOptions();
    BackEndProblem problem(input, options);
    problem.Solve();
    const double by_ceres = CostByCeres(input, options);
    EXPECT_TRUE(problem.summary().converged);
    EXPECT_LT(problem.summary().final_cost, by_ceres * (1.0 + 1e-7)) << p;
    EXPECT_GT(problem.summary().final_cost, by_ceres * (1.0 - 1e-3)) << p;
    EXPECT_LT(problem.summary().iterations, 60) << p;
  }
}

// The offset of a plane, and terms of it.
class OffsetTest : public testing::Test {
 protected:
  OffsetTest() {
    sequence_.planes.push_back({0, Plane{}});
    variables_.emplace(input_);
  }
  std::unique_ptr<Term> TermOf(std::unique_ptr<const ceres::CostFunction> function,
                               double huber_delta) {
    const int offset = variables_->Offset(0);
    return std::make_unique<CostFunctionTerm>(
        std::move(function),
        std::vector<CostFunctionTerm::Block>{
            {offset, VariableKind::kOffset, variables_->Values(offset)}},
        huber_delta);
  }
  double& Offset() { return *variables_->all()[static_cast<size_t>(variables_->Offset(0))].values; }

  Sequence sequence_;
  BackEndInput input_{sequence_, {}, {}, {}, {}};
  std::optional<BackEndVariables> variables_;
};

// value - place; not defined from 10 on.
class Distance final : public ceres::SizedCostFunction<1, 1> {
 public:
  explicit Distance(double place) : place_(place) {}
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    residuals[0] = blocks[0][0] - place_;
    if (jacobians != nullptr && jacobians[0] != nullptr) jacobians[0][0] = 1.0;
    return blocks[0][0] < 10.0;
  }

 private:
  double place_;
};

// At the middle one of three places the outer two, both farther than the loss's width of 0.5, pull
// against each other with the same force.
TEST_F(OffsetTest, OutliersPullNoHarderThanTheLossSays) {
  std::vector<std::unique_ptr<Term>> terms;
  for (const double place : {0.0, 1.0, 9.0}) {
    terms.push_back(TermOf(std::make_unique<Distance>(place), 0.5));
  }
  const Minimisation result = Minimise({terms[0].get(), terms[1].get(), terms[2].get()},
                                       {.max_iterations = 50}, &variables_->all());
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(Offset(), 1.0, 1e-5);
  EXPECT_NEAR(result.costs.back(), 0.5 * (1.0 - 0.25) + 0.5 * (8.0 - 0.25), 1e-9);
  EXPECT_TRUE(std::ranges::is_sorted(result.costs, std::greater<>()));
}

TEST_F(OffsetTest, StepsIntoWhereACostIsNotDefinedAreShortened) {
  const auto term = TermOf(std::make_unique<Distance>(9.999), 1e9);
  const auto pull = TermOf(std::make_unique<Distance>(10.5), 1e9);
  const Minimisation result =
      Minimise({term.get(), pull.get()}, {.max_iterations = 100}, &variables_->all());
  EXPECT_LT(Offset(), 10.0);
  EXPECT_GT(Offset(), 9.0);
  EXPECT_LT(result.costs.back(), result.costs.front());
}

TEST_F(OffsetTest, AStartWhereACostIsNotDefinedIsRefused) {
  Offset() = 11.0;
  const auto term = TermOf(std::make_unique<Distance>(0.0), 1e9);
  EXPECT_THROW(Minimise({term.get()}, {.max_iterations = 10}, &variables_->all()), NumericalError);
}

TEST_F(OffsetTest, WhatIsHeldStays) {
  Offset() = 3.0;
  variables_->Hold(variables_->Offset(0));
  const auto term = TermOf(std::make_unique<Distance>(0.0), 1e9);
  const Minimisation result = Minimise({term.get()}, {.max_iterations = 10}, &variables_->all());
  EXPECT_EQ(Offset(), 3.0);
  EXPECT_EQ(result.costs.back(), 4.5);
}

class CurveTest : public OffsetTest {
 protected:
  Minimisation MinimiseCurve(double from, const MinimiseOptions& options, const CurveOf& curve) {
    Offset() = from;
    const int offset = variables_->Offset(0);
    const CurveTerm term({offset}, variables_->all()[static_cast<size_t>(offset)], curve);
    Minimisation result = Minimise({&term}, options, &variables_->all());
    times_linearised_ = term.times_linearised();
    return result;
  }

  int times_linearised_ = 0;
};

// Steps of a quarter of the way, along which an iteration gains less than a hundredth: second
// derivatives count, and are negative beyond 1.
TEST_F(CurveTest, WhereItBendsDownwardsNoIterationIsLost) {
  const Minimisation result = MinimiseCurve(8.0, {.max_iterations = 50}, [](double x) {
    const double share = 1.0 / (1.0 + x * x);
    return Curve{100.0 - 0.5 * std::log(share), x * share, 4.0 * share,
                 (1.0 - x * x) * share * share};
  });
  EXPECT_TRUE(result.converged);
  EXPECT_NEAR(Offset(), 0.0, 1e-2);
  ASSERT_GT(result.costs.size(), 8U);
  for (size_t i = 1; i < 8; ++i) EXPECT_LT(result.costs[i], result.costs[i - 1]) << i;
}

// Second derivatives that are much too small lead too far. The next step does without them.
TEST_F(CurveTest, AfterANearStepThatIsRefusedAFarOneIsTaken) {
  const Minimisation result = MinimiseCurve(0.1, {.max_iterations = 50}, [](double x) {
    return Curve{50.0 + 0.5 * x * x, x, 4.0, 0.01};
  });
  EXPECT_TRUE(result.converged);
  int refused = 0;
  for (size_t i = 2; i < result.costs.size(); ++i) {
    refused += result.costs[i] == result.costs[i - 1] ? 1 : 0;
    EXPECT_LT(result.costs[i], result.costs[i - 2]) << i;
  }
  EXPECT_GT(refused, 1);
}

// They are much too small: a step that counts them leads too far.
TEST_F(CurveTest, SecondDerivativesDoNotCountWhileStepsBringMuch) {
  const Minimisation result = MinimiseCurve(1.0, {.max_iterations = 8}, [](double x) {
    return Curve{0.5 * x * x, x, 1.25, 0.3};
  });
  ASSERT_EQ(result.costs.size(), 9U);
  for (size_t i = 1; i < result.costs.size(); ++i) {
    EXPECT_LT(result.costs[i], 0.1 * result.costs[i - 1]) << i;
  }
}

// Each leads far beyond the minimum.
TEST_F(CurveTest, WhileFarStepsAreRefusedTheirEquationsAreKept) {
  const Minimisation result = MinimiseCurve(0.1, {.max_iterations = 5}, [](double x) {
    return Curve{100.0 + 0.5 * x * x, x, 0.01, 1.0};
  });
  EXPECT_EQ(result.costs, std::vector<double>(6, result.costs.front()));
  EXPECT_EQ(times_linearised_, 1);
}

TEST_F(CurveTest, EndsWithTheFirstIterationOfLessThanTheLeastGain) {
  constexpr double kLeastGain = 0.1;
  const Minimisation result =
      MinimiseCurve(8.0, {.max_iterations = 50, .least_gain = kLeastGain}, [](double x) {
        return Curve{1.0 + 0.5 * x * x, x, 4.0, 4.0};
      });
  EXPECT_TRUE(result.converged);
  const auto& costs = result.costs;
  ASSERT_GT(costs.size(), 4U);
  for (size_t i = 1; i < costs.size(); ++i) {
    EXPECT_EQ(costs[i - 1] - costs[i] < kLeastGain * costs[i - 1], i + 1 == costs.size()) << i;
  }
}

// Expected to gain less than a hundredth of the least gain, or of costs that are all but zero.
TEST_F(CurveTest, StepsThatAreNotWorthItAreNotTried) {
  for (const double where : {-1e-5, 1e-10}) {
    const Minimisation result = MinimiseCurve(where, {.max_iterations = 50}, [](double x) {
      return Curve{(x < 0.0 ? 100.0 : 0.0) + 0.5 * x * x, x, 1.0, 1.0};
    });
    EXPECT_TRUE(result.converged);
    EXPECT_EQ(result.costs.size(), 2U);
    EXPECT_EQ(Offset(), where);
  }
}

TEST(DampingTest, FallsToItsLeastAndNoFurther) {
  Damping usual;
  Damping hardly(1e-12, 1e-15, 0.1);
  const Eigen::Vector2d diagonal(2.0, 3.0);
  for (int i = 0; i < 30; ++i) {
    usual.StepTaken(1.0);
    hardly.StepTaken(1.0);
  }
  EXPECT_TRUE(usual.Of(diagonal).isApprox(1e-12 * diagonal));
  EXPECT_TRUE(hardly.Of(diagonal).isApprox(1e-15 * diagonal));
}

}  // namespace
}  // namespace soslam
