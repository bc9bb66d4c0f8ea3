// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/yolo_boxes.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

// Rows of an image each, with these extras.
std::vector<YoloRow> Rows(const std::vector<std::vector<double>>& extras) {
  std::vector<YoloRow> rows;
  for (const auto& numbers : extras) {
    const std::string name = std::to_string(rows.size());
    rows.push_back({name + ".txt:1", name, 0, {}, numbers});
  }
  return rows;
}

std::vector<YoloRow> Read(const std::vector<std::vector<double>>& extras) {
  std::vector<YoloRow> rows = Rows(extras);
  ReadYoloExtras(&rows);
  return rows;
}

void ExpectRefused(const std::vector<std::vector<double>>& extras,
                   const std::vector<std::string>& words) {
  ExpectError<InputError>([&] { Read(extras); }, words);
}

TEST(YoloColumnsTest, OneExtraIsAConfidenceIfAllCanBe) {
  const auto rows = Read({{0.5}, {1}, {}, {0}});
  EXPECT_EQ(rows[0].score, 0.5);
  EXPECT_EQ(rows[2].score, 1.0);
  EXPECT_FALSE(rows[0].track);
  EXPECT_FALSE(Read({{1}, {1}})[0].track);
}

TEST(YoloColumnsTest, OrElseATrack) {
  const auto rows = Read({{1}, {-1}, {2}, {}, {1}});
  EXPECT_EQ(rows[0].track, 1);
  EXPECT_EQ(rows[1].track, -1);
  EXPECT_EQ(rows[0].score, 1.0);
  EXPECT_FALSE(rows[3].track);
}

TEST(YoloColumnsTest, TwoExtrasInEitherOrder) {
  const auto ultralytics = Read({{0.5, 3}, {1, 2}, {0.25}, {}});
  EXPECT_EQ(ultralytics[0].track, 3);
  EXPECT_EQ(ultralytics[0].score, 0.5);
  EXPECT_EQ(ultralytics[1].track, 2);
  EXPECT_EQ(ultralytics[2].score, 0.25);
  EXPECT_FALSE(ultralytics[2].track);
  const auto others = Read({{3, 0.5}, {2, 1}});
  EXPECT_EQ(others[0].track, 3);
  EXPECT_EQ(others[1].score, 1.0);
  const auto either = Read({{1, 0}, {0, 1}});
  EXPECT_EQ(either[1].track, 1);
  EXPECT_EQ(either[1].score, 0.0);
}

TEST(YoloColumnsTest, ContradictionsAreNamed) {
  ExpectRefused({{0.5}, {3}}, {"1.txt:1", "sixth number 3", "confidence from 0 to 1"});
  ExpectRefused({{0.5}, {1.5}}, {"1.txt:1", "1.5"});
  ExpectRefused({{3}, {-2}}, {"0.txt:1", "3"});
  ExpectRefused({{0.5, 3}, {2, 0.5}}, {"1.txt:1", "2 0.5", "one order"});
  ExpectRefused({{0.2, 0.3}, {0.4, 0.5}}, {"0.txt:1", "0.2 0.3", "segmentation"});
  ExpectRefused({{0.5, 3}, {4}}, {"1.txt:1", "sixth number 4", "beside a track"});
}

TEST(YoloColumnsTest, NoImageHasATrackTwice) {
  auto rows = Rows({{97}, {88}, {97}});
  rows[2].image = rows[0].image;
  ExpectError<InputError>([&] { ReadYoloExtras(&rows); }, {"2.txt:1", "97 twice in one image"});
}

}  // namespace
}  // namespace soslam
