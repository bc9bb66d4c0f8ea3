// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace soslam {

// An input or output of a network, as its file declares it.
struct OnnxValue {
  static constexpr int kFloat = 1, kInt64 = 7, kHalf = 10;  // of TensorProto.DataType

  std::string name;
  int type = 0;                     // TensorProto.DataType; 0 if the file does not state it
  std::vector<std::int64_t> shape;  // 0 for a side that is fixed only when the network runs
};

// The properties of a network that its ONNX file states.
struct OnnxHeader {
  std::vector<OnnxValue> inputs;  // without weights, which older files list among them
  std::vector<OnnxValue> outputs;
  int opset = 0;                                // version of ONNX's own operators
  std::set<std::string> operators;              // those of the graph's nodes: "Conv", "Mul", ...
  bool has_half_weights = false;                // 16-bit floating point
  std::set<std::string> files_of_weights;       // external data, relative to the folder of the file
  std::map<std::string, std::string> metadata;  // Ultralytics: "names", "task", "end2end", ...
};

// Reads the header of an ONNX file. Throws InputError, naming the file `name`, for one that is
// damaged or has no graph; and, naming the tensor, for a tensor that has neither external data nor
// as many numbers as its shape needs: OpenCV derives their number from the shape.
OnnxHeader ReadOnnxHeader(std::string_view bytes, const std::string& name);

// The shape as text, "[1, 3, ?, 640]".
std::string ShapeText(const std::vector<std::int64_t>& shape);

}  // namespace soslam
