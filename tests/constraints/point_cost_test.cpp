// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/point_cost.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "soslam/constraints/surface_distance.h"
#include "support/landmark_costs.h"
#include "support/random.h"

namespace soslam {
namespace {

Landmark BodyInCamera(const ShapeExponents& shape_exponents) {
  Landmark body{RandomRigid(), RandomVector(0.3, 0.8), shape_exponents};
  body.frame_from_object.translation = {0.2, -0.1, 4.0};
  return body;
}

std::vector<ObjectPoint> RandomPoints(const Landmark& around, int count) {
  std::vector<ObjectPoint> points;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d position = around.Centre() + RandomVector(-1.2, 1.2);
    points.push_back(
        {position, Eigen::Vector3d(1e-4, 2e-4, 9e-4).asDiagonal(), RandomUniform(0.05, 0.7)});
  }
  return points;
}

// Points on the faces of a cuboid.
std::vector<ObjectPoint> PointsOnFaces(const Landmark& cuboid, int count) {
  std::vector<ObjectPoint> points;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d in_object = cuboid.half_axes.cwiseProduct(RandomVector(-1.0, 1.0));
    in_object[i % 3] = std::copysign(cuboid.half_axes[i % 3], in_object[i % 3]);
    points.push_back({cuboid.frame_from_object * in_object, 1e-6 * Eigen::Matrix3d::Identity()});
  }
  return points;
}

TEST(PointCostTest, GradientAgreesWithNumbers) {
  for (int i = 0; i < 20; ++i) {
    const Landmark body = BodyInCamera(RandomUniform(1.2, 2.0));
    const PointCost term(RandomPoints(body, 30), body, SizeForPoints(body), {}, 0.3);
    ExpectCorrectGradient(term, ApplyStep(body, 0.02 * LandmarkModel::Vector::Random()));
  }
}

TEST(PointCostTest, ConvergesSlowlyAlsoInAnotherView) {
  const Landmark body = BodyInCamera(kCuboidExponent);
  const auto points = [&] {
    return std::make_unique<PointCost>(RandomPoints(body, 3), body, SizeForPoints(body),
                                       PointOptions(), 1.0);
  };
  LandmarkCosts costs;
  const double without_points = NegligibleDecrease(costs);
  costs.push_back(points());
  const double with_points = NegligibleDecrease(costs);
  EXPECT_GT(with_points, without_points);
  costs.front() = std::make_unique<ViewCost>(points(), RandomRigid(), 0.5);
  EXPECT_EQ(NegligibleDecrease(costs), with_points);
}

TEST(PointCostTest, CostsNothingWherePointsAreOnTheSurfaceAndElsewhereSomething) {
  const Landmark cuboid = BodyInCamera(kCuboidExponent);
  const PointCost term(PointsOnFaces(cuboid, 60), cuboid, SizeForPoints(cuboid), {}, 1.0);
  EXPECT_NEAR(term.Value(cuboid), 0.0, 1e-9);
  for (int i = 0; i < 50; ++i) {
    const Landmark moved = ApplyStep(cuboid, 0.05 * LandmarkModel::Vector::Random());
    EXPECT_GT(term.Value(moved), 0.01);
  }
}

// A point 4 m in front of the camera, and a body at this signed distance (m) from it, which is deep
// enough for all widths.
struct PointAndBody {
  ObjectPoint point;
  Landmark body;
};
PointAndBody AtDistance(double distance, double prior) {
  constexpr double kHalfAxisM = 10.0;
  Landmark cuboid{{}, Eigen::Vector3d::Constant(kHalfAxisM), kCuboidExponent};
  cuboid.frame_from_object.translation = {-kHalfAxisM - distance, 0.0, 4.0};
  return {{{0.0, 0.0, 4.0}, Eigen::Matrix3d::Zero(), prior}, cuboid};
}

// The cost of that point, of an object of this size (m).
double CostAtDistance(double distance, double prior, double size_m, const PointOptions& options) {
  const auto [point, cuboid] = AtDistance(distance, prior);
  return PointCost({point}, cuboid, size_m, options, 1.0).Value(cuboid);
}

// Where all points inside may be outliers, the background has one density (1 - p) / size
// everywhere, and what is above it is of the object: p in all.
TEST(PointCostTest, SurfaceDensityHasTheMassOfThePrior) {
  PointOptions options;
  options.point_outlier_probability = 1.0;
  constexpr double kStepM = 1e-3;
  for (const double size_m : {0.3, 1.0}) {
    for (const double prior : {0.05, 0.3, 0.7}) {
      const double far = CostAtDistance(9.0, prior, size_m, options);
      double mass = 0.0;
      for (double distance = -4.0; distance < 4.0; distance += kStepM) {
        const double ratio = std::exp(far - CostAtDistance(distance, prior, size_m, options));
        mass += kStepM * (ratio - 1.0) * (1.0 - prior) / size_m;
      }
      EXPECT_NEAR(mass, prior, 0.01 * prior);
    }
  }
}

// Where the background has one density everywhere, costs say how much likelier a point is than one
// of the background far away: by one over the probability that it is of the background.
TEST(PointCostTest, ResponsibilitiesArePosteriorProbabilities) {
  PointOptions options;
  options.point_outlier_probability = 1.0;
  for (const double prior : {0.05, 0.3, 0.7}) {
    const double far = CostAtDistance(9.0, prior, 1.0, options);
    for (const double distance : {-1.0, -0.3, -0.05, 0.0, 0.05, 0.2, 9.0}) {
      auto [point, cuboid] = AtDistance(distance, prior);
      point.index = 7;
      const auto posteriors = PointCost({point}, cuboid, 1.0, options, 0.5).Posteriors(cuboid);
      ASSERT_EQ(posteriors.size(), 1u);
      EXPECT_EQ(posteriors[0].point, 7);
      EXPECT_NEAR(posteriors[0].distance, distance, 1e-9);
      EXPECT_NEAR(posteriors[0].responsibility,
                  1.0 - std::exp(CostAtDistance(distance, prior, 1.0, options) - far), 1e-9);
    }
  }
}

// The derivatives of the cost by the distance.
struct Derivatives {
  double first;
  double information;
};
Derivatives DerivativesAtDistance(double distance, double prior, const PointOptions& options,
                                  PointCost::SecondDerivatives second_derivatives) {
  const auto [point, cuboid] = AtDistance(distance, prior);
  LandmarkModel model;
  PointCost({point}, cuboid, 1.0, options, 1.0, second_derivatives).AddTo(cuboid, &model);
  // The parameter is the x of the centre, which moves along the normal.
  return {model.gradient[3], model.information(3, 3)};
}

// The mean over all points of the object and of what is near it, each as often as its density says,
// is that of the squares of the derivative, as it is for any density. Steps of the solver take for
// known which points are of the object, so that theirs is more.
TEST(PointCostTest, CovariancesHaveTheFisherInformation) {
  using enum PointCost::SecondDerivatives;
  constexpr double kStepM = 2e-3;
  PointOptions options;
  options.point_range_fraction = 0.0;
  for (const double prior : {0.05, 0.3, 0.7}) {
    double squares = 0.0, information = 0.0, for_steps = 0.0;
    for (double distance = -2.0; distance < 1.0; distance += kStepM) {
      const double density = std::exp(-CostAtDistance(distance, prior, 1.0, options));
      const auto [first, fisher] =
          DerivativesAtDistance(distance, prior, options, kFisherInformation);
      squares += density * first * first;
      information += density * fisher;
      for_steps +=
          density * DerivativesAtDistance(distance, prior, options, kMaximisation).information;
    }
    EXPECT_NEAR(information, squares, 0.01 * squares);
    EXPECT_GT(for_steps, 1.2 * squares);
  }
}

// With outliers that are inside.
TEST(PointCostTest, ResponsibilitiesAreContinuousAndVanishFarAway) {
  const auto responsibility = [](double distance) {
    const auto [point, cuboid] = AtDistance(distance, 0.5);
    return PointCost({point}, cuboid, 1.0, {}, 1.0).Posteriors(cuboid)[0].responsibility;
  };
  EXPECT_NEAR(responsibility(-1e-9), responsibility(1e-9), 1e-6);
  EXPECT_GT(responsibility(0.0), 0.5);
  EXPECT_LT(responsibility(5.0), 1e-9);
  EXPECT_LT(responsibility(-5.0), 1e-9);
}

// With the default options: what is swallowed costs more than what is left outside if it is deep
// or its prior is low. Points of the rough inside of an object are otherwise as likely there.
TEST(PointCostTest, SwallowedPointsCostSomethingIfTheyAreDeepOrUnlikely) {
  const auto excess = [&](double depth, double prior) {
    return CostAtDistance(-depth, prior, 1.0, {}) - CostAtDistance(5.0, prior, 1.0, {});
  };
  EXPECT_GT(excess(0.3, 0.3), 0.1);
  EXPECT_LT(excess(0.3, 0.6), -0.1);
  EXPECT_GT(excess(0.5, 0.5), 0.1);
  EXPECT_GT(excess(0.8, 0.7), 0.1);
}

// The constant of a point does not depend on the landmark that the term starts at.
TEST(PointCostTest, CostsWithOneSizeCanBeCompared) {
  Landmark body = BodyInCamera(kCuboidExponent);
  const ObjectPoint far{body.Centre() + Eigen::Vector3d(50.0, 0.0, 0.0),
                        Eigen::Vector3d(1e-4, 1e-2, 1.0).asDiagonal(), 0.5};
  const double cost = PointCost({far}, body, 1.0, {}, 1.0).Value(body);
  for (int i = 0; i < 20; ++i) {
    const Landmark other = BodyInCamera(RandomUniform(1.2, 2.0));
    EXPECT_NEAR(PointCost({far}, other, 1.0, {}, 1.0).Value(other), cost, 1e-9);
  }
}

}  // namespace
}  // namespace soslam
