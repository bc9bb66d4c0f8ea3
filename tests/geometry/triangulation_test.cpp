// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/geometry/triangulation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace soslam {
namespace {

const Camera kTriangulationCamera = {640, 480, 500.0, 510.0, 319.5, 239.5};

// Cameras along a line, turned at random, and the exact pixels of a point.
std::vector<PointView> ViewsAlongALine(const Eigen::Vector3d& point_in_world, int count) {
  std::vector<PointView> views;
  for (int i = 0; i < count; ++i) {
    const Rigid3d world_from_camera = {ExpRotation(RandomVector(-0.1, 0.1)),
                                       Eigen::Vector3d(0.3 * i - 0.15 * (count - 1), 0.0, 0.0)};
    const Rigid3d camera_from_world = world_from_camera.Inverse();
    views.push_back({kTriangulationCamera, camera_from_world,
                     *kTriangulationCamera.Project(camera_from_world * point_in_world)});
  }
  return views;
}

Eigen::Vector3d PointInView() { return {RandomUniform(-1, 1), RandomUniform(-1, 1), 4.0}; }

void AddNoise(double sigma_px, std::vector<PointView>* views) {
  std::normal_distribution<double> noise(0.0, sigma_px);
  for (PointView& view : *views) {
    view.pixel += Eigen::Vector2d(noise(TestRandom()), noise(TestRandom()));
  }
}

TEST(TriangulateTest, FindsThePointOfExactPixels) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d truth = PointInView();
    const auto point = Triangulate(ViewsAlongALine(truth, 2 + i % 5), 1.0);
    ASSERT_TRUE(point);
    EXPECT_LT((point->position_in_world - truth).norm(), 1e-8);
    EXPECT_LT(point->mean_error_px, 1e-6);
  }
}

// The squared error over its covariance has a mean of 3, its degrees of freedom, and a standard
// deviation of sqrt(6 / 2000) = 0.055 over all trials.
TEST(TriangulateTest, ErrorsAreThoseOfTheCovariance) {
  constexpr int kTrials = 2000;
  constexpr double kSigmaPx = 0.5;
  double sum = 0.0;
  for (int i = 0; i < kTrials; ++i) {
    const Eigen::Vector3d truth = PointInView();
    std::vector<PointView> views = ViewsAlongALine(truth, 5);
    AddNoise(kSigmaPx, &views);
    const auto point = Triangulate(views, 1e6);
    ASSERT_TRUE(point);
    const Eigen::Vector3d error = point->position_in_world - truth;
    sum += error.dot((kSigmaPx * kSigmaPx * point->covariance).inverse() * error);
  }
  EXPECT_NEAR(sum / kTrials, 3.0, 0.25);
}

TEST(TriangulateTest, OneWrongPixelHardlyMovesThePoint) {
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d truth = PointInView();
    std::vector<PointView> views = ViewsAlongALine(truth, 9);
    AddNoise(0.1, &views);
    views[static_cast<size_t>(i) % 9].pixel.y() += 40.0;
    const auto robust = Triangulate(views, 0.3);
    const auto squares = Triangulate(views, 1e6);
    ASSERT_TRUE(robust && squares);
    const auto error = [&](const auto& point) { return (point->position_in_world - truth).norm(); };
    EXPECT_LT(error(robust), 0.2 * error(squares));
  }
}

TEST(TriangulateTest, NothingWithoutParallax) {
  const Eigen::Vector3d truth(0.2, 0.1, 4.0);
  std::vector<PointView> views = ViewsAlongALine(truth, 1);
  EXPECT_FALSE(Triangulate(views, 1.0));
  views.push_back(views.front());
  EXPECT_FALSE(Triangulate(views, 1.0));
}

// Rays that part meet behind the cameras.
TEST(TriangulateTest, NothingBehindTheCameras) {
  std::vector<PointView> views = ViewsAlongALine({0.0, 0.0, 4.0}, 2);
  for (PointView& view : views) {
    const Eigen::Vector3d in_camera = view.camera_from_world * Eigen::Vector3d(0.0, 0.0, -4.0);
    view.pixel = *kTriangulationCamera.Project(-in_camera);
  }
  EXPECT_FALSE(Triangulate(views, 1.0));
}

TEST(ReprojectionErrorTest, IsADistanceInPixels) {
  std::vector<PointView> views = ViewsAlongALine({0.0, 0.0, 4.0}, 1);
  views[0].pixel += Eigen::Vector2d(3.0, -4.0);
  EXPECT_NEAR(ReprojectionError(views[0], {0.0, 0.0, 4.0}), 5.0, 1e-9);
  EXPECT_TRUE(std::isinf(ReprojectionError(views[0], {0.0, 0.0, -4.0})));
}

TEST(LargestAngleTest, IsThatOfTheOutermostCameras) {
  const Eigen::Vector3d point(0.0, 0.0, 4.0), left(-0.3, 0.0, 0.0), right(0.3, 0.0, 0.0);
  EXPECT_NEAR(LargestAngle({left, Eigen::Vector3d::Zero(), right}, point),
              2.0 * std::atan(0.3 / 4.0), 1e-9);
  EXPECT_EQ(LargestAngle({left}, point), 0.0);
}

}  // namespace
}  // namespace soslam
