// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/binary_descriptor.h"

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

struct Brief {
  static constexpr int kRadius = 15;  // of the patch, px
  static auto At(const cv::Mat& grey, const Eigen::Vector2d& pixel, bool mirrored = false) {
    return BriefDescriptor(SmoothForBrief(grey), pixel, mirrored);
  }
};

struct Freak {
  static constexpr int kRadius = 22;
  static auto At(const cv::Mat& grey, const Eigen::Vector2d& pixel, bool mirrored = false) {
    return FreakDescriptor(SmoothForFreak(grey), pixel, mirrored);
  }
};

// A pixel whose patch lies in the image.
template <typename Descriptor>
Eigen::Vector2d PixelWithPatch() {
  constexpr int kRadius = Descriptor::kRadius;
  return {RandomUniform(kRadius, kWidth - kRadius - 1),
          RandomUniform(kRadius, kHeight - kRadius - 1)};
}

template <typename Descriptor>
class DescriptorTest : public testing::Test {};
using Descriptors = testing::Types<Brief, Freak>;
TYPED_TEST_SUITE(DescriptorTest, Descriptors);

TYPED_TEST(DescriptorTest, MirroredDescriptorAtTheMirrorPixelIsTheSame) {
  const cv::Mat grey = RandomTexture();
  cv::Mat flipped;
  cv::flip(grey, flipped, 1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d pixel = PixelWithPatch<TypeParam>();
    const Eigen::Vector2d mirror_pixel(kWidth - 1 - pixel.x(), pixel.y());
    const auto plain = TypeParam::At(grey, pixel);
    const auto mirrored = TypeParam::At(flipped, mirror_pixel, true);
    ASSERT_TRUE(plain && mirrored);
    EXPECT_EQ(*plain, *mirrored);
    EXPECT_GT(HammingDistance(*plain, *TypeParam::At(flipped, mirror_pixel, false)), 0.1);
  }
}

TYPED_TEST(DescriptorTest, IgnoresBrightness) {
  const cv::Mat grey = RandomTexture({kWidth, kHeight}, 155);
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector2d pixel = PixelWithPatch<TypeParam>();
    const auto plain = TypeParam::At(grey, pixel);
    ASSERT_TRUE(plain);
    EXPECT_EQ(plain, TypeParam::At(grey + RandomUniform(1, 100), pixel));
  }
}

TYPED_TEST(DescriptorTest, NoneWhereThePatchReachesOut) {
  constexpr int kRadius = TypeParam::kRadius;
  const cv::Mat grey = RandomTexture();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const bool mirrored : {false, true}) {
    EXPECT_TRUE(TypeParam::At(grey, {kRadius - 0.5, kRadius}, mirrored));
    EXPECT_TRUE(TypeParam::At(grey, {kWidth - kRadius - 0.6, kHeight - kRadius - 0.6}, mirrored));
    for (const Eigen::Vector2d& pixel :
         {Eigen::Vector2d(kRadius - 0.6, 30), Eigen::Vector2d(kWidth - kRadius - 0.5, 30),
          Eigen::Vector2d(30, kRadius - 0.6), Eigen::Vector2d(30, kHeight - kRadius - 0.5),
          Eigen::Vector2d(nan, 30), Eigen::Vector2d(30, nan), Eigen::Vector2d(1e300, 30)}) {
      EXPECT_FALSE(TypeParam::At(grey, pixel, mirrored)) << pixel.transpose();
    }
    const cv::Mat small(2 * kRadius, 2 * kRadius, CV_8UC1, cv::Scalar(0));
    EXPECT_FALSE(TypeParam::At(small, {kRadius, kRadius}, mirrored));
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

}  // namespace
}  // namespace soslam
