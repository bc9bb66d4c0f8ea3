// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/symmetry.h"

#include <gtest/gtest.h>

#include "support/facing_view.h"
#include "support/jacobians.h"

namespace soslam {
namespace {

constexpr std::array kDifferentiable = {Descriptor::kGrey, Descriptor::kDistanceTransform,
                                        Descriptor::kNearestEdge3d, Descriptor::kImprovedDt,
                                        Descriptor::kLinearisedDt};

TEST(SymmetryResidual, JacobiansAgreeWithNumbers) {
  const auto image = std::make_shared<const SymmetryImage>(SparseImage());
  Camera camera = TestCamera();
  camera.cx = 120.0;  // where the grey ramp is
  for (const Descriptor descriptor : kDifferentiable) {
    SCOPED_TRACE(kDescriptorNames[static_cast<size_t>(descriptor)]);
    for (int i = 0; i < 20; ++i) {
      const RandomView view = FacingView();
      const Eigen::Vector2d pixel(RandomUniform(100, 140), RandomUniform(225, 270));
      const SymmetryResidual residual(descriptor, image, camera, pixel, kEllipsoidExponent, 0.5);
      ExpectCorrectJacobians(residual, {view.camera_block.data(), view.landmark_block.data()});
    }
  }
}

TEST(SymmetryDescriptor, MirrorOfTheMirrorIsThePixel) {
  const SymmetryImage image = SparseImage();
  for (int i = 0; i < 50; ++i) {
    const Landmark landmark = FacingView().LandmarkInCamera();
    const SymmetryDescriptor descriptor(Descriptor::kDistanceTransform, image, TestCamera(),
                                        landmark);
    const Eigen::Vector2d pixel(RandomUniform(290, 350), RandomUniform(215, 270));
    const auto pair = descriptor.Evaluate(pixel, 0.0, false);
    ASSERT_TRUE(pair);
    const auto back = descriptor.Evaluate(pair->mirror_pixel, 0.0, false);
    ASSERT_TRUE(back);
    EXPECT_LT((back->mirror_pixel - pixel).norm(), 1e-6);
    EXPECT_NEAR(back->residual, -pair->residual, 1e-3);  // the distance map is in single precision
  }
}

TEST(SymmetryDescriptor, ResidualsOfSeveralMirrorPlanesAreThoseOfEachPair) {
  const SymmetryImage image = SparseImage();
  const std::vector<double> planes = {-0.2, 0.0, 0.1};
  int pairs = 0;
  for (const Descriptor descriptor : {Descriptor::kDistanceTransform, Descriptor::kImprovedDt}) {
    for (int i = 0; i < 20; ++i) {
      const SymmetryDescriptor of(descriptor, image, TestCamera(), FacingView().LandmarkInCamera());
      const Eigen::Vector2d pixel(RandomUniform(200, 440), RandomUniform(150, 330));
      Eigen::VectorXd residuals(3);
      EXPECT_EQ(of.EvaluateForPlanes(pixel, 0.3, planes, residuals),
                of.VisiblePoint(pixel, std::nullopt).has_value());
      for (Eigen::Index k = 0; k < 3; ++k) {
        const auto pair = of.Evaluate(pixel, 0.3, false, planes[k]);
        EXPECT_EQ(std::isnan(residuals[k]), !pair);
        if (!pair) continue;
        EXPECT_NEAR(residuals[k], pair->residual, 1e-9);
        ++pairs;
      }
    }
  }
  EXPECT_GT(pairs, 20);
}

TEST(SymmetryDescriptor, HasNoPairWhereTheRayMissesOrTheMirrorPointIsHidden) {
  const SymmetryImage image = SparseImage();
  Landmark landmark = FacingView().LandmarkInCamera();
  const auto evaluate = [&](const Eigen::Vector2d& pixel, double min_cosine) {
    return SymmetryDescriptor(Descriptor::kGrey, image, TestCamera(), landmark)
        .Evaluate(pixel, min_cosine, false);
  };
  EXPECT_TRUE(evaluate({318, 242}, 0.2));
  EXPECT_FALSE(evaluate({5, 5}, 0.2));
  // Seen from its left side, every mirror point is on the far side.
  landmark = RotatedAboutZ(landmark, std::numbers::pi / 2);
  EXPECT_FALSE(evaluate({318, 242}, 0.2));
}

// Edges and grey values symmetric about the vertical through the principal point, seen exactly from
// the front: every descriptor is symmetric projection invariant, eq. (15).
TEST(SymmetryDescriptor, IsZeroOnASymmetricImage) {
  Camera camera = TestCamera();
  camera.cx = 319.5;  // the mirror axis of a 640 px wide image
  cv::Mat grey(480, 640, CV_8UC1, cv::Scalar(90));
  for (const int side : {-1, 1}) {
    for (const auto& [x, y] : {std::pair(20, 200), {45, 260}, {60, 225}}) {
      const double centre = 319.5 + side * (x + 0.5);
      for (int row = y - 8; row <= y + 8; ++row) {
        for (int column = 0; column < 640; ++column) {
          if (std::abs(column - centre) <= 6.0) grey.at<unsigned char>(row, column) = 220;
        }
      }
    }
  }
  const SymmetryImage image(ComputeEdgeMaps(grey, EdgesOptions()), kWholeImage);
  const Landmark landmark = FacingLandmark({0.6, 0.7, 0.5});
  // Canny breaks ties between two sides of an edge towards one side: half a grey level, a few
  // bits, up to 2 px in the image or 12 mm on the surface.
  constexpr std::array kTolerances = {0.002, 0.15, 0.15, 2.0, 0.012, 0.012, 0.012};
  for (size_t i = 0; i < kDescriptorNames.size(); ++i) {
    const SymmetryDescriptor descriptor(static_cast<Descriptor>(i), image, camera, landmark);
    int pairs = 0;
    for (double x = 250.5; x < 390; x += 7) {
      for (double y = 190; y < 280; y += 7) {
        const auto pair = descriptor.Evaluate({x, y}, 0.1, false);
        if (!pair) continue;
        ++pairs;
        EXPECT_NEAR(pair->mirror_pixel.x(), 639 - x, 1e-6);
        EXPECT_LT(std::abs(pair->residual), kTolerances[i]) << kDescriptorNames[i];
      }
    }
    EXPECT_GT(pairs, 100) << kDescriptorNames[i];
  }
}

}  // namespace
}  // namespace soslam
