// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "soslam/image/detector.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/onnx_network.h"

namespace soslam {
namespace {

class NetworkFormatTest : public FolderTest {
 protected:
  NetworkFile Read(const std::string& bytes) { return ReadNetworkFile(Write("net.onnx", bytes)); }
  NetworkFormat Find(const std::string& bytes, int classes = 2, const cv::Size& image = {128, 96}) {
    return FindFormat(Read(bytes), classes, options_, image);
  }
  void ExpectFormat(const NetworkFormat& format, OutputLayout layout, PixelValues pixel_values,
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

TEST_F(NetworkFormatTest, NetworksOfUltralytics) {
  const auto rgb = PixelValues::kRgbUnit;
  ExpectFormat(Find(Ultralytics({1, 252, 7}).Onnx()), OutputLayout::kV5, rgb, {64, 64});
  ExpectFormat(Find(Ultralytics({1, 6, 84}).Onnx()), OutputLayout::kV8, rgb, {64, 64});
  ExpectFormat(Find(Ultralytics({1, 30, 6}).Onnx()), OutputLayout::kEndToEnd, rgb, {64, 64});
  MeanNetwork wide = Ultralytics({1, 378, 7});
  wide.input_width = 96;
  ExpectFormat(Find(wide.Onnx()), OutputLayout::kV5, rgb, {96, 64});
  // One candidate a cell, but not YOLOX: it has names.
  ExpectFormat(Find(Ultralytics({1, 84, 7}).Onnx()), OutputLayout::kV5, rgb, {64, 64});
}

TEST_F(NetworkFormatTest, ColumnsAfterTheClasses) {
  MeanNetwork network = Ultralytics({1, 9, 84});
  ExpectRefused(network.Onnx(), {"net.onnx", "[1, 9, 84]", "2 classes", "[1, 6, N]", "--labels"});
  network.has_masks = true;
  ExpectFormat(Find(network.Onnx()), OutputLayout::kV8, PixelValues::kRgbUnit, {64, 64}, 3);
  network = Ultralytics({1, 57, 84});
  network.metadata["task"] = "pose";
  ExpectFormat(Find(network.Onnx()), OutputLayout::kV8, PixelValues::kRgbUnit, {64, 64}, 51);
}

// With one class [1, N, 6] is both that of YOLOv5 and of a network that removes overlaps.
TEST_F(NetworkFormatTest, OneClass) {
  MeanNetwork network = Ultralytics({1, 252, 6});
  EXPECT_EQ(Find(network.Onnx(), 1).layout, OutputLayout::kV5);
  network.metadata["end2end"] = "True";
  EXPECT_EQ(Find(network.Onnx(), 1).layout, OutputLayout::kEndToEnd);
  EXPECT_EQ(Find(Ultralytics({1, 300, 6}).Onnx(), 1).layout, OutputLayout::kEndToEnd);
}

TEST_F(NetworkFormatTest, YoloxTakesTheShapeOfTheImage) {
  const auto bgr = PixelValues::kBgrByte;
  ExpectFormat(Find(GridNetwork{}.Onnx()), OutputLayout::kYolox, bgr, {128, 96});
  ExpectFormat(Find(GridNetwork{}.Onnx(), 2, {32, 32}), OutputLayout::kYolox, bgr, {64, 64});
  ExpectFormat(Find(GridNetwork{true}.Onnx()), OutputLayout::kV5, bgr, {64, 64});
  options_.input_width = 96;
  options_.input_height = 64;
  ExpectFormat(Find(GridNetwork{}.Onnx()), OutputLayout::kYolox, bgr, {96, 64});
}

// A network whose output does not depend on its input has as many candidates for any.
TEST_F(NetworkFormatTest, AnInputOfAnotherSizeIsGivenUpWhereTheOutputDoesNotFollow) {
  MeanNetwork network = {{1, 84, 7}, std::vector<float>(84 * 7, 0.1F), {}};
  ExpectFormat(Find(network.Onnx()), OutputLayout::kYolox, PixelValues::kBgrByte, {64, 64});
}

TEST_F(NetworkFormatTest, YoloV6HasAConstantObjectness) {
  MeanNetwork network = {{1, 84, 7}, std::vector<float>(84 * 7, 1.0F), {}};
  ExpectFormat(Find(network.Onnx()), OutputLayout::kV5, PixelValues::kRgbUnit, {64, 64});
}

TEST_F(NetworkFormatTest, OptionsContradict) {
  options_.output_layout = OutputLayout::kV8;
  options_.pixel_values = PixelValues::kBgrByte;
  ExpectFormat(Find(Ultralytics({1, 6, 7}).Onnx()), OutputLayout::kV8, PixelValues::kBgrByte,
               {64, 64});
  ExpectRefused(Ultralytics({1, 252, 7}).Onnx(), {"net.onnx", "[1, 252, 7]", "layout v8"});
  options_ = {};
  options_.input_width = 64;
  ExpectError<SettingsError>([&] { Find(GridNetwork{}.Onnx()); }, {"input_height_px"});
  options_.input_height = 32;
  ExpectRefused(GridNetwork{true}.Onnx(), {"net.onnx", "64 x 32", "its own is 64 x 64"});
}

TEST_F(NetworkFormatTest, OtherClassesAreRefused) {
  ExpectRefused(Ultralytics({1, 252, 85}).Onnx(),
                {"[1, 252, 85]", "for 2 classes", "[1, N, 7]", "it has 80 classes"});
  ExpectRefused(Ultralytics({1, 84, 525}).Onnx(), {"[1, 84, 525]", "it has 80 classes"});
}

TEST_F(NetworkFormatTest, OtherTasksAndInputsAreRefused) {
  MeanNetwork network = Ultralytics({1, 252, 7});
  for (const char* task : {"classify", "obb"}) {
    network.metadata["task"] = task;
    ExpectRefused(network.Onnx(), {"net.onnx", task, "expected detect"});
  }
  OnnxGraph graph = Ultralytics({1, 252, 7}).Graph();
  ExpectRefused(graph.Input("sizes", {1, 2}).Onnx(), {"net.onnx", "2 inputs", "sizes [1, 2]"});
  for (const char* name : {"orig_target_sizes", "im_shape", "scale_factor"}) {
    OnnxGraph sizes = Ultralytics({1, 252, 7}).Graph();
    EXPECT_NO_THROW(Read(sizes.Input(name, {1, 2}).Onnx()));
  }
  OnnxGraph absurd = Ultralytics({1, 252, 7}).Graph();
  EXPECT_NO_THROW(Read(absurd.Input("pixel_mask", {1, 1 << 30, 1 << 30}).Onnx()));
  OnnxGraph bytes;
  constexpr int kUint8 = 2;
  ExpectRefused(bytes.Input("images", {1, 3, 64, 64}, kUint8).Onnx(), {"type 2"});
  OnnxGraph last_channel;
  ExpectRefused(last_channel.Input("images", {1, 64, 64, 3}).Onnx(), {"[1, 64, 64, 3]"});
}

// A transformer with these outputs for one box, and two labels unless stated otherwise.
ConstantNetwork Transformer(const std::vector<float>& logits, const std::string& name = "logits",
                            const std::string& boxes = "pred_boxes") {
  const auto classes = static_cast<std::int64_t>(logits.size());
  return {{{name, {1, 1, classes}, logits}, {boxes, {1, 1, 4}, {0.5F, 0.5F, 0.1F, 0.1F}}}};
}

TEST_F(NetworkFormatTest, TransformersAreToldByTheirOutputs) {
  const auto imagenet = PixelValues::kRgbImageNet;
  for (const int unused : {0, 1}) {
    std::vector<float> logits(2 + unused, -5.0F);
    ExpectFormat(Find(Transformer(logits, "labels", "dets").Onnx()), OutputLayout::kDetr, imagenet,
                 {64, 64}, unused);
  }
  options_.pixel_values = imagenet;
  const auto layout = [&](const std::vector<float>& logits) {
    return Find(Transformer(logits).Onnx()).layout;
  };
  EXPECT_EQ(layout({-5, -4}), OutputLayout::kDetr);
  EXPECT_EQ(layout({-5, -4, 3}), OutputLayout::kDetrSoftmax);
}

// Nothing in a file says whether ImageNet's mean is subtracted, or which of the logits is too many.
TEST_F(NetworkFormatTest, WhatTransformersDoNotSayIsAskedFor) {
  ExpectError<SettingsError>(
      [&] {
        Find(Transformer({-5, -4}).Onnx());
      },
      {"net.onnx", "pixel_values", "rgb_0_1", "rgb_imagenet"});
  options_.pixel_values = PixelValues::kRgbUnit;
  ConstantNetwork any_size = Transformer({-5, -4});
  any_size.input_width = any_size.input_height = 0;
  ExpectError<SettingsError>([&] { Find(any_size.Onnx()); },
                             {"net.onnx", "not fixed", "input_width_px"});
  options_.input_width = options_.input_height = 64;
  EXPECT_EQ(Find(any_size.Onnx()).input, cv::Size(64, 64));
  ExpectRefused(Transformer({-5, -4, -3}).Onnx(),
                {"3 logits for 2 labels", "is not that of no object", "detr_softmax", "--labels"});
  ExpectRefused(Transformer({-5, 4}).Onnx(), {"2 logits for 2 labels", "is that of no object"});
  ExpectRefused(Transformer(std::vector<float>(91, -5)).Onnx(),
                {"logits [1, 1, 91]", "for 2 classes", "it has 91 classes, --labels"});
  options_.output_layout = OutputLayout::kDetr;
  ExpectFormat(Find(Transformer({-5, -4, -3}).Onnx()), OutputLayout::kDetr, PixelValues::kRgbUnit,
               {64, 64}, 1);
  options_.output_layout = OutputLayout::kV5;
  ExpectRefused(Transformer({-5, -4}).Onnx(), {"logits [1, 1, 2], pred_boxes", "layout v5"});
}

TEST_F(NetworkFormatTest, PaddleIsToldByShapes) {
  options_.pixel_values = PixelValues::kRgbImageNet;
  const std::vector<float> zeros(12, 0.0F);
  const auto layout = [&](const std::vector<std::int64_t>& shape,
                          const std::vector<std::int64_t>& other) {
    return Find(ConstantNetwork{{{"a", shape, zeros}, {"b", other, zeros}}}.Onnx()).layout;
  };
  EXPECT_EQ(layout({1, 3, 4}, {2, 6}), OutputLayout::kPaddleNms);
  ConstantNetwork plain = {
      {{"a", {1, 2, 3}, std::vector<float>(6, 0.0F)}, {"b", {1, 3, 4}, zeros}}};
  EXPECT_EQ(Find(plain.Onnx()).outputs, (std::vector{1, 0}));
  plain.outputs[0].shape = {1, 3, 2};  // raw outputs, and any transformer without names
  ExpectRefused(plain.Onnx(), {"a [1, 3, 2], b [1, 3, 4]", "PaddleDetection"});
}

// Networks that OpenCV does not run are named with the command that exports one that it runs.
TEST_F(NetworkFormatTest, WhatOpenCvDoesNotRunIsNamed) {
  const std::string command =
      "yolo export model=net.pt format=onnx opset=12 imgsz=64,64 half=False dynamic=False";
  const auto with = [](const std::string& type) {
    return Ultralytics({1, 252, 7}).Graph().Node(type, {"output"}, "other");
  };
  ExpectRefused(with("DynamicQuantizeLinear").Onnx(), {"net.onnx", "int8", command});
  ExpectRefused(with("TopK").Onnx(), {"net.onnx", "end to end", command, "end2end=False"});
  ExpectRefused(with("GridSample").Onnx(),
                {"net.onnx", "transformer", "boxes from a file", "--backend onnxruntime"});
  OnnxGraph half = Ultralytics({1, 252, 7}).Graph();
  half.Tensor("half", OnnxGraph::kHalf, {1}, "ab").Node("Add", {"output", "half"}, "other");
  ExpectRefused(half.Onnx(), {"net.onnx", "16-bit", command});
}

// What is no reason by itself is named where OpenCV fails, here on a node that it does not know.
TEST_F(NetworkFormatTest, LikelyReasonsAreNamedWhereOpenCvFails) {
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

TEST_F(NetworkFormatTest, AnInputOfNoFixedSizeTakesTheShapeOfTheImage) {
  OnnxGraph graph;
  graph.Input("images", {0, 3, 0, 0}).Output("output", {0, 0, 7});
  AddMeans("numbers", std::vector<float>(14, 0.1F), {}, "numbers_weights", &graph);
  graph.Node("Reshape", {"numbers", "shape"}, "output").Int64s("shape", {1, 2, 7});
  ExpectFormat(Find(graph.Onnx(), 2, {1000, 500}), OutputLayout::kV5, PixelValues::kRgbUnit,
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
