// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/constraints/quadric_constraints.h"
#include "support/jacobians.h"
#include "support/random_scene.h"

namespace soslam {
namespace {

Eigen::Vector4d Residuals(const DetectionResidual& residual, const RandomView& view) {
  return ResidualsAt(residual, {view.camera_block.data(), view.landmark_block.data()});
}

TEST(DetectionResidual, IsZeroForTheOutlineBox) {
  for (int i = 0; i < 100; ++i) {
    const RandomView view;
    const auto box = OutlineBox(TestCamera(), view.LandmarkInCamera());
    ASSERT_TRUE(box);
    EXPECT_LT(Residuals(DetectionResidual(TestCamera(), *box, 1.0), view).cwiseAbs().maxCoeff(),
              1e-9);
  }
}

// A unit sphere 2 m ahead; the left edge through the principal point: the plane x = 0 is 0 from the
// centre, so the residual is 1^2 - 0^2. The right edge at infinity: the plane z = 0, 1^2 - 2^2 =
// -3.
TEST(DetectionResidual, WorkedByHand) {
  RandomView view;
  view.world_from_camera = Rigid3d();
  view.landmark_in_world = {{Eigen::Quaterniond::Identity(), {0, 0, 2}}, {1, 1, 1}};
  view.Move(Rigid3d());
  const Camera camera{640, 480, 500, 500, 320, 240};
  const Box box{320, 240, 320 + 500e9, 240 + 500e9};
  const Eigen::Vector4d residuals = Residuals(DetectionResidual(camera, box, 4.0), view);
  EXPECT_TRUE(residuals.isApprox(Eigen::Vector4d(1, 1, -3, -3) / 2.0, 1e-6)) << residuals;
}

TEST(DetectionResidual, EqualsTheDualQuadricForm) {
  const RandomView view;
  const Box box{100, 120, 400, 350};
  const Eigen::Vector4d residuals = Residuals(DetectionResidual(TestCamera(), box, 4.0), view);
  const Eigen::Matrix4d dual_quadric = DualQuadric(view.landmark_in_world);
  const Eigen::Matrix<double, 3, 4> projection =
      TestCamera().Intrinsics() * view.world_from_camera.Inverse().Matrix().topRows<3>();
  const auto lines = box.EdgeLines();
  for (size_t i = 0; i < 4; ++i) {
    Eigen::Vector4d plane = projection.transpose() * lines[i];
    plane /= plane.head<3>().norm();
    EXPECT_NEAR(residuals(static_cast<int>(i)), plane.dot(dual_quadric * plane) / 2.0, 1e-9);
  }
}

TEST(DetectionResidual, JacobiansAgreeWithNumbers) {
  for (int i = 0; i < 50; ++i) {
    const RandomView view;
    const DetectionResidual residual(TestCamera(), {150, 100, 420, 390}, 0.3);
    ExpectCorrectJacobians(residual, {view.camera_block.data(), view.landmark_block.data()});
  }
}

TEST(DetectionResidual, RefusesHalfAxesBeyondNumbers) {
  RandomView view;
  view.landmark_block[8] = 1000.0;  // a logarithm
  const DetectionResidual residual(TestCamera(), {150, 100, 420, 390}, 1.0);
  const double* blocks[] = {view.camera_block.data(), view.landmark_block.data()};
  double residuals[4];
  EXPECT_FALSE(residual.Evaluate(blocks, residuals, nullptr));
}

}  // namespace
}  // namespace soslam
