// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
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

// A network as an ONNX file (field numbers of onnx.proto), part by part.
class OnnxGraph {
 public:
  using Shape = std::vector<std::int64_t>;
  static constexpr int kFloat = 1, kInt64 = 7, kHalf = 10;

  // Attributes of nodes.
  static ProtoMessage Integer(const std::string& name, std::int64_t value) {
    return ProtoMessage()
        .Text(1, name)
        .Integer(3, static_cast<std::uint64_t>(value))
        .Integer(20, 2);
  }
  static ProtoMessage Integers(const std::string& name, const Shape& values) {
    ProtoMessage attribute = ProtoMessage().Text(1, name);
    for (const auto value : values) attribute.Integer(8, static_cast<std::uint64_t>(value));
    return attribute.Integer(20, 7);
  }

  OnnxGraph& Node(const std::string& type, const std::vector<std::string>& inputs,
                  const std::string& output, const std::vector<ProtoMessage>& attributes = {}) {
    return Node(type, inputs, std::vector{output}, attributes);
  }
  OnnxGraph& Node(const std::string& type, const std::vector<std::string>& inputs,
                  const std::vector<std::string>& outputs,
                  const std::vector<ProtoMessage>& attributes) {
    ProtoMessage node;
    for (const std::string& input : inputs) node.Text(1, input);
    for (const std::string& output : outputs) node.Text(2, output);
    node.Text(3, outputs.front()).Text(4, type);
    for (const ProtoMessage& attribute : attributes) node.Message(5, attribute);
    graph_.Message(1, node);
    return *this;
  }
  template <typename T>
  OnnxGraph& Floats(const std::string& name, const Shape& shape, const std::vector<T>& values) {
    return Tensor(name, kFloat, shape, Raw(values));
  }
  OnnxGraph& Int64s(const std::string& name, const Shape& values) {
    return Tensor(name, kInt64, {static_cast<std::int64_t>(values.size())}, Raw(values));
  }
  OnnxGraph& Tensor(const std::string& name, int type, const Shape& shape, const std::string& raw) {
    ProtoMessage tensor;
    for (const auto side : shape) tensor.Integer(1, static_cast<std::uint64_t>(side));
    graph_.Message(5,
                   tensor.Integer(2, static_cast<std::uint64_t>(type)).Text(8, name).Text(9, raw));
    return *this;
  }
  // A side of 0 is declared as one that is fixed only when the network runs.
  OnnxGraph& Input(const std::string& name, const Shape& shape, int type = kFloat) {
    graph_.Message(11, Value(name, shape, type));
    return *this;
  }
  OnnxGraph& Output(const std::string& name, const Shape& shape, int type = kFloat) {
    graph_.Message(12, Value(name, shape, type));
    return *this;
  }

  std::string Onnx(const std::map<std::string, std::string>& metadata = {}, int opset = 12) const {
    ProtoMessage model =
        ProtoMessage()
            .Integer(1, 7)  // IR version
            .Message(7, graph_)
            .Message(8, ProtoMessage().Text(1, "").Integer(2, static_cast<std::uint64_t>(opset)));
    for (const auto& [key, value] : metadata) {
      model.Message(14, ProtoMessage().Text(1, key).Text(2, value));
    }
    return model.bytes();
  }

 private:
  template <typename T>
  static std::string Raw(const std::vector<T>& values) {
    return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
  }
  static ProtoMessage Value(const std::string& name, const Shape& shape, int type) {
    ProtoMessage sides;
    for (const auto side : shape) {
      sides.Message(1, side == 0 ? ProtoMessage().Text(2, "size")
                                 : ProtoMessage().Integer(1, static_cast<std::uint64_t>(side)));
    }
    const ProtoMessage tensor =
        ProtoMessage().Integer(1, static_cast<std::uint64_t>(type)).Message(2, sides);
    return ProtoMessage().Text(1, name).Message(2, ProtoMessage().Message(1, tensor));
  }

  ProtoMessage graph_;
};

// Nodes for numbers that are constants plus a weighted sum of the means of the three channels of
// the input "images": GlobalAveragePool -> [1, 3, 1, 1] -> 1 x 1 Conv -> [1, numbers, 1, 1].
inline void AddMeans(const std::string& output, const std::vector<float>& constants,
                     std::vector<std::array<float, 3>> weights, const std::string& weights_of_conv,
                     OnnxGraph* graph) {
  const auto numbers = static_cast<std::int64_t>(constants.size());
  weights.resize(constants.size(), {0.0F, 0.0F, 0.0F});
  graph->Node("GlobalAveragePool", {"images"}, output + "_means")
      .Node("Conv", {output + "_means", weights_of_conv, output + "_constants"}, output,
            {OnnxGraph::Integers("kernel_shape", {1, 1})})
      .Floats(output + "_weights", {numbers, 3, 1, 1}, weights)
      .Floats(output + "_constants", {numbers}, constants);
}

// A network whose output can be worked out by hand: each number of it is a constant plus a weighted
// sum of the means of the three channels of its input.
struct MeanNetwork {
  std::vector<std::int64_t> output_shape;
  std::vector<float> constants;               // one for each number of the output
  std::vector<std::array<float, 3>> weights;  // likewise; none for no dependence on the input
  int input_width = 64;
  int input_height = 64;
  std::string weights_of_conv = "numbers_weights";   // the name of another tensor makes it invalid
  std::map<std::string, std::string> metadata = {};  // as Ultralytics writes it
  bool has_masks = false;  // a second output [1, 3, 1, 1], as of segmentation with three masks
  int opset = 12;

  OnnxGraph Graph() const {
    OnnxGraph graph;
    graph.Input("images", {1, 3, input_height, input_width}).Output("output", output_shape);
    AddMeans("numbers", constants, weights, weights_of_conv, &graph);
    graph.Node("Reshape", {"numbers", "shape"}, "output").Int64s("shape", output_shape);
    if (has_masks) {
      graph.Node("GlobalAveragePool", {"images"}, "masks").Output("masks", {1, 3, 1, 1});
    }
    return graph;
  }
  std::string Onnx() const { return Graph().Onnx(metadata, opset); }
};

// A network with outputs that do not depend on the image, in the order of a transformer's or
// PaddleDetection's export.
struct ConstantNetwork {
  struct Output {
    std::string name;
    std::vector<std::int64_t> shape;
    std::vector<float> numbers;
    bool is_integer = false;
  };
  std::vector<Output> outputs;
  std::string scaled = "";  // the output that is multiplied by size_input, twice over, [1, 1, 4]
  std::string size_input = "";  // an input [1, 2]
  bool has_integer_sizes = true;
  int input_width = 64;  // px; 0 for one that the file does not fix, as the height
  int input_height = 64;

  OnnxGraph Graph() const {
    OnnxGraph graph;
    graph.Input("images", {1, 3, input_height, input_width});
    if (!size_input.empty()) {
      graph.Input(size_input, {1, 2}, has_integer_sizes ? OnnxGraph::kInt64 : OnnxGraph::kFloat);
      const auto to_float = OnnxGraph::Integer("to", OnnxGraph::kFloat);
      graph.Node("Cast", {size_input}, "sizes", {to_float})
          .Node("Concat", {"sizes", "sizes"}, "four_sizes", {OnnxGraph::Integer("axis", 1)})
          .Node("Reshape", {"four_sizes", "shape_of_sizes"}, "factors")
          .Int64s("shape_of_sizes", {1, 1, 4});
    }
    for (const Output& output : outputs) {
      const std::string& name = output.name;
      AddMeans(name + "_numbers", output.numbers, {}, name + "_numbers_weights", &graph);
      graph.Int64s(name + "_shape", output.shape)
          .Node("Reshape", {name + "_numbers", name + "_shape"}, name + "_shaped");
      const int type = output.is_integer ? OnnxGraph::kInt64 : OnnxGraph::kFloat;
      if (name == scaled) {
        graph.Node("Mul", {name + "_shaped", "factors"}, name);
      } else {
        graph.Node("Cast", {name + "_shaped"}, name, {OnnxGraph::Integer("to", type)});
      }
      graph.Output(name, output.shape, type);
    }
    return graph;
  }
  std::string Onnx() const { return Graph().Onnx(); }
};

// The end of a YOLOv8 graph with masks and two classes, as far as boxes go, for an input of
// 64 x 64: boxes in cells [1, 4, 84] by the pixels of a cell [1, 84], beside scores and three
// coefficients of masks. What it finds does not depend on the image.
struct V8Network {
  struct Found {
    int candidate;             // 64 with cells of 8 px, 16 of 16 px, 4 of 32 px
    std::array<float, 4> box;  // centre and size, px
    int label;
    float score;
  };
  std::vector<Found> found;

  std::string Onnx() const {
    constexpr int kCandidates = 84, kFields = 4 + 2 + 3;
    std::vector<float> numbers(kFields * kCandidates, 0.0F), strides(64, 8.0F);
    strides.resize(80, 16.0F);
    strides.resize(kCandidates, 32.0F);
    for (const Found& object : found) {
      float* const fields = &numbers[object.candidate];
      for (int i = 0; i < 4; ++i) {
        fields[i * kCandidates] = object.box[i] / strides[object.candidate];
      }
      fields[(4 + object.label) * kCandidates] = object.score;
    }
    OnnxGraph graph;
    const auto axis = OnnxGraph::Integer("axis", 1);
    graph.Input("images", {1, 3, 64, 64}).Output("output0", {1, kFields, kCandidates});
    AddMeans("numbers", numbers, {}, "numbers_weights", &graph);
    graph.Int64s("shape", {1, kFields, kCandidates}).Floats("strides", {1, kCandidates}, strides);
    graph.Node("Reshape", {"numbers", "shape"}, "fields")
        .Node("Split", {"fields"}, std::vector<std::string>{"in_cells", "rest"},
              {axis, OnnxGraph::Integers("split", {4, kFields - 4})})
        .Node("Mul", {"in_cells", "strides"}, "in_pixels")
        .Node("Concat", {"in_pixels", "rest"}, "output0", {axis})
        .Node("GlobalAveragePool", {"images"}, "output1")
        .Output("output1", {1, 3, 1, 1});
    return graph.Onnx();
  }
};

// A network with YOLOX's output and two classes: each cell of its three grids is as sure of a cup
// as the mean of the cell's third channel is high, from 0 to 255. Its boxes have the cell's centre,
// and 2 by 3 cells. Nothing depends on the size of the input, unless the boxes are decoded.
struct GridNetwork {
  bool is_decoded = false;  // in pixels, as exported with --decode_in_inference
  int input_width = 64;
  int input_height = 64;

  std::string Onnx() const {
    OnnxGraph graph;
    const std::vector<float> constants = {0.5F, 0.5F, 0.6931472F, 1.0986123F, 0.9F, 0.0F, 0.0F};
    std::vector<std::array<float, 3>> weights(7, {0.0F, 0.0F, 0.0F});
    weights[5][2] = 1.0F / 255;
    std::int64_t cells = 0;
    std::vector<float> grid, pixels;
    graph.Floats("weights", {7, 3, 1, 1}, weights).Floats("constants", {7}, constants);
    graph.Int64s("shape", {1, 7, -1});
    std::vector<std::string> parts;
    for (const int stride : {8, 16, 32}) {
      const std::string name = std::to_string(stride);
      const auto sides = OnnxGraph::Integers("strides", {stride, stride});
      graph
          .Node("AveragePool", {"images"}, "means" + name,
                {OnnxGraph::Integers("kernel_shape", {stride, stride}), sides})
          .Node("Conv", {"means" + name, "weights", "constants"}, "fields" + name,
                {OnnxGraph::Integers("kernel_shape", {1, 1})})
          .Node("Reshape", {"fields" + name, "shape"}, "part" + name);
      parts.push_back("part" + name);
      for (int cell = 0; cell < input_width / stride * (input_height / stride); ++cell, ++cells) {
        grid.push_back(static_cast<float>(cell % (input_width / stride)));
        grid.push_back(static_cast<float>(cell / (input_width / stride)));
        pixels.insert(pixels.end(), 2, static_cast<float>(stride));
      }
    }
    graph.Node("Concat", parts, "columns", {OnnxGraph::Integer("axis", 2)})
        .Node("Transpose", {"columns"}, "rows", {OnnxGraph::Integers("perm", {0, 2, 1})})
        .Input("images", {1, 3, input_height, input_width})
        .Output(is_decoded ? "decoded" : "rows", {1, cells, 7});
    if (is_decoded) AddDecoding(cells, grid, pixels, &graph);
    return graph.Onnx({}, 11);
  }

 private:
  static void AddDecoding(std::int64_t cells, const std::vector<float>& grid,
                          const std::vector<float>& pixels, OnnxGraph* graph) {
    graph->Floats("grid", {1, cells, 2}, grid).Floats("pixels", {1, cells, 2}, pixels);
    graph->Int64s("axes", {2}).Int64s("at0", {0}).Int64s("at2", {2}).Int64s("at4", {4});
    graph->Int64s("at7", {7});
    graph->Node("Slice", {"rows", "at0", "at2", "axes"}, "offsets")
        .Node("Slice", {"rows", "at2", "at4", "axes"}, "logarithms")
        .Node("Slice", {"rows", "at4", "at7", "axes"}, "scores")
        .Node("Add", {"offsets", "grid"}, "centres")
        .Node("Mul", {"centres", "pixels"}, "centres_px")
        .Node("Exp", {"logarithms"}, "sizes")
        .Node("Mul", {"sizes", "pixels"}, "sizes_px")
        .Node("Concat", {"centres_px", "sizes_px", "scores"}, "decoded",
              {OnnxGraph::Integer("axis", 2)});
  }
};

}  // namespace soslam
