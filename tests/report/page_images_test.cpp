// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_images.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "base/error.h"

namespace soslam {
namespace {

cv::Mat Noise() {
  cv::Mat image(480, 640, CV_8UC3);
  cv::RNG(1).fill(image, cv::RNG::UNIFORM, 0, 255);
  return image;
}

size_t Bytes(const EncodedImages& encoded) {
  size_t bytes = 0;
  for (const auto& image : encoded.images) bytes += image.base64.size();
  return bytes;
}

const ImageSource kNoises = {[](int) { return true; }, [](int) { return Noise(); }};

TEST(EncodeImages, AreAsLargeAsThereIsRoom) {
  const EncodedImages large = EncodeImages({0, 1, 2}, kNoises, 10'000'000, 2);
  const EncodedImages small = EncodeImages({0, 1, 2}, kNoises, 300'000, 2);
  EXPECT_GT(Bytes(large), 300'000u);
  EXPECT_EQ(large.scaled_to_px, 0);
  EXPECT_LE(Bytes(small), 300'000u);
  EXPECT_GT(Bytes(small), 30'000u);
  EXPECT_EQ(small.images.size(), 3u);
  EXPECT_EQ(small.scaled_to_px, 320);
}

TEST(EncodeImages, AreFewerWhenTheSmallestAreTooLarge) {
  const std::vector<int> frames = {0, 1, 2, 3, 4, 5, 6, 7};
  const EncodedImages few = EncodeImages(frames, kNoises, 50'000, 2);
  EXPECT_LE(Bytes(few), 50'000u);
  EXPECT_FALSE(few.images.empty());
  EXPECT_EQ(few.left_out + few.images.size(), frames.size());
  EXPECT_GT(few.left_out, 0u);
  EXPECT_TRUE(EncodeImages(frames, kNoises, 100, 2).images.empty());
}

TEST(EncodeImages, DoNotDependOnTheNumberOfThreads) {
  const EncodedImages one = EncodeImages({0, 1, 2}, kNoises, 300'000, 1);
  const EncodedImages two = EncodeImages({0, 1, 2}, kNoises, 300'000, 2);
  for (size_t i = 0; i < 3; ++i) EXPECT_EQ(one.images[i].base64, two.images[i].base64);
}

TEST(EncodeImages, LeaveOutWhatIsNotThereAndNameWhatIsDamaged) {
  const ImageSource source = {[](int frame) { return frame != 1; },
                              [](int frame) {
                                if (frame == 2) throw InputError("2.png: is empty");
                                return Noise();
                              }};
  const EncodedImages encoded = EncodeImages({0, 1, 2, 3}, source, 10'000'000, 2);
  ASSERT_EQ(encoded.images.size(), 2u);
  EXPECT_EQ(encoded.images[1].frame_index, 3);
  EXPECT_EQ(encoded.failures, std::vector<std::string>{"2.png: is empty"});
  EXPECT_EQ(encoded.left_out, 0u);
}

}  // namespace
}  // namespace soslam
