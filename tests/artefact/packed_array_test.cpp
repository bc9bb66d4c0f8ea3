// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/packed_array.h"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdint>
#include <random>
#include <stdexcept>

namespace soslam {
namespace {

std::vector<float> Unpacked(const std::string& packed, size_t count) {
  std::vector<float> values(count);
  const bool is_whole = Unpack(packed, sizeof(float), std::as_writable_bytes(std::span(values)));
  return is_whole ? values : std::vector<float>();
}

TEST(PackedArrayTest, UnpacksToTheSame) {
  const std::vector<float> values = {1.0F, -2.5F, 3e38F, 0.0F, 1e-40F};
  const PackedArray packed = Pack(values);
  EXPECT_EQ(packed.shape, ArrayShape{5});
  EXPECT_EQ(packed.depth, CV_32F);
  EXPECT_EQ(Unpacked(packed.bytes, 5), values);
}

TEST(PackedArrayTest, NothingPacksToNothing) {
  EXPECT_TRUE(Pack(cv::Mat(0, 2, CV_32FC1)).bytes.empty());
}

TEST(PackedArrayTest, WhatRepeatsIsPackedSmall) {
  EXPECT_LT(Pack(std::vector<double>(10'000, 1.0 / 3.0)).bytes.size(), 1000U);
}

TEST(PackedArrayTest, WhatCannotBeMadeSmallerUnpacksToTheSame) {
  // Around the most that one stored block of zlib's format has, and several of them.
  for (const size_t count : {16383, 16384, 70'000}) {
    std::mt19937 random(static_cast<std::mt19937::result_type>(count));
    std::vector<float> values(count);
    for (float& value : values) {
      const auto bits = static_cast<std::uint32_t>(random());
      value = std::bit_cast<float>((bits & 0xbfffffffU) | 0x20000000U);  // no NaN
    }
    const std::string packed = Pack(values).bytes;
    EXPECT_GT(packed.size(), 9 * count * sizeof(float) / 10);
    EXPECT_EQ(Unpacked(packed, count), values);
  }
}

// Leaves this number, again and again, where the next function has its variables.
[[gnu::noinline]] void FillUnusedStack(std::uint16_t number) {
  std::array<std::uint16_t, 1 << 17> numbers;
  numbers.fill(number);
  asm volatile("" : : "r"(numbers.data()) : "memory");  // or the compiler would leave it out
}

TEST(PackedArrayTest, TheBytesDoNotDependOnWhatMemoryHeldBefore) {
  std::vector<std::int32_t> values(10'000);  // repeats itself at a distance that matters
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<int>(i % 1000 * (i % 1000));
  const std::string packed = Pack(values).bytes;
  for (std::uint16_t number = 0; number < 256; ++number) {
    FillUnusedStack(number);
    EXPECT_TRUE(Pack(values).bytes == packed) << "where memory held " << number;
  }
}

[[gnu::noinline]] std::string PackedFurtherDownTheStack(int depth, const cv::Mat& values) {
  if (depth == 0) return Pack(values).bytes;
  std::array<std::byte, 1 << 17> bytes;
  asm volatile("" : : "r"(bytes.data()) : "memory");  // or the compiler would leave it out
  return PackedFurtherDownTheStack(depth - 1, values);
}

TEST(PackedArrayTest, TheBytesDoNotDependOnWhereMemoryIs) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 2000; ++trial) {
    cv::Mat values(1, 8 + trial % 32, CV_32SC1);
    for (int& value : cv::Mat_<int>(values)) value = static_cast<int>(random() % 2);
    EXPECT_TRUE(PackedFurtherDownTheStack(trial % 20, values) == Pack(values).bytes)
        << "trial " << trial;
  }
}

TEST(PackedArrayTest, ArraysOfAllSizesUnpackToTheSame) {
  std::mt19937 random(1);
  const auto check = [&](size_t count) {
    std::vector<float> values(count);
    for (float& value : values) value = static_cast<float>(random() % 100);
    EXPECT_TRUE(Unpacked(Pack(values).bytes, count) == values) << count << " numbers";
  };
  for (size_t count = 1; count < 100; ++count) check(count);
  for (size_t count = 1 << 7; count < 1 << 18; count *= 2) {
    for (const int more : {-1, 0, 1, 5}) check(count + static_cast<size_t>(more));
  }
}

TEST(PackedArrayTest, WhatIsTooLargeIsRefusedBeforeItIsRead) {
  EXPECT_THROW(Pack({1U << 31}, CV_8U, nullptr), std::length_error);
  EXPECT_THROW(Pack({1U << 29}, CV_32F, nullptr), std::length_error);
}

TEST(PackedArrayTest, AnotherSizeIsRefused) {
  const std::string packed = Pack(std::vector<float>{1.0F, 2.0F}).bytes;
  EXPECT_TRUE(Unpacked(packed, 1).empty());
  EXPECT_TRUE(Unpacked(packed, 3).empty());
}

TEST(PackedArrayTest, DamageIsRefusedUnlessItChangesNothing) {
  const std::vector<float> values = {1.0F, 2.0F, 3.0F};
  const std::string packed = Pack(values).bytes;
  EXPECT_TRUE(Unpacked(packed.substr(0, packed.size() - 1), 3).empty());
  EXPECT_TRUE(Unpacked(packed + "more", 3).empty());
  int refused = 0;
  for (size_t i = 0; i < 8 * packed.size(); ++i) {  // some bits only fill up bytes
    std::string damaged = packed;
    damaged[i / 8] = static_cast<char>(damaged[i / 8] ^ (1 << i % 8));
    const std::vector<float> unpacked = Unpacked(damaged, 3);
    EXPECT_TRUE(unpacked.empty() || unpacked == values) << "bit " << i;
    if (unpacked.empty()) ++refused;
  }
  EXPECT_GT(refused, 7 * static_cast<int>(packed.size()));
}

}  // namespace
}  // namespace soslam
