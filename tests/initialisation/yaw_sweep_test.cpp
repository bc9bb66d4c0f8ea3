// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/yaw_sweep.h"

#include <ceres/ceres.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "support/level_sequence.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double kPi = std::numbers::pi;
constexpr double kDegrees = kPi / 180.0;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kStep = 3.0 * kDegrees;
constexpr size_t kAll = 1000;

double RandomYaw() { return RandomUniform(-3.1, 3.1); }

TEST(SolveAtYaw, RecoversTheBodyOfAnExactBoxAtItsYaw) {
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 50; ++i) {
      const StandingBody body(p);
      const auto landmark = SolveAtYaw(body.observation, body.Yaw());
      ASSERT_TRUE(landmark) << p;
      EXPECT_TRUE(IsSameBody(*landmark, body.truth, 1e-8)) << p;
    }
  }
}

TEST(SolveAtYaw, StandsOnThePlaneAtTheYawWithThePriorsRatio) {
  for (int i = 0; i < 100; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(body.Observe(Disturbed(body.box, 0.05)), yaw);
    ASSERT_TRUE(landmark);
    EXPECT_NEAR(std::remainder(Yaw(body.plane.normal, landmark->frame_from_object.rotation) - yaw,
                               2.0 * kPi),
                0.0, 1e-9);
    EXPECT_NEAR(body.plane.SignedDistance(landmark->Centre()), landmark->half_axes.z(), 1e-9);
    const Eigen::Vector2d ratio = landmark->half_axes.head<2>() / landmark->half_axes.z();
    EXPECT_LT((ratio - body.observation.prior.ratio).norm(), 1e-9);
    EXPECT_EQ(landmark->shape_exponent, body.truth.shape_exponent);
  }
}

// The body of the prior's ratio at a yaw, by foot and half height.
Landmark BodyAt(const UprightObservation& observation, double yaw, const double* foot_and_c) {
  const ShapePrior& prior = observation.prior;
  const double c = foot_and_c[2];
  UprightVector parameters;
  parameters << yaw, foot_and_c[0], foot_and_c[1], std::log(prior.ratio.x() * c),
      std::log(prior.ratio.y() * c), std::log(c);
  return UprightLandmark(observation.plane_in_camera, parameters, prior.shape_exponent);
}

// Its tangencies, with tangent points at given depths.
class TangencyCost {
 public:
  TangencyCost(const UprightObservation& observation, double yaw, const Landmark& depths_of)
      : observation_(observation), yaw_(yaw) {
    for (size_t i = 0; i < 4; ++i) depths_m_[i] = TangentDepth(observation.edges[i], depths_of);
  }

  bool operator()(const double* foot_and_c, double* residuals) const {
    const Landmark landmark = BodyAt(observation_, yaw_, foot_and_c);
    for (size_t i = 0; i < 4; ++i) {
      residuals[i] = Tangency(observation_.edges[i], landmark, depths_m_[i], 0.0, nullptr);
    }
    return true;
  }

 private:
  const UprightObservation& observation_;
  double yaw_;
  std::array<double, 4> depths_m_;
};

double Cost(const LandmarkTerm& term, const Landmark& landmark) {
  Eigen::VectorXd residuals(term.NumResiduals());
  term.Evaluate(landmark, residuals, nullptr);
  return 0.5 * residuals.squaredNorm();
}

// The optimum of TangencyCost, from a disturbed start, by Levenberg-Marquardt.
Landmark Optimum(const UprightObservation& observation, double yaw, const Landmark& landmark) {
  const UprightVector parameters = UprightParameters(observation.plane_in_camera, landmark);
  Eigen::Vector3d foot_and_c(parameters(1), parameters(2), landmark.half_axes.z());
  foot_and_c.head<2>() += RandomVector(-0.2, 0.2).head<2>();
  foot_and_c.z() *= RandomUniform(0.8, 1.2);
  ceres::Problem problem;
  problem.AddResidualBlock(new ceres::NumericDiffCostFunction<TangencyCost, ceres::CENTRAL, 4, 3>(
                               new TangencyCost(observation, yaw, landmark)),
                           nullptr, foot_and_c.data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.function_tolerance = 0.0;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 1e-15;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
  return BodyAt(observation, yaw, foot_and_c.data());
}

TEST(SolveAtYaw, IsTheOptimumThatLevenbergMarquardtFinds) {
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 30; ++i) {
      const StandingBody body(p);
      const UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
      const double yaw = RandomYaw();
      const auto landmark = SolveAtYaw(observation, yaw);
      ASSERT_TRUE(landmark);
      const Landmark optimum = Optimum(observation, yaw, *landmark);
      // The square root of the precision is as near as costs can tell.
      EXPECT_TRUE(IsSameBody(*landmark, optimum, 1e-7)) << p;
      const BoxTerm term(observation.edges, *landmark);
      EXPECT_LE(Cost(term, *landmark), Cost(term, optimum) + 1e-12) << p;
    }
  }
}

TEST(SolveAtYaw, IsTheOptimumWhereOneEdgeIsABound) {
  int reached = 0;
  constexpr int kBodies = 100;
  for (int i = 0; i < kBodies; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    std::array<bool, 4> is_bound{};
    const auto bound = static_cast<size_t>(i % 4);
    is_bound[bound] = true;
    const UprightObservation observation = body.Observe(Disturbed(body.box, 0.1), is_bound);
    const double yaw = body.Yaw() + RandomUniform(-0.3, 0.3);
    const auto landmark = SolveAtYaw(observation, yaw);
    ASSERT_TRUE(landmark);
    EXPECT_TRUE(IsSameBody(*landmark, Optimum(observation, yaw, *landmark), 1e-6)) << bound;
    reached += Tangency(observation.edges[bound], *landmark, 1.0, 0.0, nullptr) == 0.0 ? 1 : 0;
  }
  EXPECT_GT(reached, kBodies / 5);
  EXPECT_LT(reached, kBodies * 4 / 5);
}

// Moves one edge outwards (inwards where negative) by a fraction of the box.
Box WithEdgeMoved(Box box, size_t edge, double fraction) {
  double* sides[] = {&box.x_min, &box.y_min, &box.x_max, &box.y_max};
  const double side = edge % 2 == 0 ? box.Width() : box.Height();
  *sides[edge] += (edge < 2 ? -1.0 : 1.0) * fraction * side;
  return box;
}

TEST(SolveAtYaw, RecoversABodyThatABoundCutsFromTheOtherThreeEdges) {
  for (const double p : kShapeExponents) {
    for (size_t edge = 0; edge < 4; ++edge) {
      for (int i = 0; i < 10; ++i) {
        const StandingBody body(p);
        const Box cut = WithEdgeMoved(body.box, edge, -RandomUniform(0.05, 0.3));
        std::array<bool, 4> is_bound{};
        is_bound[edge] = true;
        const auto landmark = SolveAtYaw(body.Observe(cut, is_bound), body.Yaw());
        ASSERT_TRUE(landmark) << "edge " << edge;
        EXPECT_TRUE(IsSameBody(*landmark, body.truth, 1e-6)) << "edge " << edge;
        // As a measurement the same edge changes the body.
        const auto measured = SolveAtYaw(body.Observe(cut), body.Yaw());
        EXPECT_FALSE(measured && IsSameBody(*measured, body.truth, 1e-3)) << "edge " << edge;
      }
    }
  }
}

// The object reaches below where a nearer one hides it, the horizon or higher, while its other
// edges show its size and place.
TEST(SolveAtYaw, RecoversABodyThatIsHiddenUpToTheHorizon) {
  const Plane floor{-Eigen::Vector3d::UnitY(), 1.0};
  const Landmark cabinet = WithShape(
      StandingCuboid(TestCamera(), floor, {300, 390}, 0.4, {0.4, 0.3, 0.9}), kCuboidExponent);
  Box visible = *OutlineBox(TestCamera(), cabinet);
  const double horizon_px = TestCamera().cy;
  ASSERT_LT(visible.y_min, horizon_px - 50.0);
  for (const double lower_edge_px : {horizon_px + 20.0, horizon_px - 20.0}) {
    visible.y_max = lower_edge_px;
    const auto landmark = SolveAtYaw(
        ObservationOf(visible, {false, false, false, true}, floor, PriorOf(cabinet, 0.05)), 0.4);
    ASSERT_TRUE(landmark) << "lower edge " << lower_edge_px << ", horizon " << horizon_px;
    EXPECT_TRUE(IsSameBody(*landmark, cabinet, 1e-6));
  }
}

TEST(SolveAtYaw, HoldsABoundThatTheBodyDoesNotReachForMeasured) {
  for (size_t edge = 0; edge < 4; ++edge) {
    for (int i = 0; i < 20; ++i) {
      const StandingBody body(RandomUniform(1, 2));
      const Box wide = WithEdgeMoved(body.box, edge, RandomUniform(0.05, 0.2));
      std::array<bool, 4> is_bound{};
      is_bound[edge] = true;
      const auto as_bound = SolveAtYaw(body.Observe(wide, is_bound), body.Yaw());
      const auto as_measured = SolveAtYaw(body.Observe(wide), body.Yaw());
      ASSERT_TRUE(as_bound && as_measured);
      EXPECT_TRUE(IsSameBody(*as_bound, *as_measured, 1e-9)) << "edge " << edge;
      EXPECT_FALSE(IsSameBody(*as_bound, body.truth, 1e-3)) << "edge " << edge;
    }
  }
}

TEST(SolveAtYaw, HasNoneWhereThePlaneIsNotInView) {
  for (int i = 0; i < 20; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    UprightObservation above = body.observation;
    above.plane_in_camera.offset = -above.plane_in_camera.offset;
    EXPECT_FALSE(SolveAtYaw(above, RandomYaw()));
    UprightObservation behind = body.observation;
    behind.plane_in_camera = {Eigen::Vector3d::UnitZ(), RandomUniform(0.5, 3.0)};
    EXPECT_FALSE(SolveAtYaw(behind, RandomYaw()));
    // All of the box above the horizon of a floor below a level camera.
    UprightObservation sky = body.Observe({300, 50, 350, TestCamera().cy - 10.0});
    sky.plane_in_camera = {-Eigen::Vector3d::UnitY(), 1.0};
    EXPECT_FALSE(SolveAtYaw(sky, RandomYaw()));
  }
}

TEST(SolveAtYaw, HasNoBodyThatIsNotInFrontOfTheCameraForBoxesThatNoneExplains) {
  int none = 0;
  constexpr int kBoxes = 1000;
  for (int i = 0; i < kBoxes; ++i) {
    const Eigen::Vector4d sides =
        Eigen::Vector4d::NullaryExpr([] { return RandomUniform(1, 500); });
    const Box box{300.0 - sides(0), 300.0 - sides(1), 300.0 + sides(2), 300.0 + sides(3)};
    const ShapePrior prior{{std::exp(RandomUniform(-4, 4)), std::exp(RandomUniform(-4, 4))},
                           {1, 1},
                           RandomUniform(1, 2)};
    const auto landmark = SolveAtYaw(ObservationOf(box, {}, RandomFloor(), prior), RandomYaw());
    none += landmark ? 0 : 1;
    if (!landmark) continue;
    EXPECT_TRUE(landmark->Centre().allFinite() && landmark->half_axes.allFinite());
    EXPECT_GT(landmark->half_axes.minCoeff(), 0.0);
    EXPECT_TRUE(IsInFront(*landmark));
  }
  EXPECT_GT(none, kBoxes / 100);
  EXPECT_LT(none, kBoxes / 2);
}

TEST(SolveAtYaw, ScalesWithTheHeightOfTheCamera) {
  for (int i = 0; i < 50; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(observation, yaw);
    const double scale = RandomUniform(0.1, 10.0);
    observation.plane_in_camera.offset *= scale;
    const auto scaled = SolveAtYaw(observation, yaw);
    ASSERT_TRUE(landmark && scaled);
    Landmark expected = *landmark;
    expected.half_axes *= scale;
    expected.frame_from_object.translation *= scale;
    EXPECT_TRUE(IsSameBody(*scaled, expected, 1e-9));
  }
}

// Half a turn leaves every body as it is; a quarter turn exchanges a and b.
TEST(SolveAtYaw, IsTheSameBodyAfterAHalfTurnAndAfterAQuarterTurnWithTheAxesExchanged) {
  for (int i = 0; i < 50; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(observation, yaw);
    const auto half_turn = SolveAtYaw(observation, yaw + kPi);
    std::swap(observation.prior.ratio.x(), observation.prior.ratio.y());
    const auto quarter_turn = SolveAtYaw(observation, yaw + 0.5 * kPi);
    ASSERT_TRUE(landmark && half_turn && quarter_turn);
    EXPECT_TRUE(IsSameBody(*half_turn, *landmark, 1e-9));
    EXPECT_TRUE(IsSameBody(*quarter_turn, WithAxesExchanged(*landmark), 1e-9));
  }
}

Eigen::Vector3d Mirrored(const Eigen::Vector3d& vector) {
  return {-vector.x(), vector.y(), vector.z()};
}

// What a mirror at x = 0 of the camera frame shows: left and right exchange.
TEST(SolveAtYaw, MirrorsWithTheScene) {
  for (int i = 0; i < 50; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    const std::array<bool, 4> is_bound = {i % 3 == 0, false, false, false};
    const Box box = Disturbed(body.box, 0.05);
    const double yaw = RandomYaw();
    const auto landmark = SolveAtYaw(body.Observe(box, is_bound), yaw);
    UprightObservation mirrored = body.observation;
    mirrored.camera.cx = -mirrored.camera.cx;
    mirrored.plane_in_camera.normal = Mirrored(body.plane.normal);
    mirrored.edges =
        BoxEdges(mirrored.camera, {-box.x_max, box.y_min, -box.x_min, box.y_max},
                 {is_bound[2], is_bound[1], is_bound[0], is_bound[3]}, kDetectionSigmaFraction);
    const Eigen::Vector3d front =
        Mirrored(UprightRotation(body.plane.normal, yaw) * Eigen::Vector3d::UnitX());
    const double mirrored_yaw =
        Yaw(mirrored.plane_in_camera.normal,
            Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), front));
    const auto found = SolveAtYaw(mirrored, mirrored_yaw);
    ASSERT_TRUE(landmark && found);
    const double size = landmark->half_axes.maxCoeff();
    EXPECT_LT((found->Centre() - Mirrored(landmark->Centre())).norm(), 1e-8 * size);
    EXPECT_LT((found->half_axes - landmark->half_axes).norm(), 1e-8 * size);
  }
}

// The sum of all terms, tangent points at the depths of the landmark itself.
double CostAtOwnDepths(const YawObjective& objective, const Landmark& landmark) {
  double cost = 0.0;
  for (const auto& term : objective.terms(landmark)) cost += Cost(*term, landmark);
  return cost;
}

TEST(BoxObjective, AddsThePreferenceForTheWorldsAxes) {
  for (int i = 0; i < 50; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
    const Landmark landmark = Turned(body.truth, RandomYaw());
    const double without = CostAtOwnDepths(BoxObjective(observation), landmark);
    observation.axes_weight = RandomUniform(0.5, 3.0);
    const Eigen::Vector3d front = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitX();
    const double angle =
        std::atan2(front.cross(observation.world_axis_in_camera).dot(body.plane.normal),
                   front.dot(observation.world_axis_in_camera));
    const double with = CostAtOwnDepths(BoxObjective(observation), landmark);
    EXPECT_NEAR(with - without, observation.axes_weight * std::pow(std::sin(2.0 * angle), 2),
                1e-8 * (1.0 + without));
    // A quarter turn of the world is no change.
    observation.world_axis_in_camera = observation.world_axis_in_camera.cross(body.plane.normal);
    EXPECT_NEAR(CostAtOwnDepths(BoxObjective(observation), landmark), with, 1e-8 * (1.0 + with));
  }
}

TEST(BoxObjective, CostsNothingAtTheTruth) {
  for (const double p : kShapeExponents) {
    const StandingBody body(p);
    EXPECT_LT(CostAtOwnDepths(BoxObjective(body.observation), body.truth), 1e-15);
  }
}

TEST(SweepYaw, CoversHalfATurnWithLandmarksAtTheirYaws) {
  for (const double step_deg : {1.0, 3.0, 7.0, 45.0}) {
    const StandingBody body(1.5);
    const YawSweep sweep =
        SweepYaw(body.observation, BoxObjective(body.observation), step_deg * kDegrees);
    ASSERT_EQ(sweep.yaw.size(), static_cast<size_t>(std::lround(180.0 / step_deg)));
    ASSERT_EQ(sweep.solutions.size(), sweep.yaw.size());
    const std::vector<double> costs = sweep.Costs();
    const double step = kPi / static_cast<double>(sweep.yaw.size());
    for (size_t i = 0; i < sweep.yaw.size(); ++i) {
      EXPECT_NEAR(sweep.yaw[i], step * static_cast<double>(i), 1e-12);
      ASSERT_TRUE(sweep.solutions[i]);
      EXPECT_EQ(costs[i], sweep.solutions[i]->cost);
      const Landmark& landmark = sweep.solutions[i]->landmark;
      const double yaw = Yaw(body.plane.normal, landmark.frame_from_object.rotation);
      EXPECT_NEAR(YawDifferenceModuloPi(yaw, sweep.yaw[i]), 0.0, 1e-9);
      EXPECT_NEAR(body.plane.SignedDistance(landmark.Centre()), landmark.half_axes.z(), 1e-9);
      EXPECT_EQ(landmark.shape_exponent, 1.5);
      EXPECT_TRUE(IsInFront(landmark));
    }
  }
}

TEST(SweepYaw, IsEmptyWhereThePlaneIsNotInView) {
  StandingBody body(1.5);
  body.observation.plane_in_camera.offset = -1.0;
  const YawObjective objective = BoxObjective(body.observation);
  const YawSweep sweep = SweepYaw(body.observation, objective, kStep);
  for (const double cost : sweep.Costs()) EXPECT_TRUE(std::isnan(cost));
  EXPECT_THAT(LocalOptima(body.observation, objective, sweep, kAll), IsEmpty());
}

// Terms of the start, and again those of the result.
TEST(SweepYaw, RepeatsItsFitsFromTheirResults) {
  const StandingBody body(1.5);
  const YawObjective box = BoxObjective(body.observation);
  std::vector<Landmark> starts;
  YawObjective objective;
  objective.terms = [&](const Landmark& start) {
    starts.push_back(start);
    return box.terms(start);
  };
  objective.rounds = 3;
  objective.extra_cost = [](const Landmark&) { return 7.0; };
  const YawSweep sweep = SweepYaw(body.observation, objective, 45.0 * kDegrees);
  ASSERT_EQ(starts.size(), 12u);
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_TRUE(IsSameBody(starts[3 * i], *SolveAtYaw(body.observation, sweep.yaw[i]), 1e-12));
    Landmark landmark = starts[3 * i];
    double cost = 0.0;
    for (size_t round = 0; round < 3; ++round) {
      EXPECT_TRUE(IsSameBody(starts[3 * i + round], landmark, 1e-9));
      const auto fit = FitUpright(body.plane, landmark, box.terms(landmark), false);
      landmark = fit->landmark;
      cost = fit->cost;
    }
    EXPECT_TRUE(IsSameBody(sweep.solutions[i]->landmark, landmark, 1e-9));
    EXPECT_NEAR(sweep.solutions[i]->cost, cost + 7.0, 1e-9);
  }
}

std::vector<UprightSolution> Optima(const UprightObservation& observation, size_t max_count = kAll,
                                    double step = kStep) {
  const YawObjective objective = BoxObjective(observation);
  return LocalOptima(observation, objective, SweepYaw(observation, objective, step), max_count);
}

// Yaws that all explain a box and are a few steps of the grid apart may be found as one, with next
// to no cost between them.
TEST(LocalOptima, HaveTheTrueBodyAmongThem) {
  int bodies = 0;
  int found = 0;
  int found_nearby = 0;
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const StandingBody body(p);
      const auto optima = Optima(body.observation);
      ASSERT_FALSE(optima.empty());
      EXPECT_LT(optima.front().cost, 1e-3) << "body " << i << ", p " << p;
      bool is_found = false;
      double nearest = kPi;
      for (const UprightSolution& optimum : optima) {
        if (optimum.cost > 0.02) continue;  // a tenth of a standard deviation of each edge
        const Landmark& landmark = optimum.landmark;
        is_found = is_found || IsSameBody(landmark, body.truth, 0.02);
        nearest = std::min(nearest, AngleBetweenFronts(landmark, body.truth));
      }
      ++bodies;
      found += is_found ? 1 : 0;
      found_nearby += nearest < 3.0 * kStep ? 1 : 0;
    }
  }
  EXPECT_GE(found, bodies * 9 / 10);
  EXPECT_GE(found_nearby, bodies * 98 / 100);
}

UprightObservation NoisyObservation(double axes_weight) {
  const StandingBody body(RandomUniform(1, 2));
  UprightObservation observation = body.Observe(Disturbed(body.box, 0.03));
  observation.axes_weight = axes_weight;
  return observation;
}

Landmark RandomStart(const UprightObservation& observation) {
  std::optional<Landmark> solution;
  while (!solution) solution = SolveAtYaw(observation, RandomYaw());
  const Landmark& at_yaw = *solution;
  UprightVector parameters = UprightParameters(observation.plane_in_camera, at_yaw);
  parameters.segment<2>(1) += 0.5 * at_yaw.half_axes.maxCoeff() * RandomVector(-1, 1).head<2>();
  parameters.tail<3>() += RandomVector(-0.3, 0.3);
  return UprightLandmark(observation.plane_in_camera, parameters, at_yaw.shape_exponent);
}

TEST(LocalOptima, NoneOfManyRandomStartsIsBetter) {
  for (const double axes_weight : {0.0, 1.0}) {
    for (int i = 0; i < 20; ++i) {
      const UprightObservation observation = NoisyObservation(axes_weight);
      const YawObjective objective = BoxObjective(observation);
      const auto optima = Optima(observation);
      ASSERT_FALSE(optima.empty());
      double lowest = std::numeric_limits<double>::infinity();
      for (int start = 0; start < 100; ++start) {
        std::optional<UprightSolution> solution = UprightSolution{RandomStart(observation), 0.0};
        // Until the tangent points' depths are those of the solution.
        for (int round = 0; round < 5 && solution; ++round) {
          const Landmark& landmark = solution->landmark;
          solution = FitUpright(observation.plane_in_camera, landmark, objective.terms(landmark),
                                /*yaw_is_free=*/true);
          if (solution && !IsInFront(solution->landmark)) solution.reset();
        }
        if (solution) {
          lowest = std::min(lowest, CostAtOwnDepths(objective, solution->landmark));
        }
      }
      const double found = CostAtOwnDepths(objective, optima.front().landmark);
      EXPECT_LE(found, lowest + 0.01 + 0.02 * lowest) << "body " << i << ", " << axes_weight;
    }
  }
}

TEST(LocalOptima, AreSortedDistinctLandmarksInFrontOfTheCamera) {
  for (int i = 0; i < 50; ++i) {
    const UprightObservation observation = NoisyObservation(i % 2);
    const auto optima = Optima(observation);
    ASSERT_FALSE(optima.empty());
    for (size_t one = 0; one < optima.size(); ++one) {
      EXPECT_TRUE(IsInFront(optima[one].landmark));
      EXPECT_LE(optima[one == 0 ? 0 : one - 1].cost, optima[one].cost);
      for (size_t other = 0; other < one; ++other) {
        EXPECT_GT(AngleBetweenFronts(optima[one].landmark, optima[other].landmark), 0.5 * kDegrees);
      }
    }
  }
}

// With foot and size at their best for each yaw, no yaw nearby is better, where all tangent points
// are at the optimum's depths: several rounds settle them.
TEST(LocalOptima, AreLocalMinimaOfTheCurve) {
  int optima_seen = 0;
  for (int i = 0; i < 50; ++i) {
    const UprightObservation observation = NoisyObservation(i % 2);
    YawObjective objective = BoxObjective(observation);
    objective.rounds = 5;
    const YawSweep sweep = SweepYaw(observation, objective, kStep);
    for (const UprightSolution& optimum : LocalOptima(observation, objective, sweep, kAll)) {
      const auto terms = objective.terms(optimum.landmark);
      for (const double offset_deg : {-1.0, -0.5, 0.5, 1.0}) {
        const auto nearby =
            FitUpright(observation.plane_in_camera, Turned(optimum.landmark, offset_deg * kDegrees),
                       terms, /*yaw_is_free=*/false);
        ASSERT_TRUE(nearby);
        EXPECT_GT(nearby->cost, 0.99 * optimum.cost - 1e-2)
            << "body " << i << ", turned by " << offset_deg << " degrees";
      }
      ++optima_seen;
    }
  }
  EXPECT_GT(optima_seen, 50);
}

TEST(LocalOptima, FewAreTheBestOfAll) {
  for (int i = 0; i < 200; ++i) {
    const UprightObservation observation = NoisyObservation(i % 2);
    const auto all = Optima(observation);
    for (const size_t count : {1u, 2u}) {
      const auto few = Optima(observation, count);
      ASSERT_EQ(few.size(), std::min<size_t>(count, all.size()));
      for (size_t k = 0; k < few.size(); ++k) {
        EXPECT_NEAR(few[k].cost, all[k].cost, 1e-3) << "body " << i << ": " << k << " of " << count;
      }
    }
  }
}

TEST(LocalOptima, OfAFootprintWithEqualSidesAreEquallyGoodAfterAQuarterTurn) {
  for (const double p : {1.0, 1.1, 1.5}) {
    for (int i = 0; i < 10; ++i) {
      StandingBody body(p);
      body.truth.half_axes.y() = body.truth.half_axes.x();
      UprightObservation observation = body.Observe(*OutlineBox(TestCamera(), body.truth));
      observation.prior = PriorOf(body.truth, 0.05);
      observation.axes_weight = 1.0;
      const auto optima = Optima(observation);
      ASSERT_FALSE(optima.empty());
      const UprightSolution& best = optima.front();
      const Landmark turned = WithAxesExchanged(best.landmark);
      const auto other = std::find_if(optima.begin(), optima.end(), [&](const auto& optimum) {
        return IsSameBody(optimum.landmark, turned, 0.02);
      });
      ASSERT_NE(other, optima.end()) << "body " << i << ", p " << p;
      EXPECT_NEAR(other->cost, best.cost, 1e-3);
    }
  }
}

// A cost on top that only one yaw is spared, between the points of the grid.
TEST(LocalOptima, FollowTheExtraCostToATenthOfTheGridsStep) {
  for (int i = 0; i < 20; ++i) {
    const StandingBody body(RandomUniform(1, 2), /*ratio_log_sigma=*/0.5);
    const double yaw = RandomYaw();
    YawObjective objective = BoxObjective(body.observation);
    objective.extra_cost = [&](const Landmark& landmark) {
      const double turn = Yaw(body.plane.normal, landmark.frame_from_object.rotation) - yaw;
      return 1e4 * std::pow(std::sin(turn), 2);
    };
    const YawSweep sweep = SweepYaw(body.observation, objective, kStep);
    const auto optima = LocalOptima(body.observation, objective, sweep, kAll);
    ASSERT_FALSE(optima.empty());
    const Landmark& best = optima.front().landmark;
    EXPECT_LT(std::abs(YawDifferenceModuloPi(
                  Yaw(body.plane.normal, best.frame_from_object.rotation), yaw)),
              0.1 * kStep);
    EXPECT_GE(optima.front().cost, objective.extra_cost(best));
  }
}

TEST(CircularMinima, OfAWaveAreItsTroughsLowestFirst) {
  for (int i = 0; i < 50; ++i) {
    // Troughs at quarter, three quarters, ... of a period, lowered by their index.
    const int troughs = 2 + i % 4;
    const double phase = RandomUniform(0.0, 1.0);
    constexpr int kPoints = 240;
    std::vector<double> values;
    for (int k = 0; k < kPoints; ++k) {
      const double turn = (k + phase) / kPoints;
      values.push_back(-std::cos(2.0 * kPi * troughs * turn) + 0.1 * std::sin(2.0 * kPi * turn));
    }
    const auto minima = CircularMinima(values);
    ASSERT_EQ(minima.size(), static_cast<size_t>(troughs));
    EXPECT_EQ(values[minima.front()], *std::min_element(values.begin(), values.end()));
    for (size_t k = 1; k < minima.size(); ++k) {
      EXPECT_LE(values[minima[k - 1]], values[minima[k]]);
    }
  }
}

TEST(CircularMinima, GoRoundTheEnds) {
  EXPECT_THAT(CircularMinima({0, 1, 2, 1}), ElementsAre(0));
  EXPECT_THAT(CircularMinima({1, 2, 1, 0}), ElementsAre(3));
  EXPECT_THAT(CircularMinima({1, 0, 1, 2, 3, 2}), ElementsAre(1));
  EXPECT_THAT(CircularMinima({2, 5, 1, 5}), ElementsAre(2, 0));
}

TEST(CircularMinima, OfPlateausAreTheirFirstIndices) {
  EXPECT_THAT(CircularMinima({3, 1, 1, 1, 3, 2}), ElementsAre(1, 5));
  EXPECT_THAT(CircularMinima({1, 1, 2, 3, 1}), ElementsAre(4));  // goes round the end
  EXPECT_THAT(CircularMinima({1, 2, 3, 1, 1}), ElementsAre(3));
  EXPECT_THAT(CircularMinima({1, 2, 2, 3, 2, 2}), ElementsAre(0));  // steps on the way are none
  EXPECT_THAT(CircularMinima({1, 1, 5, 1, 5}), ElementsAre(0, 3));  // equal ones in their order
}

TEST(CircularMinima, OfAConstantIsTheFirstIndex) {
  EXPECT_THAT(CircularMinima({4}), ElementsAre(0));
  EXPECT_THAT(CircularMinima({4, 4, 4, 4}), ElementsAre(0));
  EXPECT_THAT(CircularMinima({}), IsEmpty());
}

TEST(CircularMinima, CountNaNAsHigh) {
  EXPECT_THAT(CircularMinima({kNaN, kNaN}), IsEmpty());
  EXPECT_THAT(CircularMinima({kNaN, 2, kNaN, 1, 3}), ElementsAre(3, 1));
  EXPECT_THAT(CircularMinima({2, 2, kNaN}), ElementsAre(0));
  EXPECT_THAT(CircularMinima({2, kNaN, 2}), ElementsAre(2));
  EXPECT_THAT(CircularMinima({kNaN, 3, 2, kNaN, 2, 1}), ElementsAre(5, 2));
}

// A sweep whose costs are a function of the yaw.
template <typename Cost>
YawSweep SweepOf(Cost cost, int points) {
  YawSweep sweep;
  for (int i = 0; i < points; ++i) {
    sweep.yaw.push_back(i * kPi / points);
    sweep.solutions.push_back(UprightSolution{Landmark(), cost(sweep.yaw.back())});
  }
  return sweep;
}

TEST(YawSweep, StandardDeviationOfAGaussianLikelihoodIsItsSigma) {
  for (int i = 0; i < 50; ++i) {
    const double sigma = RandomUniform(2.0, 10.0) * kDegrees;
    const double mean = RandomYaw();  // also where the grid goes round
    const double offset = RandomUniform(-1e4, 1e4);
    const auto cost = [&](double yaw) {
      return offset + 0.5 * std::pow(YawDifferenceModuloPi(yaw, mean) / sigma, 2);
    };
    const YawSweep sweep = SweepOf(cost, 360);
    EXPECT_NEAR(sweep.StandardDeviation({{mean, offset}}), sigma, 0.02 * sigma);
    EXPECT_NEAR(sweep.StandardDeviation({{mean + kPi, offset}}), sigma, 0.02 * sigma);
    // About another yaw, the way there counts too.
    const double away = mean + RandomUniform(-0.3, 0.3);
    EXPECT_NEAR(sweep.StandardDeviation({{away, cost(away)}}),
                std::hypot(sigma, YawDifferenceModuloPi(away, mean)), 0.01);
  }
}

// However narrow: it is not the distance to the nearest yaw of the grid.
TEST(YawSweep, StandardDeviationOfAPeakBetweenTwoYawsOfTheGrid) {
  for (int i = 0; i < 50; ++i) {
    const double sigma = RandomUniform(0.1, 0.5) * kDegrees;
    const double mean = RandomYaw();
    const YawSweep sweep = SweepOf(
        [&](double yaw) { return 0.5 * std::pow(YawDifferenceModuloPi(yaw, mean) / sigma, 2); },
        60);
    EXPECT_NEAR(sweep.StandardDeviation({{mean, 0.0}}), sigma, 0.05 * sigma);
  }
}

// The same body called by its other horizontal axis: two equal peaks a quarter turn apart.
TEST(YawSweep, StandardDeviationOfAQuarterTurnAmbiguity) {
  for (int i = 0; i < 50; ++i) {
    const double sigma = RandomUniform(0.3, 3.0) * kDegrees;
    const double mean = RandomYaw();
    const double other = mean + 0.5 * kPi;
    const YawSweep sweep = SweepOf(
        [&](double yaw) {
          const auto squared = [&](double peak) {
            return 0.5 * std::pow(YawDifferenceModuloPi(yaw, peak) / sigma, 2);
          };
          return std::min(squared(mean), squared(other));
        },
        60);
    const double expected = 0.5 * kPi / std::sqrt(2.0);
    EXPECT_NEAR(sweep.StandardDeviation({{mean, 0.0}, {other, 0.0}}), expected, 0.06 * expected);
  }
}

TEST(YawSweep, StandardDeviationOfAnyYawIsThatOfAUniformDistribution) {
  const YawSweep sweep = SweepOf([](double) { return 3.0; }, 1800);
  for (int i = 0; i < 20; ++i) {
    EXPECT_NEAR(sweep.StandardDeviation({{RandomYaw(), 3.0}}), kPi / std::sqrt(12.0), 2e-3);
  }
}

TEST(YawSweep, StandardDeviationLeavesOutYawsWithoutALandmark) {
  // Nothing but 20 degrees around the mean, and 10 degrees further on.
  YawSweep sweep = SweepOf([](double) { return 1.0; }, 1800);
  const double mean = 80.05 * kDegrees;
  const auto leave_out = [&](double from, double to) {
    for (size_t i = 0; i < sweep.yaw.size(); ++i) {
      const double distance = (sweep.yaw[i] - mean) / kDegrees;
      if (distance > from && distance < to) sweep.solutions[i].reset();
    }
  };
  leave_out(-90, -10);
  leave_out(20, 101);
  EXPECT_NEAR(sweep.StandardDeviation({{mean, 1.0}}), std::sqrt(9000.0 / 3.0 / 30.0) * kDegrees,
              1e-3);
  leave_out(10, 20);
  EXPECT_NEAR(sweep.StandardDeviation({{mean, 1.0}}), 20.0 * kDegrees / std::sqrt(12.0), 1e-3);
}

TEST(WorldAxisInCamera, IsTheWorldsXOrOnWallsThatFaceItY) {
  Sequence sequence = LevelSequence({{300, 250, 340, 300}});
  const Detection& detection = sequence.detections.front();
  for (int i = 0; i < 20; ++i) {
    sequence.frames.front().world_from_camera = RandomRigid();
    const Eigen::Quaterniond camera_from_world =
        sequence.frames.front().world_from_camera.rotation.conjugate();
    sequence.planes = {{0, {Eigen::Vector3d::UnitZ(), RandomUniform(-1, 1)}}};
    EXPECT_LT(
        (WorldAxisInCamera(sequence, detection) - camera_from_world * Eigen::Vector3d::UnitX())
            .norm(),
        1e-12);
    sequence.planes = {{0, {-Eigen::Vector3d::UnitX(), RandomUniform(-1, 1)}}};
    EXPECT_LT(
        (WorldAxisInCamera(sequence, detection) - camera_from_world * Eigen::Vector3d::UnitY())
            .norm(),
        1e-12);
    const Eigen::Vector3d normal = RandomDirection();
    sequence.planes = {{0, {normal, 0.0}}};
    const Eigen::Vector3d axis = WorldAxisInCamera(sequence, detection);
    EXPECT_NEAR(axis.norm(), 1.0, 1e-12);
    EXPECT_NEAR(axis.dot(camera_from_world * normal), 0.0, 1e-12);
  }
}

TEST(MakeUprightObservation, IsWhatTheSequenceAndTheOptionsSay) {
  Sequence sequence = LevelSequence({{300, 250, 400, 300}});
  sequence.planes = {{0, {Eigen::Vector3d::UnitZ(), 0.0}}};
  Detection& detection = sequence.detections.front();
  detection.is_bound = {false, true, false, false};
  UprightOptions options;
  options.detection_sigma_fraction = 0.1;
  options.axes_weight = 2.5;
  const ShapePrior prior{{0.5, 0.7}, {0.1, 0.2}, 1.3};
  const UprightObservation observation =
      MakeUprightObservation(sequence, detection, prior, options);
  EXPECT_EQ(observation.camera.fx, 500.0);
  EXPECT_EQ(observation.plane_in_camera.normal, -Eigen::Vector3d::UnitY());
  EXPECT_EQ(observation.prior.ratio, prior.ratio);
  EXPECT_EQ(observation.prior.log_sigma, prior.log_sigma);
  EXPECT_EQ(observation.prior.shape_exponent, 1.3);
  EXPECT_EQ(observation.axes_weight, 2.5);
  EXPECT_EQ(observation.world_axis_in_camera, WorldAxisInCamera(sequence, detection));
  for (size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(observation.edges[i].is_bound, i == 1);
    EXPECT_DOUBLE_EQ(observation.edges[i].sigma_px, i % 2 == 0 ? 10.0 : 5.0);
  }
}

}  // namespace
}  // namespace soslam
