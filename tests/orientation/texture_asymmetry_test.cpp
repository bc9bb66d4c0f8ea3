// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/texture_asymmetry.h"

#include <gtest/gtest.h>

#include "support/facing_view.h"
#include "support/jacobians.h"

namespace soslam {
namespace {

SymmetryOptions EverywhereInTheImage() {
  SymmetryOptions options;
  options.sampling = Sampling::kUniform;
  options.uniform_columns = 40;
  options.min_viewing_cosine = 0.3;
  return options;
}

TextureOptions Texture(double cost, double scale) {
  TextureOptions options;
  options.asymmetry_cost = cost;
  options.asymmetry_scale = scale;
  return options;
}

double Cost(const AsymmetryResidual& residual, const RandomView& view) {
  Eigen::VectorXd residuals(residual.num_residuals());
  const std::array<const double*, 2> blocks = {view.camera_block.data(),
                                               view.landmark_block.data()};
  EXPECT_TRUE(residual.Evaluate(blocks.data(), residuals.data(), nullptr));
  return 0.5 * residuals.squaredNorm();
}

// All pixels the same: whatever is mirrored, nothing differs.
TEST(AsymmetryCost, IsZeroForAUniformTextureAndWholeWhereNothingIsMirrored) {
  SymmetryImage image = SparseImage();
  image.maps.grey = cv::Scalar(128);
  SymmetryOptions options = EverywhereInTheImage();
  options.descriptor = Descriptor::kGrey;
  TextureOptions texture;
  texture.asymmetry_cost = 4.0;
  const Landmark landmark = FacingView().LandmarkInCamera();
  const auto cost = [&](const Landmark& of) {
    return AsymmetryCost(image, TestCamera(), kWholeImage, of, texture, options);
  };
  EXPECT_NEAR(cost(landmark), 0.0, 1e-12);
  // Seen from its side, every mirror point is hidden.
  EXPECT_EQ(cost(Turned(landmark, std::numbers::pi / 2)), 4.0);
}

// Two grey halves that meet in the middle of the image: every pair differs by all of the range.
TEST(AsymmetryCost, GrowsToAllOfItWithTheDifference) {
  SymmetryImage image = SparseImage();
  image.maps.grey = cv::Scalar(0);
  image.maps.grey.colRange(0, 320) = cv::Scalar(255);
  SymmetryOptions options = EverywhereInTheImage();
  options.descriptor = Descriptor::kGrey;
  Camera camera = TestCamera();
  camera.cx = 319.5;
  Eigen::Matrix3d axes;  // x towards the camera, z up
  axes.col(0) = -Eigen::Vector3d::UnitZ();
  axes.col(2) = -Eigen::Vector3d::UnitY();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  const Landmark landmark{{Eigen::Quaterniond(axes), {0, 0, 3}}, {0.5, 0.5, 0.5}};
  for (const double scale : {0.1, 1.0, 2.0, 100.0}) {
    EXPECT_NEAR(AsymmetryCost(image, camera, kWholeImage, landmark, Texture(3.0, scale), options),
                3.0 / (1.0 + scale * scale), 1e-9);
  }
}

// Grey values that are symmetric about a column beside the body's centre.
TEST(AsymmetryCost, FindsTheMirrorPlaneBesideTheCentre) {
  SymmetryImage image = SparseImage();
  Camera camera = TestCamera();
  camera.cx = 319.5;
  // The front face is 2.5 m away: a plane 0.05 m to the side of the centre.
  const double column = 319.5 + camera.fx * 0.05 / 2.5;
  for (int x = 0; x < 640; ++x) {
    image.maps.grey.col(x) = cv::Scalar(std::min(255.0, 2.0 * std::abs(x - column)));
  }
  SymmetryOptions options = EverywhereInTheImage();
  options.descriptor = Descriptor::kGrey;
  Eigen::Matrix3d axes;  // x towards the camera, z up
  axes.col(0) = -Eigen::Vector3d::UnitZ();
  axes.col(2) = -Eigen::Vector3d::UnitY();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  const Landmark landmark{{Eigen::Quaterniond(axes), {0, 0, 3}}, {0.5, 0.5, 0.5}, kCuboidExponent};
  TextureOptions texture = Texture(1.0, 0.1);
  const double centred = AsymmetryCost(image, camera, kWholeImage, landmark, texture, options);
  texture.mirror_plane_range = 0.2;  // of its size: up to 0.1 m
  const double beside = AsymmetryCost(image, camera, kWholeImage, landmark, texture, options);
  EXPECT_GT(centred, 0.3);
  EXPECT_LT(beside, 0.01);
}

TEST(AsymmetryResidual, IsTheCostAtItsStartTimesItsWeight) {
  const auto image = std::make_shared<const SymmetryImage>(SparseImage());
  for (const Descriptor descriptor : {Descriptor::kLinearisedDt, Descriptor::kDistanceTransform}) {
    SymmetryOptions options = EverywhereInTheImage();
    options.descriptor = descriptor;
    const TextureOptions texture = Texture(4.0, 0.3);
    for (int i = 0; i < 10; ++i) {
      RandomView view = FacingView();
      const Landmark start = view.LandmarkInCamera();
      const AsymmetryResidual residual(image, TestCamera(), kWholeImage, start, texture, options,
                                       0.25);
      ASSERT_GT(residual.num_residuals(), 50);
      const double expected =
          0.25 * AsymmetryCost(*image, TestCamera(), kWholeImage, start, texture, options);
      EXPECT_GT(expected, 1e-3);
      EXPECT_NEAR(Cost(residual, view), expected, 1e-9);
      view.Move(RandomRigid(10.0));
      EXPECT_NEAR(Cost(residual, view), expected, 1e-6);
    }
  }
}

TEST(AsymmetryResidual, JacobiansAgreeWithNumbers) {
  const auto image = std::make_shared<const SymmetryImage>(SparseImage());
  SymmetryOptions options = EverywhereInTheImage();
  options.uniform_columns = 12;
  options.descriptor = Descriptor::kLinearisedDt;
  for (int i = 0; i < 10; ++i) {
    const RandomView view = FacingView();
    const AsymmetryResidual residual(image, TestCamera(), {250, 180, 390, 300},
                                     view.LandmarkInCamera(), Texture(4.0, 0.3), options, 0.7);
    ASSERT_GT(residual.num_residuals(), 50);
    ExpectCorrectJacobians(residual, {view.camera_block.data(), view.landmark_block.data()});
  }
}

TEST(AsymmetryResidual, CountsPairsThatLeaveTheSurfaceAsAsymmetric) {
  const auto image = std::make_shared<const SymmetryImage>(SparseImage());
  RandomView view = FacingView();
  SymmetryOptions options = EverywhereInTheImage();
  options.descriptor = Descriptor::kDistanceTransform;
  const AsymmetryResidual residual(image, TestCamera(), kWholeImage, view.LandmarkInCamera(),
                                   Texture(4.0, 0.3), options, 1.0);
  ASSERT_GT(residual.num_residuals(), 50);
  // Beside the image: no pixel's ray meets it any more.
  view.landmark_in_world.frame_from_object.translation +=
      view.world_from_camera.rotation * Eigen::Vector3d(20.0, 0.0, 0.0);
  view.Move(Rigid3d());
  EXPECT_NEAR(Cost(residual, view), 4.0, 1e-9);
}

}  // namespace
}  // namespace soslam
