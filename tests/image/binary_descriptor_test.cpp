// SPDX-License-Identifier: BSD-3-Clause
#include "image/binary_descriptor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

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

// A descriptor that is the column of the closest pixel, counted from the other side when mirrored;
// the first and the last column have none.
BinaryDescriptors<8>::Describe PrepareColumns(const cv::Mat& grey) {
  return [columns = grey.cols](const Eigen::Vector2d& pixel, bool mirrored) {
    const auto x = static_cast<int>(std::lround(pixel.x()));
    return x < 1 || x >= columns - 1 ? std::nullopt
                                     : std::optional(std::bitset<8>(static_cast<unsigned long long>(
                                           mirrored ? columns - 1 - x : x)));
  };
}

// Described for the first time or known already.
TEST(BinaryDescriptorsTest, DistanceIsThatOfThePixelsDescriptors) {
  const cv::Mat grey(20, 40, CV_8UC1, cv::Scalar(0));
  const BinaryDescriptors<8> descriptors(grey, PrepareColumns);
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
  const BinaryDescriptors<8> descriptors(grey, PrepareColumns);
  const Eigen::Vector2d inner(20, 10);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Eigen::Vector2d& outer :
       {Eigen::Vector2d(0, 10), Eigen::Vector2d(39, 10), Eigen::Vector2d(20, -3),
        Eigen::Vector2d(20, 20), Eigen::Vector2d(nan, 10), Eigen::Vector2d(1e300, 10)}) {
    EXPECT_FALSE(descriptors.Distance(outer, inner)) << outer.transpose();
    EXPECT_FALSE(descriptors.Distance(inner, outer)) << outer.transpose();
  }
}

}  // namespace
}  // namespace soslam
