// SPDX-License-Identifier: BSD-3-Clause
#include "image/onnx_header.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/onnx_network.h"

namespace soslam {
namespace {

using Shape = std::vector<std::int64_t>;

OnnxHeader Read(const std::string& bytes) { return ReadOnnxHeader(bytes, "net.onnx"); }

TEST(OnnxHeaderTest, SaysWhatTheFileDeclares) {
  MeanNetwork network = {{1, 2, 7}, std::vector<float>(14), {}, 96, 32};
  network.metadata = {{"task", "segment"}};
  network.has_masks = true;
  network.opset = 17;
  const OnnxHeader header = Read(network.Onnx());
  ASSERT_EQ(header.inputs.size(), 1u);
  EXPECT_EQ(header.inputs[0].name, "images");
  EXPECT_EQ(header.inputs[0].type, OnnxValue::kFloat);
  EXPECT_EQ(header.inputs[0].shape, (Shape{1, 3, 32, 96}));
  ASSERT_EQ(header.outputs.size(), 2u);
  EXPECT_EQ(header.outputs[0].shape, (Shape{1, 2, 7}));
  EXPECT_EQ(header.outputs[1].shape, (Shape{1, 3, 1, 1}));
  EXPECT_EQ(header.opset, 17);
  EXPECT_EQ(header.operators, (std::set<std::string>{"Conv", "GlobalAveragePool", "Reshape"}));
  EXPECT_FALSE(header.has_half_weights);
  EXPECT_EQ(header.metadata.at("task"), "segment");
}

TEST(OnnxHeaderTest, WeightsAreNoInputs) {
  OnnxGraph graph;
  graph.Input("weights", {1}).Floats<float>("weights", {1}, {1}).Input("images", {0, 3, 0, 640});
  const OnnxHeader header = Read(graph.Onnx());
  ASSERT_EQ(header.inputs.size(), 1u);
  EXPECT_EQ(ShapeText(header.inputs[0].shape), "[?, 3, ?, 640]");
}

TEST(OnnxHeaderTest, HalfPrecisionIsFoundInWeightsAndConstants) {
  OnnxGraph weights, constants;
  weights.Tensor("weights", OnnxGraph::kHalf, {1}, "ab");
  EXPECT_TRUE(Read(weights.Onnx()).has_half_weights);
  const auto tensor = ProtoMessage().Integer(2, OnnxGraph::kHalf).Text(9, "ab");
  constants.Node("Constant", {}, "number", {ProtoMessage().Text(1, "value").Message(5, tensor)});
  EXPECT_TRUE(Read(constants.Onnx()).has_half_weights);
}

TEST(OnnxHeaderTest, DamagedFilesAreRefused) {
  const std::string whole = MeanNetwork{{1, 1, 7}, std::vector<float>(7), {}}.Onnx();
  for (size_t size = 1; size < 6; ++size) {
    ExpectError<InputError>([&] { Read(whole.substr(0, whole.size() - size)); }, {"net.onnx"});
  }
  ExpectError<InputError>([] { Read(""); }, {"net.onnx", "no graph"});
  ExpectError<InputError>([] { Read(ProtoMessage().Integer(1, 7).bytes()); }, {"no graph"});
  OnnxGraph many;
  for (int i = 0; i < 1001; ++i) many.Output("output", {});
  ExpectError<InputError>([&] { Read(many.Onnx()); }, {"too many"});
  OnnxGraph deep;
  deep.Output("output", Shape(33, 1));
  ExpectError<InputError>([&] { Read(deep.Onnx()); }, {"too many sides"});
}

}  // namespace
}  // namespace soslam
