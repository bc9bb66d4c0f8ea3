// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/network_output.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/labelled_boxes.h"
#include "support/lists.h"

namespace soslam {
namespace {

cv::Mat Output(const std::vector<int>& shape, const std::vector<float>& values) {
  return cv::Mat(shape, CV_32FC1, const_cast<float*>(values.data())).clone();
}

NetworkFormat Format(OutputLayout layout, int extra_columns = 0) {
  return {layout, PixelValues::kRgbUnit, {64, 32}, 2, extra_columns};
}

std::vector<NetworkDetection> Read(const cv::Mat& output, OutputLayout layout,
                                   double min_score = 0.25) {
  return ReadNetworkOutput({output}, Format(layout), min_score, "net.onnx");
}

template <typename Error = InputError>
void ExpectRefused(OutputLayout layout, const std::vector<int>& shape,
                   const std::vector<float>& values, const std::vector<std::string>& words) {
  ExpectError<Error>([&] { Read(Output(shape, values), layout); }, words);
}

void ExpectScored(const NetworkDetection& box, int class_index, double score, const Box& expected) {
  EXPECT_EQ(box.class_index, class_index);
  EXPECT_NEAR(box.score, score, 1e-6);
  ExpectBox(box.box, expected);
}

TEST(NetworkOutputTest, EndToEndHasCornersScoreAndClass) {
  const cv::Mat output = Output({1, 3, 6}, {90, 45, 110, 55, 0.4F, 1,  //
                                            0, 0, 0, 0, 0, 0,          // padding
                                            8, 7, 12, 13, 1, 0});
  const auto boxes = Read(output, OutputLayout::kEndToEnd);
  ASSERT_EQ(boxes.size(), 2u);
  ExpectScored(boxes[0], 1, 0.4, {90, 45, 110, 55});
  ExpectScored(boxes[1], 0, 1.0, {8, 7, 12, 13});
}

TEST(NetworkOutputTest, ColumnsAfterTheClassesAreIgnored) {
  const cv::Mat v5 = Output({1, 1, 9}, {100, 50, 20, 10, 0.8F, 0.1F, 0.5F, 7, -9});
  const cv::Mat v8 = Output({1, 8, 1}, {100, 50, 20, 10, 0.1F, 0.4F, 7, -9});
  for (const auto& [layout, output] : {std::pair(OutputLayout::kV5, v5), {OutputLayout::kV8, v8}}) {
    const auto boxes = ReadNetworkOutput({output}, Format(layout, 2), 0.25, "net.onnx");
    ExpectScored(Only(boxes), 1, 0.4, {90, 45, 110, 55});
  }
}

// Logits of ln 3, 0 and -ln 3 are scores of 3/4, 1/2 and 1/4, or shares of 9/13, 3/13 and 1/13.
TEST(NetworkOutputTest, LogitsAreScoresOrShares) {
  const float log_3 = std::log(3.0F);
  const cv::Mat boxes = Output({1, 1, 4}, {0.5F, 0.25F, 0.25F, 0.5F});
  const cv::Mat logits = Output({1, 1, 3}, {0.0F, log_3, -log_3});
  const auto read = [&](OutputLayout layout, int extra_columns) {
    NetworkFormat format = Format(layout, extra_columns);
    format.outputs = {1, 0};
    return Only(ReadNetworkOutput({logits, boxes}, format, 0.25, "net.onnx"));
  };
  const Box box{24, 0, 40, 16};  // of 64 x 32
  ExpectScored(read(OutputLayout::kDetr, 1), 1, 0.75, box);
  ExpectScored(read(OutputLayout::kDetrSoftmax, 0), 1, 9.0 / 13.0, box);
}

TEST(NetworkOutputTest, ProbabilitiesAreNotTakenForLogits) {
  const std::vector<cv::Mat> outputs = {Output({1, 1, 4}, {0.5F, 0.5F, 0.25F, 0.25F}),
                                        Output({1, 1, 2}, {0.1F, 0.9F})};
  NetworkFormat format = Format(OutputLayout::kDetr);
  format.outputs = {0, 1};
  ExpectError<InputError>([&] { ReadNetworkOutput(outputs, format, 0.25, "net.onnx"); },
                          {"net.onnx", "probabilities", "sigmoid"});
}

TEST(NetworkOutputTest, NoCandidatesAreNoDetections) {
  EXPECT_TRUE(Read(cv::Mat(0, 6, CV_32FC1), OutputLayout::kPaddleNms).empty());
  NetworkFormat format = Format(OutputLayout::kDetr);
  format.outputs = {0, 1};
  const std::vector<cv::Mat> outputs = {cv::Mat(std::vector{1, 0, 4}, CV_32FC1),
                                        cv::Mat(std::vector{1, 0, 2}, CV_32FC1)};
  EXPECT_TRUE(ReadNetworkOutput(outputs, format, 0.25, "net.onnx").empty());
}

// Each message says what the output was taken for.
TEST(NetworkOutputTest, ImpossibleCandidatesAreRefused) {
  const auto expect_refused = [](OutputLayout layout, const std::vector<float>& row,
                                 const std::string& word) {
    ExpectRefused(layout, {1, 1, static_cast<int>(row.size())}, row,
                  {"net.onnx", "candidate 0", word, "rgb_0_1", "64 x 32", "layout"});
  };
  expect_refused(OutputLayout::kV5, {30, 20, -8, 10, 1, 1, 0}, "-8 x 10 pixels");
  expect_refused(OutputLayout::kV5, {30, 20, 8, -10, 1, 1, 0}, "8 x -10 pixels");
  expect_refused(OutputLayout::kV5, {30, 20, 8, 10, 4, 3, 0}, "score 12");
  expect_refused(OutputLayout::kEndToEnd, {30, 20, 8, 10, 0.5F, 0}, "-22 x -10 pixels");
  expect_refused(OutputLayout::kEndToEnd, {8, 10, 30, 20, 0.5F, 0.5F}, "no class");
  expect_refused(OutputLayout::kEndToEnd, {8, 10, 30, 20, 0.5F, 2}, "no class");
  expect_refused(OutputLayout::kEndToEnd, {8, 10, 30, 20, 0.5F, -1}, "no class");
}

// An input of 64 x 32 has grids of 8 x 4, 4 x 2 and 2 x 1 cells.
TEST(NetworkOutputTest, YoloxHasBoxesInCellsOfItsGrids) {
  std::vector<float> values(42 * 7, 0.0F);
  const auto set = [&](size_t candidate, const std::vector<float>& row) {
    std::copy(row.begin(), row.end(), values.begin() + static_cast<long>(7 * candidate));
  };
  set(8 + 3, {0.5F, 0.25F, 0, 0.5F, 0.8F, 0.1F, 0.5F});  // column 3, row 1 of the first grid
  set(32 + 6, {0, 0.5F, 0, 0, 1, 1, 0});                 // column 2, row 1 of the second
  set(40 + 1, {-0.5F, 0.5F, 0, -0.5F, 1, 0.5F, 0});      // column 1 of the third
  const auto boxes = Read(Output({1, 42, 7}, values), OutputLayout::kYolox);
  ASSERT_EQ(boxes.size(), 3u);
  const double half = 4 * std::exp(0.5F), wide = 16 * std::exp(-0.5F);
  ExpectScored(boxes[0], 1, 0.4, {24, 10 - half, 32, 10 + half});
  ExpectScored(boxes[1], 0, 1.0, {24, 16, 40, 32});
  ExpectScored(boxes[2], 0, 0.5, {0, 16 - wide, 32, 16 + wide});
}

TEST(NetworkOutputTest, YoloxOfAnotherInputIsRefused) {
  for (const int candidates : {41, 43}) {
    const std::vector<float> zeros(static_cast<size_t>(candidates) * 7, 0.0F);
    ExpectRefused(OutputLayout::kYolox, {1, candidates, 7}, zeros,
                  {"net.onnx", fmt::format("{} candidates; expected 42", candidates), "64 x 32"});
  }
}

TEST(NetworkOutputTest, BoxesInCellsAreNotTakenForPixels) {
  std::vector<float> values(42 * 7, 1.0F);
  values[3] = 7.5F;
  ExpectRefused(OutputLayout::kV5, {1, 42, 7}, values,
                {"net.onnx", "7.50; expected pixels", "output_layout = yolox"});
  values[3] = 8.0F;
  EXPECT_EQ(Read(Output({1, 42, 7}, values), OutputLayout::kV5).size(), 42u);
}

TEST(NetworkOutputTest, BoxesInPixelsAreNotTakenForCells) {
  std::vector<float> values(42 * 7, 0.5F);
  values[2] = 30.0F;
  ExpectRefused(OutputLayout::kYolox, {1, 42, 7}, values,
                {"net.onnx", "30.00; expected logarithms", "output_layout = v5"});
}

TEST(NetworkOutputTest, OtherShapesAreRefused) {
  const std::vector<float> zeros(600, 0.0F);
  const std::vector<std::vector<int>> wrong_for_v5 = {{1, 6, 30}, {1, 30, 6}, {1, 30, 8},
                                                      {2, 30, 7}, {30, 7},    {1, 1, 30, 7}};
  for (const auto& shape : wrong_for_v5) {
    ExpectRefused(OutputLayout::kV5, shape, zeros,
                  {"net.onnx", fmt::format("[{}]", fmt::join(shape, ", ")),
                   "[1, N, 7] of layout v5 with 2 classes"});
  }
  ExpectRefused(OutputLayout::kV8, {1, 30, 7}, zeros, {"[1, 30, 7]", "[1, 6, N] of layout v8"});
}

TEST(NetworkOutputTest, NumbersThatAreNotFiniteAreRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const std::vector<float>& row :
       {std::vector<float>{5, nan, 2, 2, 1, 1, 0}, std::vector<float>{5, 5, 2, 2, nan, 1, 0}}) {
    ExpectRefused<NumericalError>(OutputLayout::kV5, {1, 1, 7}, row, {"net.onnx", "candidate 0"});
  }
}

// Boxes of 10 x 10: shifted by 2 the IoU is 80 / 120, by 5 it is 50 / 150.
TEST(WithoutOverlapsTest, HighestScoreOfAClassWins) {
  const auto box = [](int class_index, double score, double x) {
    return NetworkDetection{class_index, score, {x, 0, x + 10, 10}};
  };
  const auto kept = WithoutOverlaps(
      {box(0, 0.5, 0), box(0, 0.9, 2), box(1, 0.6, 0), box(0, 0.7, 7)}, {0, 1}, 0.45);
  ASSERT_EQ(kept.size(), 3u);
  ExpectScored(kept[0], 0, 0.9, {2, 0, 12, 10});
  ExpectScored(kept[1], 0, 0.7, {7, 0, 17, 10});
  ExpectScored(kept[2], 1, 0.6, {0, 0, 10, 10});
  EXPECT_EQ(WithoutOverlaps({box(0, 0.5, 0), box(0, 0.9, 2)}, {0, 1}, 0.7).size(), 2u);
  EXPECT_TRUE(WithoutOverlaps({}, {0, 1}, 0.45).empty());
}

TEST(WithoutOverlapsTest, ClassesOfOneGroupCountAsOne) {
  const std::vector<NetworkDetection> boxes = {
      {0, 0.5, {0, 0, 10, 10}}, {1, 0.9, {0, 0, 10, 10}}, {2, 0.6, {0, 0, 10, 10}}};
  const auto kept = WithoutOverlaps(boxes, {0, 0, 1}, 0.45);
  EXPECT_EQ(Fields(kept, &NetworkDetection::class_index), (std::vector{1, 2}));
}

}  // namespace
}  // namespace soslam
