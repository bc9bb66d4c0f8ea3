// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/mirror_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "support/facing_view.h"

namespace soslam {
namespace {

// Random blots: textures whose places differ little and much.
SymmetryImage BlottedImage() {
  cv::Mat grey(480, 640, CV_8UC1, cv::Scalar(90));
  for (int i = 0; i < 60; ++i) {
    cv::circle(
        grey,
        {static_cast<int>(RandomUniform(180, 460)), static_cast<int>(RandomUniform(120, 360))},
        static_cast<int>(RandomUniform(2, 15)), cv::Scalar(RandomUniform(0, 255)), -1);
  }
  return SymmetryImage(ComputeEdgeMaps(grey, EdgesOptions()), {180, 120, 460, 360});
}

struct Expected {
  size_t samples = 0;
  std::optional<double> mean;
  size_t place = 0;
  std::vector<Eigen::Vector2d> pixels;
};

// Pair by pair, all of them.
Expected ByPairs(const SymmetryImage& image, const Landmark& landmark, Descriptor descriptor,
                 const std::vector<Eigen::Vector2d>& pixels, double min_cosine,
                 const std::vector<double>& places, double scale, double min_pairs) {
  const SymmetryDescriptor of(descriptor, image, TestCamera(), landmark);
  const VisibleSurface surface(TestCamera(), landmark);
  Expected expected;
  for (const Eigen::Vector2d& pixel : pixels) {
    expected.samples += surface.FromPixel(pixel) ? 1 : 0;
  }
  for (size_t k = 0; k < places.size(); ++k) {
    double sum = 0.0;
    std::vector<Eigen::Vector2d> pairs;
    for (const Eigen::Vector2d& pixel : pixels) {
      const double d = of.Residuals(pixel, min_cosine, {places[k]})[0];
      if (!std::isfinite(d)) continue;
      sum += d * d / (d * d + scale * scale);
      pairs.push_back(pixel);
    }
    const auto count = static_cast<double>(pairs.size());
    if (count < min_pairs || (expected.mean && sum / count >= *expected.mean)) continue;
    expected.mean = sum / count;
    expected.place = k;
    expected.pixels = pairs;
  }
  return expected;
}

TEST(MirrorSearch, FindsWhatAllPairsSay) {
  const std::vector<double> places = {-0.3, -0.2, -0.1, 0.0, 0.1, 0.2, 0.3};
  size_t found = 0;
  for (const auto& [descriptor, scale] :
       {std::pair(Descriptor::kDistanceTransform, 3.0), {Descriptor::kGrey, 0.1}}) {
    for (const double shape_exponent : {kCuboidExponent, 1.3, kEllipsoidExponent}) {
      const SymmetryImage image = BlottedImage();
      MirrorSearch search(image, TestCamera(), descriptor, image.edge_pixels);
      for (int i = 0; i < 5; ++i) {
        Landmark landmark = FacingView().LandmarkInCamera();
        landmark.shape_exponent = shape_exponent;
        for (const double min_pairs : {8.0, 400.0, 1e6}) {
          const Expected expected = ByPairs(image, landmark, descriptor, image.edge_pixels, 0.2,
                                            places, scale, min_pairs);
          search.SetLandmark(landmark, 0.2);
          EXPECT_EQ(search.NumSamples(), expected.samples);
          const auto least = search.FindMinimum(places, scale, min_pairs);
          ASSERT_EQ(least.has_value(), expected.mean.has_value());
          if (!least) continue;
          // Single precision is off by 1e-4 px, which a share of 0.2 per px at most averages out.
          EXPECT_NEAR(least->mean, *expected.mean, 1e-5);
          EXPECT_EQ(least->place, expected.place);
          EXPECT_EQ(search.PixelsOfPairs(places[least->place]), expected.pixels);
          ++found;
        }
      }
    }
  }
  EXPECT_GT(found, 30u);
}

TEST(MirrorSearch, OfEqualPlacesTheFirstIsFound) {
  SymmetryImage image = BlottedImage();
  image.maps.grey = cv::Scalar(50);
  MirrorSearch search(image, TestCamera(), Descriptor::kGrey, image.edge_pixels);
  search.SetLandmark(FacingView().LandmarkInCamera(), 0.2);
  const auto least = search.FindMinimum({0.1, 0.0, -0.1}, 1.0, 8.0);
  ASSERT_TRUE(least);
  EXPECT_EQ(least->mean, 0.0);
  EXPECT_EQ(least->place, 0u);
}

}  // namespace
}  // namespace soslam
