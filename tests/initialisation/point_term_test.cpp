// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/point_term.h"

#include <gtest/gtest.h>

#include <cmath>

#include "constraints/surface_distance.h"
#include "support/landmark_costs.h"
#include "support/random.h"

namespace soslam {
namespace {

Landmark BodyInCamera(double shape_exponent) {
  Landmark body{RandomRigid(), RandomVector(0.3, 0.8), shape_exponent};
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

TEST(PointTermTest, GradientAgreesWithNumbers) {
  for (int i = 0; i < 20; ++i) {
    const Landmark body = BodyInCamera(RandomUniform(1.2, 2.0));
    const PointTerm term(RandomPoints(body, 30), body, {}, 0.3);
    ExpectCorrectGradient(term, Moved(body, 0.02 * LandmarkModel::Vector::Random()));
  }
}

TEST(PointTermTest, CostsNothingWherePointsAreOnTheSurfaceAndElsewhereSomething) {
  const Landmark cuboid = BodyInCamera(kCuboidExponent);
  const PointTerm term(PointsOnFaces(cuboid, 60), cuboid, {}, 1.0);
  EXPECT_NEAR(term.Value(cuboid), 0.0, 1e-9);
  for (int i = 0; i < 50; ++i) {
    const Landmark moved = Moved(cuboid, 0.05 * LandmarkModel::Vector::Random());
    EXPECT_GT(term.Value(moved), 0.01);
  }
}

// With the weight, all costs are multiplied.
TEST(PointTermTest, IsProportionalToItsWeight) {
  const Landmark body = BodyInCamera(1.5);
  const std::vector<ObjectPoint> points = RandomPoints(body, 20);
  const double one = PointTerm(points, body, {}, 1.0).Value(body);
  EXPECT_NEAR(PointTerm(points, body, {}, 0.25).Value(body), 0.25 * one, 1e-12);
}

// exp(-cost) of a point along a line through a face is a density up to a constant: with a prior of
// nearly one and without outliers, half of the surface's mass outside is narrow.
TEST(PointTermTest, SurfaceDensityHasItsWidth) {
  Landmark cuboid{{}, {1.0, 1.0, 1.0}, kCuboidExponent};
  cuboid.frame_from_object.translation.z() = 10.0;
  PointOptions options;
  options.point_range_fraction = 0.0;
  const double sigma = options.point_sigma_fraction * 2.0;
  const auto cost = [&](double distance) {
    const ObjectPoint point{{1.0 + distance, 0.0, 10.0}, Eigen::Matrix3d::Zero(), 1.0 - 1e-12};
    return PointTerm({point}, cuboid, options, 1.0).Value(cuboid);
  };
  EXPECT_NEAR(cost(sigma), 0.5, 1e-6);
  EXPECT_NEAR(cost(2.0 * sigma), 2.0, 1e-6);
  EXPECT_LT(cost(-2.0 * sigma), 2.0);  // parts may lie inside the shape
}

// The cost of what is far away is bounded outside, by the background, and higher inside, where only
// outliers are.
TEST(PointTermTest, ABodyIsOpaque) {
  Landmark cuboid{{}, {1.0, 1.0, 1.0}, kCuboidExponent};
  cuboid.frame_from_object.translation.z() = 10.0;
  PointOptions options;
  options.point_roughness_fraction = 0.1;
  options.point_range_fraction = 0.0;
  const auto cost = [&](double x) {
    const ObjectPoint point{{x, 0.0, 10.0}, Eigen::Matrix3d::Zero(), 0.1};
    return PointTerm({point}, cuboid, options, 1.0).Value(cuboid);
  };
  EXPECT_NEAR(cost(5.0), cost(50.0), 1e-9);
  EXPECT_GT(cost(0.01), cost(50.0) + 1.0);
}

// A fit of points on the faces of a cuboid with as many of the background comes back from a
// disturbed start.
TEST(PointTermTest, PointsDetermineACuboid) {
  for (int i = 0; i < 5; ++i) {
    const Landmark truth = BodyInCamera(kCuboidExponent);
    std::vector<ObjectPoint> points = PointsOnFaces(truth, 150);
    while (points.size() < 300) {
      const Eigen::Vector3d point = truth.Centre() + RandomVector(-3.0, 3.0);
      if (SurfaceDistance(truth, point, nullptr) > 0.0) points.push_back({point});
    }
    Landmark landmark = Moved(truth, 0.03 * LandmarkModel::Vector::Random());
    const PointTerm term(points, landmark, {}, 1.0);
    for (int step = 0; step < 50; ++step) {
      LandmarkModel model;
      term.AddTo(landmark, &model);
      landmark = Moved(landmark, -model.information.ldlt().solve(model.gradient));
    }
    EXPECT_LT((landmark.Centre() - truth.Centre()).norm(), 0.02);
    EXPECT_LT((landmark.half_axes - truth.half_axes).norm(), 0.04);
  }
}

}  // namespace
}  // namespace soslam
