// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_images.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

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

// Frame 1 has no image, that of frame 2 is damaged.
const ImageSource kFaulty = {[](int frame) { return frame != 1; },
                             [](int frame) {
                               if (frame == 2) throw InputError("2.png: is empty");
                               return Noise();
                             }};

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

TEST(EncodeImages, LeaveOutWhatIsNotThereAndNameWhatIsDamaged) {
  const EncodedImages encoded = EncodeImages({0, 1, 2, 3}, kFaulty, 10'000'000, 2);
  ASSERT_EQ(encoded.images.size(), 2u);
  EXPECT_EQ(encoded.images[1].frame_index, 3);
  EXPECT_EQ(encoded.failures, std::vector<std::string>{"2.png: is empty"});
  EXPECT_EQ(encoded.left_out, 0u);
}

// The size of a JPEG file in base 64.
cv::Size SizeOf(const std::string& base64) {
  const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<unsigned char> bytes;
  unsigned bits = 0, count = 0;
  for (const char c : base64) {
    const size_t digit = kDigits.find(c);
    if (digit == std::string::npos) break;
    bits = (bits << 6U) | static_cast<unsigned>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<unsigned char>((bits >> count) & 0xFFU));
  }
  return cv::imdecode(bytes, cv::IMREAD_COLOR).size();
}

TEST(EncodeCrops, AreSmallAndInTheOrderOfTheCrops) {
  const cv::Rect large(0, 0, 320, 200), tall(600, 0, 100, 480), small(10, 10, 40, 30);
  const std::vector<std::string> crops =
      EncodeCrops({{0, large}, {1, large}, {2, large}, {3, tall}, {3, small}, {3, {}}}, kFaulty, 2);
  ASSERT_EQ(crops.size(), 6u);
  EXPECT_EQ(SizeOf(crops[0]), cv::Size(160, 100));
  EXPECT_EQ(crops[1], "");
  EXPECT_EQ(crops[2], "");
  EXPECT_EQ(SizeOf(crops[3]), cv::Size(13, 160));  // 40 of its 100 columns are in the image
  EXPECT_EQ(SizeOf(crops[4]), cv::Size(40, 30));
  EXPECT_EQ(crops[5], "");
}

}  // namespace
}  // namespace soslam
