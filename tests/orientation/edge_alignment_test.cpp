// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/edge_alignment.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "soslam/initialisation/upright.h"
#include "support/drawn_cuboids.h"
#include "support/facing_view.h"
#include "support/landmark_costs.h"

namespace soslam {
namespace {

const Plane kFloor{Eigen::Vector3d(0.05, -1.0, -0.3).normalized(), 1.0};

Landmark Cuboid(double yaw) {
  return StandingCuboid(TestCamera(), kFloor, {310, 320}, yaw, {0.4, 0.25, 0.3});
}

std::shared_ptr<const EdgeImage> ImageOf(const Landmark& landmark,
                                         const std::vector<Box>& nearer_boxes = {}) {
  return std::make_shared<const EdgeImage>(
      EdgeImage{std::make_shared<const FrameEdges>(
                    ComputeEdgeMaps(DrawCuboids(TestCamera(), {landmark}), EdgesOptions())),
                *OutlineBox(TestCamera(), landmark), nearer_boxes});
}

// With the points that do not count.
double TwiceTheCost(const EdgeCost& term, const Landmark& landmark) {
  return 2.0 * (term.Value(landmark) + term.ConstantCost());
}

// What all points cost together when none is near an edge.
double LargestCost(const Box& box, const EdgeOptions& options) {
  return 2.0 * (box.Width() + box.Height()) / options.edge_correlation_px *
         std::pow(options.edge_truncation_px / options.edge_sigma_px, 2);
}

// The mean distance (px) between the points of two landmarks.
double MeanMotion(const Landmark& one, const Landmark& other) {
  double sum = 0.0;
  const auto points = VisibleModelPoints(TestCamera(), one, 4.0);
  for (const ModelPoint& point : points) {
    const auto pixel = [&](const Landmark& landmark) {
      return *TestCamera().Project(landmark.frame_from_object *
                                   landmark.half_axes.cwiseProduct(point.in_unit_body));
    };
    sum += (pixel(other) - pixel(one)).norm();
  }
  return sum / static_cast<double>(points.size());
}

TEST(EdgeCost, IsLeastWhereTheEdgesOfTheBodyAreThoseOfTheImage) {
  for (const double yaw : {0.3, 1.0, -0.8}) {
    const Landmark truth = Cuboid(yaw);
    const auto image = ImageOf(truth);
    const EdgeCost term(image, TestCamera(), truth, EdgeOptions());
    const double largest = LargestCost(image->box, EdgeOptions());
    const double at_truth = TwiceTheCost(term, truth);
    // Edges are found to half a pixel, and none at the corners: (0.5 / 8)^2 and a few points.
    EXPECT_LT(at_truth, 0.05 * largest) << yaw;
    EXPECT_NEAR(term.Support(truth), 1.0 - at_truth / largest, 1e-12);
    const UprightVector parameters = UprightParametrisation(kFloor).ComputeParameters(truth);
    for (int i = 0; i < 6; ++i) {
      for (const double direction : {-1.0, 1.0}) {
        const auto moved = [&](double step) {
          UprightVector at = parameters;
          at(i) += direction * step;
          return UprightParametrisation(kFloor).LandmarkAt(at, kCuboidExponent);
        };
        const double step = 4.0 * 1e-4 / MeanMotion(truth, moved(1e-4));  // 4 px on average
        EXPECT_GT(TwiceTheCost(term, moved(step)), at_truth + 0.05 * largest)
            << "yaw " << yaw << ", parameter " << i << ", direction " << direction;
      }
    }
  }
}

TEST(EdgeCost, IsBounded) {
  const Landmark truth = Cuboid(0.3);
  const auto image = ImageOf(truth);
  const EdgeCost term(image, TestCamera(), truth, EdgeOptions());
  const double largest = LargestCost(image->box, EdgeOptions());
  for (int i = 0; i < 100; ++i) {
    Landmark landmark = RandomLandmarkInCamera();
    landmark.frame_from_object.translation += RandomVector(-3.0, 3.0);  // also out of the image
    const double cost = TwiceTheCost(term, landmark);
    EXPECT_LE(cost, largest * (1.0 + 1e-12));
    EXPECT_NEAR(term.Support(landmark), 1.0 - cost / largest, 1e-12);
  }
  Landmark behind = truth;
  behind.frame_from_object.translation.z() = -3.0;
  EXPECT_NEAR(TwiceTheCost(term, behind), largest, 1e-9);
  EXPECT_NEAR(term.Support(behind), 0.0, 1e-12);
  LandmarkModel model;
  term.AddTo(behind, &model);
  EXPECT_NEAR(model.cost, term.Value(behind), 1e-9);
  EXPECT_EQ(model.gradient.norm(), 0.0);
  EXPECT_EQ(model.information.norm(), 0.0);
  // A body that no point of is in front of the camera has no edge in the image.
  const EdgeCost of_none(image, TestCamera(), behind, EdgeOptions());
  EXPECT_EQ(of_none.NumPoints(), 0);
  EXPECT_NEAR(2.0 * of_none.ConstantCost(), largest, 1e-9);
  EXPECT_NEAR(of_none.Support(behind), 0.0, 1e-12);
}

EdgeOptions AnyDirection() {
  EdgeOptions options;
  options.edge_direction_tolerance_deg = 90.0;
  return options;
}

TEST(EdgeCost, PointsInNearerBoxesAndOutsideTheImageCostAsMuchAsCanBe) {
  const Camera camera = TestCamera();
  const Box half{0, 0, 310, 480};
  const EdgeOptions options = AnyDirection();
  for (const double right : {0.0, 1.0}) {
    Landmark truth = Cuboid(0.3);
    truth.frame_from_object.translation.x() += right;
    const auto image = ImageOf(truth, {half});
    const auto points = VisibleModelPoints(camera, truth, options.edge_spacing_px);
    const auto visible = std::ranges::count_if(points, [&](const ModelPoint& point) {
      const Eigen::Vector2d pixel = *camera.Project(
          truth.frame_from_object * truth.half_axes.cwiseProduct(point.in_unit_body));
      return pixel.x() > 310.0 && pixel.x() <= camera.width - 1.0;
    });
    ASSERT_GT(visible, 0);
    const EdgeCost term(image, camera, truth, options);
    EXPECT_EQ(term.NumPoints(), visible);
    const double share = 1.0 - static_cast<double>(visible) / static_cast<double>(points.size());
    EXPECT_NEAR(2.0 * term.ConstantCost(), share * LargestCost(image->box, options), 1e-9);
  }
}

// A distance in steps that single precision holds exactly.
float SmallDistance(int x, int y) { return 4.0F + static_cast<float>(2 * x + y) / 128.0F; }

std::shared_ptr<const EdgeImage> ImageOf(const EdgeMaps& maps) {
  return std::make_shared<const EdgeImage>(
      EdgeImage{std::make_shared<const FrameEdges>(maps), {200, 150, 400, 330}, {}});
}

// A cuboid in front of a camera anywhere, all of it in the image.
RandomView CuboidView() {
  for (;;) {
    RandomView view;
    view.landmark_in_world.shape_exponents = kCuboidExponent;
    const auto box = OutlineBox(TestCamera(), view.LandmarkInCamera());
    if (box && DistanceToBorder(*box, 640, 480) > 2.0) return view;
  }
}

TEST(EdgeCost, DerivativesAgreeWithNumbers) {
  const auto image = ImageOf(LinearMaps(SmallDistance));
  for (int i = 0; i < 10; ++i) {
    const Landmark landmark = CuboidView().LandmarkInCamera();
    const EdgeCost term(image, TestCamera(), landmark, AnyDirection());
    ASSERT_GT(term.NumPoints(), 32);
    ExpectCorrectGradient(term, landmark);
  }
}

// Seen from right in front, all edges of a cuboid are vertical or horizontal in the image: of a
// vertical image edge everywhere, the latter are as far away as can be.
TEST(EdgeCost, EdgesInAnotherDirectionCountAsFarAway) {
  EdgeMaps maps = LinearMaps(SmallDistance);
  maps.distance = cv::Scalar(0.0);
  const auto image = ImageOf(maps);
  const Landmark landmark{{{1, 0, 0, 0}, {0, 0, 3}}, {0.5, 0.4, 0.3}, kCuboidExponent};
  const EdgeCost term(image, TestCamera(), landmark, EdgeOptions());
  const auto points = VisibleModelPoints(TestCamera(), landmark, EdgeOptions().edge_spacing_px);
  const auto vertical = std::ranges::count_if(
      points, [](const ModelPoint& point) { return std::abs(point.along.y()) > 0.5; });
  EXPECT_EQ(term.NumPoints(), vertical);
  EXPECT_NEAR(term.Value(landmark), 0.0, 1e-12);
  const double share = 1.0 - static_cast<double>(vertical) / static_cast<double>(points.size());
  EXPECT_NEAR(2.0 * term.ConstantCost(), share * LargestCost(image->box, EdgeOptions()), 1e-9);
  const EdgeCost of_any_direction(image, TestCamera(), landmark, AnyDirection());
  EXPECT_EQ(of_any_direction.NumPoints(), static_cast<int>(points.size()));
}

}  // namespace
}  // namespace soslam
