// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_images.h"

#include <gtest/gtest.h>

#include <numeric>
#include <opencv2/core.hpp>

namespace soslam {
namespace {

cv::Mat Noise() {
  cv::Mat image(480, 640, CV_8UC3);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 255);
  return image;
}

TEST(EncodeImages, AreAsLargeAsThereIsRoom) {
  const ImageSource source = {[](int) { return true; }, [](int) { return Noise(); }};
  const auto large = EncodeImages({0, 1, 2}, source, 10'000'000, 2);
  const auto small = EncodeImages({0, 1, 2}, source, 300'000, 2);
  const auto total = [](const std::vector<std::string>& texts) {
    return std::accumulate(texts.begin(), texts.end(), size_t{0},
                           [](size_t sum, const std::string& text) { return sum + text.size(); });
  };
  EXPECT_GT(total(large), 300'000u);
  EXPECT_LE(total(small), 300'000u);
  EXPECT_GT(total(small), 30'000u);
  EXPECT_EQ(large, EncodeImages({0, 1, 2}, source, 10'000'000, 1));
}

}  // namespace
}  // namespace soslam
