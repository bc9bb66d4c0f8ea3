// SPDX-License-Identifier: BSD-3-Clause
#include "image/binary_descriptor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <set>
#include <string>
#include <vector>

#include "support/random.h"

namespace soslam {
namespace {

TEST(HammingDistanceTest, CountsDifferingBits) {
  std::bitset<256> bits;
  EXPECT_EQ(HammingDistance(bits, ~bits), 1.0);
  EXPECT_EQ(HammingDistance(bits, bits), 0.0);
  bits[3] = bits[200] = true;
  EXPECT_EQ(HammingDistance(bits, std::bitset<256>()), 2.0 / 256.0);
}

int Columns(const cv::Mat& grey) { return grey.cols; }

// A descriptor that is the column of the closest pixel, counted from the other side when mirrored;
// the first and the last column have none.
std::optional<std::bitset<8>> DescribeColumn(int columns, const Eigen::Vector2d& pixel,
                                             bool mirrored) {
  const auto x = static_cast<int>(std::lround(pixel.x()));
  if (x < 1 || x >= columns - 1) return std::nullopt;
  return static_cast<unsigned long long>(mirrored ? columns - 1 - x : x);
}

// Described for the first time or known already.
TEST(BinaryDescriptorsTest, DistanceIsThatOfThePixelsDescriptors) {
  const cv::Mat grey(20, 40, CV_8UC1, cv::Scalar(0));
  const BinaryDescriptors<&Columns, &DescribeColumn> descriptors(grey);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector2d pixel(RandomUniform(0.6, 38.4), RandomUniform(0, 19));
    const Eigen::Vector2d other(RandomUniform(0.6, 38.4), RandomUniform(0, 19));
    const auto column = static_cast<unsigned>(std::lround(pixel.x()));
    const auto from_the_right = static_cast<unsigned>(39 - std::lround(other.x()));
    const auto differing = static_cast<double>(std::bitset<8>(column ^ from_the_right).count());
    EXPECT_EQ(descriptors.Distance(pixel, other), differing / 8.0);
    EXPECT_EQ(descriptors.Distance(pixel, {39 - pixel.x(), 3.0}), 0.0);
  }
}

TEST(BinaryDescriptorsTest, NoneWhereOneOfThePixelsHasNone) {
  const cv::Mat grey(20, 40, CV_8UC1, cv::Scalar(0));
  const BinaryDescriptors<&Columns, &DescribeColumn> descriptors(grey);
  const Eigen::Vector2d inner(20, 10);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector2d& outer :
       {Eigen::Vector2d(0, 10), Eigen::Vector2d(39, 10), Eigen::Vector2d(20, -3),
        Eigen::Vector2d(20, 20), Eigen::Vector2d(nan, 10), Eigen::Vector2d(1e300, 10)}) {
    EXPECT_FALSE(descriptors.Distance(outer, inner)) << outer.transpose();
    EXPECT_FALSE(descriptors.Distance(inner, outer)) << outer.transpose();
  }
}

constexpr int kWidth = 80;
constexpr int kHeight = 60;

cv::Mat RandomTexture(const cv::Size& size = {kWidth, kHeight}, int brightest = 255) {
  cv::Mat grey(size, CV_8UC1);
  for (auto it = grey.begin<uchar>(); it != grey.end<uchar>(); ++it) {
    *it = static_cast<uchar>(RandomUniform(0, brightest + 1));
  }
  return grey;
}

Eigen::Vector2d RandomInnerPixel() {
  return {RandomUniform(15, kWidth - 16), RandomUniform(15, kHeight - 16)};
}

TEST(BriefTest, MirroredDescriptorAtTheMirrorPixelIsTheSame) {
  const cv::Mat grey = RandomTexture();
  cv::Mat flipped;
  cv::flip(grey, flipped, 1);
  const cv::Mat smoothed = SmoothForBrief(grey);
  const cv::Mat smoothed_flipped = SmoothForBrief(flipped);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d pixel = RandomInnerPixel();
    const Eigen::Vector2d mirror_pixel(kWidth - 1 - pixel.x(), pixel.y());
    const auto plain = BriefDescriptor(smoothed, pixel, false);
    const auto mirrored = BriefDescriptor(smoothed_flipped, mirror_pixel, true);
    ASSERT_TRUE(plain && mirrored);
    EXPECT_EQ(*plain, *mirrored);
    EXPECT_NE(*plain, *BriefDescriptor(smoothed_flipped, mirror_pixel, false));
  }
}

TEST(BriefTest, IgnoresBrightness) {
  cv::Mat grey = RandomTexture() / 2;
  const cv::Mat brighter = grey + 100;
  const Eigen::Vector2d pixel = RandomInnerPixel();
  EXPECT_EQ(*BriefDescriptor(grey, pixel, false), *BriefDescriptor(brighter, pixel, false));
}

TEST(BriefTest, NoneWhereThePatchReachesOut) {
  const cv::Mat grey = RandomTexture();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool mirrored : {false, true}) {
    EXPECT_TRUE(BriefDescriptor(grey, {14.5, 15}, mirrored));
    EXPECT_TRUE(BriefDescriptor(grey, {kWidth - 15.6, kHeight - 15.6}, mirrored));
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(14.4, 20), Eigen::Vector2d(kWidth - 15.5, 20), Eigen::Vector2d(20, 14.4),
          Eigen::Vector2d(20, kHeight - 15.5), Eigen::Vector2d(nan, 20), Eigen::Vector2d(20, nan),
          Eigen::Vector2d(1e300, 20)}) {
      EXPECT_FALSE(BriefDescriptor(grey, pixel, mirrored)) << pixel.transpose();
    }
    EXPECT_FALSE(BriefDescriptor(cv::Mat(30, 30, CV_8UC1, cv::Scalar(0)), {15, 15}, mirrored));
  }
}

constexpr int kRadius = 22;  // of the patch, px

Eigen::Vector2d PixelWithPatch() {
  return {RandomUniform(kRadius, kWidth - kRadius - 1),
          RandomUniform(kRadius, kHeight - kRadius - 1)};
}

FreakBits FreakAt(const cv::Mat& grey, const Eigen::Vector2d& pixel, bool mirrored = false) {
  const auto bits = FreakDescriptor(SmoothForFreak(grey), pixel, mirrored);
  EXPECT_TRUE(bits);
  return bits.value_or(FreakBits());
}

TEST(FreakTest, MirroredDescriptorAtTheMirrorPixelIsTheSame) {
  const cv::Mat grey = RandomTexture();
  cv::Mat flipped;
  cv::flip(grey, flipped, 1);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector2d pixel = PixelWithPatch();
    const Eigen::Vector2d mirror_pixel(kWidth - 1 - pixel.x(), pixel.y());
    const FreakBits plain = FreakAt(grey, pixel);
    EXPECT_EQ(HammingDistance(plain, FreakAt(flipped, mirror_pixel, true)), 0.0);
    EXPECT_GT(HammingDistance(plain, FreakAt(flipped, mirror_pixel, false)), 0.1);
  }
}

TEST(FreakTest, IgnoresBrightness) {
  const cv::Mat grey = RandomTexture({kWidth, kHeight}, 155);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector2d pixel = PixelWithPatch();
    EXPECT_EQ(FreakAt(grey, pixel), FreakAt(grey + RandomUniform(1, 100), pixel));
  }
}

TEST(FreakTest, BitsAreDifferentAndEachIsSetInHalfOfAllPatches) {
  constexpr int kPatches = 400;
  std::vector<std::string> values(FreakBits().size());
  const FreakImage smoothed = SmoothForFreak(RandomTexture({500, 500}));
  for (int i = 0; i < kPatches; ++i) {
    const FreakBits bits =
        FreakDescriptor(smoothed, {RandomUniform(22, 477), RandomUniform(22, 477)}, false).value();
    for (size_t bit = 0; bit < bits.size(); ++bit) values[bit] += bits[bit] ? '1' : '0';
  }
  for (const std::string& of_bit : values) {
    const auto set = std::ranges::count(of_bit, '1');
    EXPECT_GT(set, 0.3 * kPatches);  // less than half: in white noise, wide fields are often equal
    EXPECT_LT(set, 0.6 * kPatches);
  }
  EXPECT_EQ(std::set<std::string>(values.begin(), values.end()).size(), values.size());
}

TEST(FreakTest, NoneWhereThePatchReachesOut) {
  const FreakImage smoothed = SmoothForFreak(RandomTexture());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool mirrored : {false, true}) {
    EXPECT_TRUE(FreakDescriptor(smoothed, {21.5, 22}, mirrored));
    EXPECT_TRUE(FreakDescriptor(smoothed, {kWidth - 22.6, kHeight - 22.6}, mirrored));
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(21.4, 30), Eigen::Vector2d(kWidth - 22.5, 30), Eigen::Vector2d(30, 21.4),
          Eigen::Vector2d(30, kHeight - 22.5), Eigen::Vector2d(nan, 30), Eigen::Vector2d(30, nan),
          Eigen::Vector2d(1e300, 30)}) {
      EXPECT_FALSE(FreakDescriptor(smoothed, pixel, mirrored)) << pixel.transpose();
    }
    const FreakImage small = SmoothForFreak(cv::Mat(44, 44, CV_8UC1, cv::Scalar(0)));
    EXPECT_FALSE(FreakDescriptor(small, {22, 22}, mirrored));
  }
}

}  // namespace
}  // namespace soslam
