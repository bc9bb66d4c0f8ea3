// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/appearance/inner_layers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/onnx_network.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr int kInput = 28;  // four pixels for each of the pooled cells

// Two channels mixed from the three of the image, then x sigmoid(x) of these, as detectors have it,
// then what no program can run.
std::string SmallNetwork() {
  OnnxGraph graph;
  graph.Input("images", {1, 3, kInput, kInput}).Output("end", {1, 2, 1, 1});
  graph.Floats<float>("weights", {2, 3, 1, 1}, {1.0F, 0.0F, 0.0F, 0.0F, -0.5F, 0.25F})
      .Floats<float>("biases", {2}, {0.0F, 3.0F})
      .Node("Conv", {"images", "weights", "biases"}, "mixed",
            {OnnxGraph::Integers("kernel_shape", {1, 1})})
      .Node("Sigmoid", {"mixed"}, "gate")
      .Node("Mul", {"mixed", "gate"}, "swish")
      .Node("NoSuchOperator", {"swish"}, "strange")
      .Node("GlobalAveragePool", {"strange"}, "end");
  return graph.Onnx();
}

cv::Mat RandomImage(int side = kInput) {
  cv::Mat image(side, side, CV_8UC3);
  for (cv::Vec3b& pixel : cv::Mat_<cv::Vec3b>(image)) {
    for (int c = 0; c < 3; ++c) pixel[c] = static_cast<uchar>(RandomUniform(0, 256));
  }
  return image;
}

// Means over the cells, computed pixel by pixel.
template <typename Value>
std::vector<float> MeansOfCells(const cv::Mat& image, const Value& value) {
  std::vector<float> means;
  constexpr int kPixels = kInput / kPooledSide;
  for (int row = 0; row < kPooledSide; ++row) {
    for (int column = 0; column < kPooledSide; ++column) {
      double sum = 0.0;
      for (int i = 0; i < kPixels * kPixels; ++i) {
        sum +=
            value(image.at<cv::Vec3b>(kPixels * row + i / kPixels, kPixels * column + i % kPixels));
      }
      means.push_back(static_cast<float>(sum / (kPixels * kPixels)));
    }
  }
  return means;
}

double Swish(double x) { return x / (1.0 + std::exp(-x)); }

void ExpectChannel(const cv::Mat& features, int channel, const std::vector<float>& expected) {
  ASSERT_EQ(features.cols, kPooledSide * kPooledSide);
  for (int i = 0; i < features.cols; ++i) {
    EXPECT_NEAR(features.at<float>(channel, i), expected[i], 1e-3F * (1.0F + std::abs(expected[i])))
        << "channel " << channel << ", cell " << i;
  }
}

TEST(InnerLayers, FeaturesAreMeansOfTheTensorsOverCells) {
  const cv::Mat image = RandomImage();
  InnerLayers layers(SmallNetwork(), "small.onnx", {"mixed", "Mul 0"}, /*is_unit=*/false);
  const cv::Mat features = layers.Features(image);
  ASSERT_EQ(features.rows, 4);
  ASSERT_EQ(features.type(), CV_32F);
  const auto second = [](const cv::Vec3b& bgr) { return 3.0 - 0.5 * bgr[1] + 0.25 * bgr[2]; };
  ExpectChannel(features, 0, MeansOfCells(image, [](const cv::Vec3b& bgr) { return bgr[0]; }));
  ExpectChannel(features, 1, MeansOfCells(image, second));
  ExpectChannel(features, 2,
                MeansOfCells(image, [](const cv::Vec3b& bgr) { return Swish(bgr[0]); }));
  ExpectChannel(features, 3,
                MeansOfCells(image, [&](const cv::Vec3b& bgr) { return Swish(second(bgr)); }));
}

TEST(InnerLayers, NetworksOfUnitInputsTakeRedGreenBlue) {
  const cv::Mat image = RandomImage();
  InnerLayers layers(SmallNetwork(), "small.onnx", {"mixed"}, /*is_unit=*/true);
  const cv::Mat features = layers.Features(image);
  ExpectChannel(features, 0,
                MeansOfCells(image, [](const cv::Vec3b& bgr) { return bgr[2] / 255.0; }));
  ExpectChannel(features, 1, MeansOfCells(image, [](const cv::Vec3b& bgr) {
                  return 3.0 + (-0.5 * bgr[1] + 0.25 * bgr[0]) / 255.0;
                }));
}

TEST(CutNetwork, FindsTensorsByNameAndByPlace) {
  const NetworkPart part = CutNetwork(SmallNetwork(), "small.onnx", {"Mul 0", "gate", "Conv 0"});
  EXPECT_EQ(part.tensors, (std::vector<std::string>{"swish", "gate", "mixed"}));
  EXPECT_LT(part.bytes.size(), SmallNetwork().size());
  EXPECT_EQ(part.bytes.find("NoSuchOperator"), std::string::npos);
}

TEST(CutNetwork, RefusesWhatTheNetworkHasNot) {
  for (const char* tensor : {"Mul 1", "gat", "images", "weights"}) {
    ExpectError<InputError>([&] { CutNetwork(SmallNetwork(), "small.onnx", {tensor}); },
                            {"small.onnx", tensor});
  }
  ExpectError<InputError>([] { CutNetwork("no network", "small.onnx", {"mixed"}); },
                          {"small.onnx", "ONNX"});
}

TEST(InnerLayers, RefuseWhatCannotBeRun) {
  ExpectError<InputError>([] { InnerLayers(SmallNetwork(), "small.onnx", {"strange"}, false); },
                          {"small.onnx", "OpenCV"});
  InnerLayers layers(SmallNetwork(), "small.onnx", {"mixed"}, false);
  OnnxGraph flat;
  flat.Input("images", {1, 3, kInput, kInput}).Output("flat", {1, 3 * kInput * kInput});
  flat.Node("Flatten", {"images"}, "flat", {OnnxGraph::Integer("axis", 1)});
  InnerLayers of_flat(flat.Onnx(), "flat.onnx", {"flat"}, false);
  ExpectError<InputError>([&] { of_flat.Features(RandomImage()); },
                          {"flat.onnx", "'flat'", "2 dimensions", "expected 4"});
}

}  // namespace
}  // namespace soslam
