// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/error.h"
#include "image/yolo_detector.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/onnx_network.h"

namespace soslam {
namespace {

class YoloFormatTest : public FolderTest {
 protected:
  NetworkFile Read(const std::string& bytes) { return ReadNetworkFile(Write("net.onnx", bytes)); }
  YoloFormat Find(const std::string& bytes, int classes = 2, const cv::Size& image = {128, 96}) {
    return FindFormat(Read(bytes), classes, options_, image);
  }
  void ExpectFormat(const YoloFormat& format, YoloLayout layout, PixelValues pixel_values,
                    const cv::Size& input, int extra_columns = 0) {
    EXPECT_EQ(format.layout, layout);
    EXPECT_EQ(format.pixel_values, pixel_values);
    EXPECT_EQ(format.input, input);
    EXPECT_EQ(format.extra_columns, extra_columns);
  }
  void ExpectRefused(const std::string& bytes, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Find(bytes); }, words);
  }

  DetectorOptions options_;
};

// A network of Ultralytics' with an output of this shape.
MeanNetwork Ultralytics(const std::vector<std::int64_t>& shape) {
  MeanNetwork network;
  network.output_shape = shape;
  network.constants.resize(static_cast<size_t>(shape[1] * shape[2]), 0.1F);
  network.metadata["names"] = "{0: 'cup', 1: 'book'}";
  return network;
}

TEST_F(YoloFormatTest, NetworksOfUltralytics) {
  const auto rgb = PixelValues::kRgbUnit;
  ExpectFormat(Find(Ultralytics({1, 252, 7}).Onnx()), YoloLayout::kV5, rgb, {64, 64});
  ExpectFormat(Find(Ultralytics({1, 6, 84}).Onnx()), YoloLayout::kV8, rgb, {64, 64});
  ExpectFormat(Find(Ultralytics({1, 30, 6}).Onnx()), YoloLayout::kEndToEnd, rgb, {64, 64});
  MeanNetwork wide = Ultralytics({1, 378, 7});
  wide.input_width = 96;
  ExpectFormat(Find(wide.Onnx()), YoloLayout::kV5, rgb, {96, 64});
  // One candidate a cell, but not YOLOX: it has names.
  ExpectFormat(Find(Ultralytics({1, 84, 7}).Onnx()), YoloLayout::kV5, rgb, {64, 64});
}

TEST_F(YoloFormatTest, ColumnsAfterTheClasses) {
  MeanNetwork network = Ultralytics({1, 9, 84});
  ExpectRefused(network.Onnx(), {"net.onnx", "[1, 9, 84]", "2 classes", "[1, 6, N]", "--labels"});
  network.has_masks = true;
  ExpectFormat(Find(network.Onnx()), YoloLayout::kV8, PixelValues::kRgbUnit, {64, 64}, 3);
  network = Ultralytics({1, 57, 84});
  network.metadata["task"] = "pose";
  ExpectFormat(Find(network.Onnx()), YoloLayout::kV8, PixelValues::kRgbUnit, {64, 64}, 51);
}

// With one class [1, N, 6] is both that of YOLOv5 and of a network that removes overlaps.
TEST_F(YoloFormatTest, OneClass) {
  MeanNetwork network = Ultralytics({1, 252, 6});
  EXPECT_EQ(Find(network.Onnx(), 1).layout, YoloLayout::kV5);
  network.metadata["end2end"] = "True";
  EXPECT_EQ(Find(network.Onnx(), 1).layout, YoloLayout::kEndToEnd);
  EXPECT_EQ(Find(Ultralytics({1, 300, 6}).Onnx(), 1).layout, YoloLayout::kEndToEnd);
}

TEST_F(YoloFormatTest, YoloxTakesTheShapeOfTheImage) {
  const auto bgr = PixelValues::kBgrByte;
  ExpectFormat(Find(GridNetwork{}.Onnx()), YoloLayout::kYolox, bgr, {128, 96});
  ExpectFormat(Find(GridNetwork{}.Onnx(), 2, {32, 32}), YoloLayout::kYolox, bgr, {64, 64});
  ExpectFormat(Find(GridNetwork{true}.Onnx()), YoloLayout::kV5, bgr, {64, 64});
  options_.input_width = 96;
  options_.input_height = 64;
  ExpectFormat(Find(GridNetwork{}.Onnx()), YoloLayout::kYolox, bgr, {96, 64});
}

// A network whose output does not depend on its input has as many candidates for any.
TEST_F(YoloFormatTest, AnInputOfAnotherSizeIsGivenUpWhereTheOutputDoesNotFollow) {
  MeanNetwork network = {{1, 84, 7}, std::vector<float>(84 * 7, 0.1F), {}};
  ExpectFormat(Find(network.Onnx()), YoloLayout::kYolox, PixelValues::kBgrByte, {64, 64});
}

TEST_F(YoloFormatTest, YoloV6HasAConstantObjectness) {
  MeanNetwork network = {{1, 84, 7}, std::vector<float>(84 * 7, 1.0F), {}};
  ExpectFormat(Find(network.Onnx()), YoloLayout::kV5, PixelValues::kRgbUnit, {64, 64});
}

TEST_F(YoloFormatTest, OptionsContradict) {
  options_.output_layout = YoloLayout::kV8;
  options_.pixel_values = PixelValues::kBgrByte;
  ExpectFormat(Find(Ultralytics({1, 6, 7}).Onnx()), YoloLayout::kV8, PixelValues::kBgrByte,
               {64, 64});
  ExpectRefused(Ultralytics({1, 252, 7}).Onnx(), {"net.onnx", "[1, 252, 7]", "layout v8"});
  options_ = {};
  options_.input_width = 64;
  ExpectError<SettingsError>([&] { Find(GridNetwork{}.Onnx()); }, {"input_height_px"});
  options_.input_height = 32;
  ExpectRefused(GridNetwork{true}.Onnx(), {"net.onnx", "64 x 32", "its own is 64 x 64"});
}

TEST_F(YoloFormatTest, OtherClassesAreRefused) {
  ExpectRefused(Ultralytics({1, 252, 85}).Onnx(),
                {"[1, 252, 85]", "for 2 classes", "[1, N, 7]", "it has 80 classes"});
  ExpectRefused(Ultralytics({1, 84, 525}).Onnx(), {"[1, 84, 525]", "it has 80 classes"});
}

TEST_F(YoloFormatTest, OtherTasksAndInputsAreRefused) {
  MeanNetwork network = Ultralytics({1, 252, 7});
  for (const char* task : {"classify", "obb"}) {
    network.metadata["task"] = task;
    ExpectRefused(network.Onnx(), {"net.onnx", task, "expected detect"});
  }
  OnnxGraph graph = Ultralytics({1, 252, 7}).Graph();
  ExpectRefused(graph.Input("sizes", {1, 2}).Onnx(), {"net.onnx", "2 inputs"});
  OnnxGraph bytes;
  constexpr int kUint8 = 2;
  ExpectRefused(bytes.Input("images", {1, 3, 64, 64}, kUint8).Onnx(), {"type 2"});
  OnnxGraph last_channel;
  ExpectRefused(last_channel.Input("images", {1, 64, 64, 3}).Onnx(), {"[1, 64, 64, 3]"});
}

// Networks that OpenCV does not run are named with the command that exports one that it runs.
TEST_F(YoloFormatTest, WhatOpenCvDoesNotRunIsNamed) {
  const std::string command =
      "yolo export model=net.pt format=onnx opset=12 imgsz=64,64 half=False dynamic=False";
  const auto with = [](const std::string& type) {
    return Ultralytics({1, 252, 7}).Graph().Node(type, {"output"}, "other");
  };
  ExpectRefused(with("DynamicQuantizeLinear").Onnx(), {"net.onnx", "int8", command});
  ExpectRefused(with("TopK").Onnx(), {"net.onnx", "end to end", command, "end2end=False"});
  ExpectRefused(with("GridSample").Onnx(), {"net.onnx", "transformer", "boxes from a file"});
  OnnxGraph half = Ultralytics({1, 252, 7}).Graph();
  half.Tensor("half", OnnxGraph::kHalf, {1}, "ab").Node("Add", {"output", "half"}, "other");
  ExpectRefused(half.Onnx(), {"net.onnx", "16-bit", command});
}

// What is no reason by itself is named where OpenCV fails, here on a node that it does not know.
TEST_F(YoloFormatTest, LikelyReasonsAreNamedWhereOpenCvFails) {
  OnnxGraph graph;
  graph.Input("images", {1, 3, 0, 0}).Output("output", {1, 0, 7});
  graph.Node("NoSuchOperator", {"images"}, "output");
  ExpectRefused(graph.Onnx(), {"net.onnx", "not fixed", "imgsz=480,640", "NoSuchOperator"});
  const auto unknown = [](const std::string& type) {
    return Ultralytics({1, 252, 7}).Graph().Node(type, {"output"}, "other");
  };
  ExpectRefused(unknown("NoSuchOperator").Onnx({}, 17), {"opset 17", "opset=12"});
  EXPECT_NO_THROW(Find(Ultralytics({1, 252, 7}).Graph().Onnx({}, 17)));
}

TEST_F(YoloFormatTest, AnInputOfNoFixedSizeTakesTheShapeOfTheImage) {
  OnnxGraph graph;
  graph.Input("images", {0, 3, 0, 0}).Output("output", {0, 0, 7});
  AddMeans("numbers", std::vector<float>(14, 0.1F), {}, "numbers_weights", &graph);
  graph.Node("Reshape", {"numbers", "shape"}, "output").Int64s("shape", {1, 2, 7});
  ExpectFormat(Find(graph.Onnx(), 2, {1000, 500}), YoloLayout::kV5, PixelValues::kRgbUnit,
               {992, 512});
}

TEST(ImageShapedInputTest, HasTheShapeOfTheImageAndAUsualArea) {
  const cv::Size own(416, 416);
  EXPECT_EQ(ImageShapedInput({640, 480}, own), cv::Size(640, 480));
  EXPECT_EQ(ImageShapedInput({1242, 375}, own), cv::Size(1248, 384));
  EXPECT_EQ(ImageShapedInput({4000, 3000}, own), cv::Size(832, 608));
  EXPECT_EQ(ImageShapedInput({3000, 4000}, own), cv::Size(608, 832));
  EXPECT_EQ(ImageShapedInput({320, 240}, own), cv::Size(480, 352));
  EXPECT_EQ(ImageShapedInput({4000, 3000}, {1280, 1280}), cv::Size(1472, 1120));
  EXPECT_EQ(ImageShapedInput({10000, 20}, own), cv::Size(10016, 32));
}

}  // namespace
}  // namespace soslam
