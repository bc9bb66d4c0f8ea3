// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/distort_pixels.h"

#include <gtest/gtest.h>

#include "support/random.h"

namespace soslam {
namespace {

// The Kinect of TUM RGB-D's freiburg2 sequences, as its publishers calibrated it.
const Camera kKinect = {640, 480, 520.908620, 521.007327, 325.141442, 249.701764};
const Distortion kKinectLens = {0.231222, -0.784899, -0.003257, -0.000105, 0.917205};

// A wide lens: it draws straight lines as barrels.
const Distortion kBarrel = {-0.25, 0.05, 0.0, 0.0, 0.0};

Eigen::Vector2d RandomPixel(const Camera& camera) {
  return {RandomUniform(-0.5, camera.width - 0.5), RandomUniform(-0.5, camera.height - 0.5)};
}

// x' = x (1 + k1 r^2 + k2 r^4 + k3 r^6) + 2 p1 x y + p2 (r^2 + 2 x^2) and y' likewise with
// p1 (r^2 + 2 y^2) + 2 p2 x y: at (x, y) = (0.5, 0) these are 0.5 (1 + 0.1 / 4) + 0.001 * 0.75 and
// 0.002 * 0.25.
TEST(DistortionTest, NumbersByHand) {
  const Camera camera{1000, 1000, 1000.0, 1000.0, 0.0, 0.0};
  const auto distorted = DistortPixels(camera, {0.1, 0.0, 0.002, 0.001, 0.0}, {{500.0, 0.0}});
  ASSERT_EQ(distorted.size(), 1u);
  EXPECT_NEAR(distorted[0].x(), 513.25, 1e-9);
  EXPECT_NEAR(distorted[0].y(), 0.5, 1e-9);
}

// With k4 = 0.4 the radial factor has the denominator 1 + 0.4 / 4, and s1 = 0.02 adds 0.02 r^2 to
// x.
TEST(DistortionTest, RationalAndPrismNumbersByHand) {
  const Camera camera{1000, 1000, 1000.0, 1000.0, 0.0, 0.0};
  Distortion lens{0.1};
  lens.k4 = 0.4;
  lens.s1 = 0.02;
  const auto distorted = DistortPixels(camera, lens, {{500.0, 0.0}});
  EXPECT_NEAR(distorted[0].x(), 500.0 * 1.025 / 1.1 + 5.0, 1e-9);
  EXPECT_NEAR(distorted[0].y(), 0.0, 1e-9);
}

TEST(DistortionTest, AsFewCoefficientsAsHoldAllThatAreNotZero) {
  Distortion lens = kKinectLens;
  EXPECT_EQ(DistortionCoefficients(lens),
            (std::vector{0.231222, -0.784899, -0.003257, -0.000105, 0.917205}));
  EXPECT_EQ(DistortionCoefficients(Distortion()), std::vector<double>(5));
  lens.k5 = 0.1;
  EXPECT_EQ(DistortionCoefficients(lens).size(), 8u);
  lens.s4 = 0.1;
  EXPECT_EQ(DistortionCoefficients(lens).size(), 12u);
  lens.tau_x = 0.1;
  EXPECT_EQ(DistortionCoefficients(lens).size(), 14u);
  EXPECT_EQ(DistortionOfCoefficients(DistortionCoefficients(lens)), lens);
  EXPECT_EQ(DistortionOfCoefficients(std::vector{1.0, 2.0, 3.0, 4.0}), (Distortion{1, 2, 3, 4}));
  for (const size_t count : {0, 1, 3, 6, 7, 9, 13, 15}) {
    EXPECT_FALSE(DistortionOfCoefficients(std::vector<double>(count))) << count;
  }
}

TEST(DistortionTest, UndistortingUndoesDistorting) {
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i < 500; ++i) pixels.push_back(RandomPixel(kKinect));
  for (const Distortion& lens : {kKinectLens, kBarrel, Distortion{0.1, 0.0, 0.01, -0.02, 0.0},
                                 Distortion{0.2, -0.1, 0.001, 0.002, 0.0, 0.15, -0.05, 0.01, 0.001,
                                            0.002, 0.003, -0.001, 0.01, -0.02}}) {
    const auto back = UndistortPixels(kKinect, lens, DistortPixels(kKinect, lens, pixels));
    ASSERT_EQ(back.size(), pixels.size());
    for (size_t i = 0; i < pixels.size(); ++i) {
      ASSERT_TRUE(back[i]) << pixels[i].transpose();
      EXPECT_LT((*back[i] - pixels[i]).norm(), 2e-3) << pixels[i].transpose();
    }
  }
}

// x (1 - x^2 / 2) has its largest value 0.544 at x = 0.816: nothing is drawn further out.
TEST(DistortionTest, BeyondTheLargestDistortedRadiusThereIsNothing) {
  const Camera camera{1000, 1000, 1000.0, 1000.0, 0.0, 0.0};
  const Distortion lens{-0.5, 0.0, 0.0, 0.0, 0.0};
  EXPECT_TRUE(UndistortPixels(camera, lens, {{540.0, 0.0}}).front());
  EXPECT_FALSE(UndistortPixels(camera, lens, {{550.0, 0.0}}).front());
  EXPECT_TRUE(UndistortBox(camera, lens, {100.0, 100.0, 300.0, 300.0}));
  EXPECT_FALSE(UndistortBox(camera, lens, {100.0, 100.0, 600.0, 300.0}));
}

TEST(DistortionTest, UndistortedBoxHoldsWhatTheDistortedBoxHeld) {
  for (const Distortion& lens : {kKinectLens, kBarrel}) {
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector2d a = RandomPixel(kKinect);
      const Eigen::Vector2d b = RandomPixel(kKinect);
      const Box box{std::min(a.x(), b.x()), std::min(a.y(), b.y()), std::max(a.x(), b.x()),
                    std::max(a.y(), b.y())};
      const auto undistorted = UndistortBox(kKinect, lens, box);
      ASSERT_TRUE(undistorted);
      const Eigen::Vector2d inside(RandomUniform(box.x_min, box.x_max),
                                   RandomUniform(box.y_min, box.y_max));
      const auto pixel = UndistortPixels(kKinect, lens, {inside}).front();
      ASSERT_TRUE(pixel);
      EXPECT_TRUE(undistorted->Contains(*pixel));
    }
  }
}

// What a pincushion lens draws as a straight edge is one that bows outwards, beyond the corners.
TEST(DistortionTest, BowedEdgesReachBeyondTheCorners) {
  const Distortion pincushion{0.25, 0.0, 0.0, 0.0, 0.0};
  const Box box{125.141442, 49.701764, 525.141442, 449.701764};  // centred on the optical axis
  const auto around = UndistortBox(kKinect, pincushion, box);
  const auto corner = UndistortPixels(kKinect, pincushion, {{box.x_max, box.y_max}}).front();
  const auto middle = UndistortPixels(kKinect, pincushion, {{box.x_max, kKinect.cy}}).front();
  ASSERT_TRUE(around && corner && middle);
  EXPECT_GT(middle->x(), corner->x() + 2.0);
  EXPECT_NEAR(around->x_max, middle->x(), 1e-6);
}

}  // namespace
}  // namespace soslam
