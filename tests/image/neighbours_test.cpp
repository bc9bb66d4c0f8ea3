// SPDX-License-Identifier: BSD-3-Clause
#include "image/neighbours.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <utility>

#include "image/sample_bilinear.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr int kColumns = 60, kRows = 40;

cv::Mat RandomMap(int rows = kRows, int columns = kColumns) {
  cv::Mat map(rows, columns, CV_32FC1);
  for (float& value : cv::Mat_<float>(map)) value = static_cast<float>(RandomUniform(0.0, 10.0));
  return map;
}

template <bool may_be_outside>
float Value(const Neighbours& map, float x, float y) {
  CellsOfEight cells;
  cells.Locate<may_be_outside>(map.view(), Eight{} + x, Eight{} + y, 0);
  Eight values;
  Interpolate(map.view(), cells, 0, &values);
  for (size_t k = 1; k < 8; ++k) {
    EXPECT_TRUE(values[k] == values[0] || (std::isnan(values[k]) && std::isnan(values[0])));
  }
  return values[0];
}

// Pixels are off by 60 * 6e-8, values then by 20 times that.
constexpr double kTolerance = 1e-4;

void ExpectAsInDoublePrecision(const cv::Mat& map) {
  Neighbours neighbours(map);
  int num_inside = 0;
  for (int i = 0; i < 200; ++i) {
    const auto x = static_cast<float>(RandomUniform(-0.1, 1.1) * (map.cols - 1));
    const auto y = static_cast<float>(RandomUniform(-0.1, 1.1) * (map.rows - 1));
    const PixelBounds bounds{x, y, x, y};
    neighbours.SelectInBounds(bounds);
    const auto expected = SampleBilinear(map, {x, y});
    const float value = Value<true>(neighbours, x, y);
    ASSERT_EQ(std::isfinite(value), expected.has_value());
    if (!expected) continue;
    EXPECT_NEAR(value, expected->value, kTolerance);
    if (!neighbours.AreInside(bounds)) continue;
    ++num_inside;
    EXPECT_EQ(Value<false>(neighbours, x, y), value);
  }
  EXPECT_GT(num_inside, 100);
}

TEST(Neighbours, AreInterpolatedAsInDoublePrecision) { ExpectAsInDoublePrecision(RandomMap()); }

TEST(Neighbours, AreThoseOfSmallMaps) {
  for (const auto& [rows, columns] : {std::pair(2, 2), {2, 3}, {3, 2}, {2, kColumns}, {kRows, 2}}) {
    ExpectAsInDoublePrecision(RandomMap(rows, columns));
  }
}

// Whose rows do not follow each other in memory.
TEST(Neighbours, AreThoseOfAPartOfAMap) {
  const cv::Mat map = RandomMap();
  for (const cv::Rect& part : {cv::Rect(7, 5, 30, 20), cv::Rect(kColumns - 20, 0, 20, kRows),
                               cv::Rect(30, kRows - 2, 2, 2), cv::Rect(30, 10, 2, 2)}) {
    ASSERT_FALSE(map(part).isContinuous());
    ExpectAsInDoublePrecision(map(part));
  }
}

// And what is near, but not the whole map.
TEST(Neighbours, CoverWhatIsAskedForAndWhatWasBefore) {
  const cv::Mat map = RandomMap(300, 400);
  Neighbours neighbours(map);
  neighbours.SelectInBounds({110.5F, 80.5F, 120.5F, 90.5F});
  const cv::Rect first = neighbours.view().part;
  EXPECT_EQ(first & cv::Rect(110, 80, 12, 12), cv::Rect(110, 80, 12, 12));
  EXPECT_LT(first.area(), 100 * 100);
  neighbours.SelectInBounds({210.5F, 180.5F, 220.5F, 190.5F});
  const cv::Rect both = neighbours.view().part;
  EXPECT_EQ(both & first, first);
  EXPECT_LT(both.area(), 200 * 200);
  for (const cv::Point2f& pixel : {cv::Point2f(115.3F, 85.7F), cv::Point2f(215.3F, 185.7F)}) {
    EXPECT_NEAR(Value<true>(neighbours, pixel.x, pixel.y),
                SampleBilinear(map, {pixel.x, pixel.y})->value, 10.0 * kTolerance);
  }
}

TEST(Neighbours, ReachTheMapsBorderAndNoFurther) {
  const cv::Mat map = RandomMap();
  Neighbours neighbours(map);
  neighbours.SelectInBounds({0.0F, 0.0F, kColumns - 1.0F, kRows - 1.0F});
  EXPECT_NEAR(Value<true>(neighbours, 0.0F, 0.0F), map.at<float>(0, 0), kTolerance);
  EXPECT_NEAR(Value<true>(neighbours, kColumns - 1.0F, kRows - 1.0F),
              map.at<float>(kRows - 1, kColumns - 1), kTolerance);
  EXPECT_TRUE(std::isnan(Value<true>(neighbours, -0.01F, 5.0F)));
  EXPECT_TRUE(std::isnan(Value<true>(neighbours, 5.0F, kRows - 0.99F)));
  EXPECT_TRUE(std::isnan(Value<true>(neighbours, std::nanf(""), 5.0F)));
  EXPECT_FALSE(neighbours.AreInside({0.0F, 5.0F, 10.0F, 10.0F}));
  EXPECT_FALSE(neighbours.AreInside({5.0F, 5.0F, 10.0F, kRows - 1.0F}));
  EXPECT_TRUE(neighbours.AreInside({5.0F, 5.0F, 10.0F, 10.0F}));
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(neighbours.AreInside({kInfinity, kInfinity, -kInfinity, -kInfinity}));
}

TEST(Neighbours, OfNoKnownBoundsAreTheWholeMap) {
  Neighbours neighbours(RandomMap());
  const float nan = std::nanf("");
  neighbours.SelectInBounds({nan, nan, nan, nan});
  EXPECT_EQ(neighbours.view().part, cv::Rect(0, 0, kColumns, kRows));
  EXPECT_FALSE(neighbours.AreInside({nan, nan, nan, nan}));
}

}  // namespace
}  // namespace soslam
