// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/onnx_header.h"

#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/lists.h"
#include "support/onnx_network.h"

namespace soslam {
namespace {

using Shape = std::vector<std::int64_t>;

OnnxHeader Read(const std::string& bytes) { return ReadOnnxHeader(bytes, "net.onnx"); }

TEST(OnnxHeaderTest, WeightsAreNoInputs) {
  OnnxGraph graph;
  graph.Input("weights", {1}).Floats<float>("weights", {1}, {1}).Input("images", {0, 3, 0, 640});
  EXPECT_EQ(ShapeText(Only(Read(graph.Onnx()).inputs).shape), "[?, 3, ?, 640]");
}

TEST(OnnxHeaderTest, HalfPrecisionIsFoundInWeightsAndConstants) {
  OnnxGraph weights, constants;
  weights.Tensor("weights", OnnxGraph::kHalf, {1}, "ab");
  EXPECT_TRUE(Read(weights.Onnx()).has_half_weights);
  const auto tensor = ProtoMessage().Integer(2, OnnxGraph::kHalf).Text(9, "ab");
  constants.Node("Constant", {}, "number", {ProtoMessage().Text(1, "value").Message(5, tensor)});
  EXPECT_TRUE(Read(constants.Onnx()).has_half_weights);
}

TEST(OnnxHeaderTest, FilesWithoutGraphOrWithAbsurdOnesAreRefused) {
  ExpectError<InputError>([] { Read(""); }, {"net.onnx", "no graph"});
  ExpectError<InputError>([] { Read(ProtoMessage().Integer(1, 7).bytes()); }, {"no graph"});
  OnnxGraph deep;
  deep.Output("output", Shape(33, 1));
  ExpectError<InputError>([&] { Read(deep.Onnx()); }, {"too many sides"});
}

constexpr int kDims = 1, kType = 2, kFloatData = 4, kInt32Data = 5, kName = 8, kRawData = 9;
constexpr int kDoubleData = 10, kExternalData = 13;
constexpr int kFloat = 1, kInt8 = 3, kInt32 = 6, kString = 8, kFloat16 = 10, kDouble = 11;

std::string Zeros(size_t bytes) { return std::string(bytes, '\0'); }

ProtoMessage Tensor(int type, const std::vector<std::uint64_t>& sides) {
  ProtoMessage tensor;
  for (const std::uint64_t side : sides) tensor.Integer(kDims, side);
  return tensor.Integer(kType, static_cast<std::uint64_t>(type)).Text(kName, "weights");
}

// A file with this tensor as an initialiser.
std::string File(const ProtoMessage& tensor) {
  return ProtoMessage().Message(7, ProtoMessage().Message(5, tensor)).bytes();
}

void ExpectAccepted(const ProtoMessage& tensor) { EXPECT_NO_THROW(Read(File(tensor))); }
void ExpectRefused(const std::string& file, const std::vector<std::string>& words) {
  ExpectError<InputError>([&] { Read(file); }, words);
}

TEST(OnnxCheckTest, WholeTensorsAreAccepted) {
  ExpectAccepted(Tensor(kFloat, {2, 3}).Text(kRawData, Zeros(24)));
  ExpectAccepted(Tensor(kFloat, {}).Text(kRawData, Zeros(4)));  // one number
  ExpectAccepted(Tensor(kFloat, {2, 0, 5}));
  ExpectAccepted(Tensor(kFloat, {3}).Text(kFloatData, Zeros(12)));  // packed
  ExpectAccepted(Tensor(kInt32, {3}).Text(kInt32Data, "\x01\x80\x01\x02"));
  ExpectAccepted(Tensor(kInt8, {2}).Integer(kInt32Data, 300).Integer(kInt32Data, 1));
  ExpectAccepted(Tensor(kFloat16, {5}).Text(kRawData, Zeros(10)));
  ExpectAccepted(Tensor(kDouble, {2}).Text(kDoubleData, Zeros(16)));
  ExpectAccepted(ProtoMessage()
                     .Text(kDims, "\x02\x03")
                     .Integer(kType, kFloat)
                     .Text(kRawData, Zeros(24)));  // packed sides
  EXPECT_NO_THROW(Read(MeanNetwork{{1, 1, 7}, std::vector<float>(7), {}}.Onnx()));
}

TEST(OnnxCheckTest, TensorsWithOtherNumbersThanTheirShapeNeedsAreRefused) {
  for (const size_t bytes : {0u, 20u, 23u, 25u, 28u}) {
    ExpectRefused(File(Tensor(kFloat, {2, 3}).Text(kRawData, Zeros(bytes))),
                  {"net.onnx", "'weights'"});
  }
  ExpectRefused(File(Tensor(kFloat, {2, 3}).Text(kRawData, Zeros(20))), {"5 numbers", "the 6"});
  ExpectRefused(File(Tensor(kInt32, {3}).Text(kInt32Data, "\x01\x80\x01")), {"2 numbers"});
  ExpectRefused(File(Tensor(kFloat, {2}).Integer(kInt32Data, 1).Integer(kInt32Data, 1)),
                {"another type"});
  ExpectRefused(File(Tensor(kFloat, {2}).Text(kRawData, Zeros(8)).Text(kFloatData, Zeros(8))),
                {"twice"});
  ExpectRefused(File(Tensor(kFloat, {1u << 20, 1u << 20}).Text(kRawData, Zeros(4))), {"large"});
  ExpectRefused(File(Tensor(kFloat, {~std::uint64_t{0}}).Text(kRawData, Zeros(4))), {"large"});
  ExpectRefused(File(Tensor(kString, {1}).Text(6, "text")), {"type 8"});
}

TEST(OnnxCheckTest, LastOfTwoValuesCounts) {
  ExpectRefused(File(Tensor(kFloat, {2}).Integer(kType, kInt8).Text(kRawData, Zeros(8))),
                {"'weights'"});
  ExpectRefused(File(Tensor(kFloat, {2}).Text(kRawData, Zeros(8)).Text(kRawData, Zeros(4))),
                {"'weights'"});
  ExpectAccepted(Tensor(kFloat, {2}).Text(kRawData, Zeros(4)).Text(kRawData, Zeros(8)));
}

TEST(OnnxCheckTest, FilesOfExternalDataAreNamed) {
  const auto location = ProtoMessage().Text(1, "location").Text(2, "net.onnx.data");
  const auto offset = ProtoMessage().Text(1, "offset").Text(2, "64");
  ProtoMessage tensor = Tensor(kFloat, {2, 3}).Message(kExternalData, location);
  tensor.Message(kExternalData, offset);
  ExpectRefused(File(tensor), {"0 numbers"});  // it does not say that they are elsewhere
  constexpr int kDataLocation = 14;
  EXPECT_EQ(Only(Read(File(tensor.Integer(kDataLocation, 1))).files_of_weights), "net.onnx.data");
  EXPECT_EQ(Read(File(Tensor(kFloat, {}).Text(kRawData, Zeros(4)))).files_of_weights.size(), 0u);
}

// Those of nodes, and of graphs within them.
TEST(OnnxCheckTest, TensorsAreFoundWhereverTheyAre) {
  const ProtoMessage bad = Tensor(kFloat, {2}).Text(kRawData, Zeros(4));
  const ProtoMessage good = Tensor(kFloat, {1}).Text(kRawData, Zeros(4));
  const auto file = [](const ProtoMessage& attribute) {
    const ProtoMessage graph = ProtoMessage().Message(1, ProtoMessage().Message(5, attribute));
    return ProtoMessage().Message(7, graph).bytes();
  };
  const auto graph = [](const ProtoMessage& tensor) { return ProtoMessage().Message(5, tensor); };
  EXPECT_NO_THROW(Read(file(ProtoMessage().Message(5, good))));
  ExpectRefused(file(ProtoMessage().Message(5, bad)), {"net.onnx", "'weights'"});
  ExpectRefused(file(ProtoMessage().Message(6, graph(bad))), {"'weights'"});
  ExpectRefused(file(ProtoMessage().Message(10, good).Message(10, bad)), {"'weights'"});
  ExpectRefused(file(ProtoMessage().Message(11, graph(bad))), {"'weights'"});
}

TEST(OnnxCheckTest, DamagedFilesAreRefused) {
  const std::string whole = MeanNetwork{{1, 1, 7}, std::vector<float>(7), {}}.Onnx();
  for (size_t size = 1; size < 6; ++size)
    ExpectRefused(whole.substr(0, whole.size() - size), {"net.onnx"});
  ExpectRefused("no network", {"net.onnx"});
  ExpectRefused("\x3a\xff\xff\xff\xff\x0f", {"net.onnx", "cut short"});
  ExpectRefused("\x3b", {"malformed"});
  ExpectRefused("\x38" + std::string(11, '\xff'), {"malformed"});
  ProtoMessage deep;
  for (int i = 0; i < 1000; ++i) {
    deep = ProtoMessage().Message(1, ProtoMessage().Message(5, ProtoMessage().Message(6, deep)));
  }
  ExpectRefused(ProtoMessage().Message(7, deep).bytes(), {"deep"});
}

}  // namespace
}  // namespace soslam
