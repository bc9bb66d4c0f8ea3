// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace soslam {

// A message of protobuf's wire format, field by field (protobuf.dev, "Encoding").
class ProtoMessage {
 public:
  ProtoMessage& Integer(int field, std::uint64_t value) {
    AppendVarint(static_cast<std::uint64_t>(field) << 3);
    AppendVarint(value);
    return *this;
  }
  ProtoMessage& Text(int field, const std::string& bytes) {
    AppendVarint(static_cast<std::uint64_t>(field) << 3 | 2);
    AppendVarint(bytes.size());
    bytes_ += bytes;
    return *this;
  }
  ProtoMessage& Message(int field, const ProtoMessage& message) {
    return Text(field, message.bytes_);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void AppendVarint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) bytes_ += static_cast<char>(value | 0x80);
    bytes_ += static_cast<char>(value);
  }
  std::string bytes_;
};

// A network whose output can be worked out by hand: each number of it is a constant plus a weighted
// sum of the means of the three channels of its input.
struct MeanNetwork {
  std::vector<std::int64_t> output_shape;
  std::vector<float> constants;               // one for each number of the output
  std::vector<std::array<float, 3>> weights;  // likewise; none for no dependence on the input
  int input_width = 64;
  int input_height = 64;
  std::string weights_of_conv = "weights";  // the name of another tensor makes it invalid

  // The network as an ONNX file (field numbers of onnx.proto, opset 12):
  // GlobalAveragePool -> [1, 3, 1, 1] -> 1 x 1 Conv -> [1, numbers, 1, 1] -> Reshape.
  std::string Onnx() const {
    const auto numbers = static_cast<std::int64_t>(constants.size());
    std::vector<std::array<float, 3>> all_weights = weights;
    all_weights.resize(constants.size(), {0.0F, 0.0F, 0.0F});
    const ProtoMessage graph =
        ProtoMessage()
            .Message(1, Node("GlobalAveragePool", {"images"}, "means"))
            .Message(1, Node("Conv", {"means", weights_of_conv, "constants"}, "numbers"))
            .Message(1, Node("Reshape", {"numbers", "shape"}, "output"))
            .Text(2, "means")
            .Message(5, Tensor("weights", kFloat, {numbers, 3, 1, 1}, Raw(all_weights)))
            .Message(5, Tensor("constants", kFloat, {numbers}, Raw(constants)))
            .Message(5, Tensor("shape", kInt64, {static_cast<std::int64_t>(output_shape.size())},
                               Raw(output_shape)))
            .Message(11, Value("images", {1, 3, input_height, input_width}))
            .Message(12, Value("output", output_shape));
    return ProtoMessage()
        .Integer(1, 7)  // IR version
        .Message(7, graph)
        .Message(8, ProtoMessage().Text(1, "").Integer(2, 12))
        .bytes();
  }

 private:
  static constexpr int kFloat = 1;
  static constexpr int kInt64 = 7;

  template <typename T>
  static std::string Raw(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
  }
  static ProtoMessage Node(const std::string& type, const std::vector<std::string>& inputs,
                           const std::string& output) {
    ProtoMessage node;
    for (const std::string& input : inputs) node.Text(1, input);
    node.Text(2, output).Text(3, output).Text(4, type);
    if (type == "Conv") {
      constexpr int kIntegers = 7;
      node.Message(5, ProtoMessage()
                          .Text(1, "kernel_shape")
                          .Integer(8, 1)
                          .Integer(8, 1)
                          .Integer(20, kIntegers));
    }
    return node;
  }
  static ProtoMessage Tensor(const std::string& name, int type,
                             const std::vector<std::int64_t>& shape, const std::string& raw) {
    ProtoMessage tensor;
    for (const std::int64_t side : shape) tensor.Integer(1, static_cast<std::uint64_t>(side));
    return tensor.Integer(2, static_cast<std::uint64_t>(type)).Text(8, name).Text(9, raw);
  }
  static ProtoMessage Value(const std::string& name, const std::vector<std::int64_t>& shape) {
    ProtoMessage sides;
    for (const std::int64_t side : shape) {
      sides.Message(1, ProtoMessage().Integer(1, static_cast<std::uint64_t>(side)));
    }
    const ProtoMessage tensor = ProtoMessage().Integer(1, kFloat).Message(2, sides);
    return ProtoMessage().Text(1, name).Message(2, ProtoMessage().Message(1, tensor));
  }
};

}  // namespace soslam
