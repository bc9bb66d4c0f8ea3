// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/onnx_header.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#define ONNX_ML 1  // operators of classical machine learning included, as Debian builds it
#include <onnx/onnx_pb.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "soslam/base/error.h"
#include "soslam/image/file_kind.h"

namespace soslam {
namespace {

using onnx::TensorProto;

// Storage of the numbers of a type: in raw_data, or in a field of their own.
struct DataType {
  int type;
  size_t raw_bytes;
  int (TensorProto::*count)() const;
};
constexpr DataType kDataTypes[] = {
    {TensorProto::FLOAT, 4, &TensorProto::float_data_size},
    {TensorProto::UINT8, 1, &TensorProto::int32_data_size},
    {TensorProto::INT8, 1, &TensorProto::int32_data_size},
    {TensorProto::UINT16, 2, &TensorProto::int32_data_size},
    {TensorProto::INT16, 2, &TensorProto::int32_data_size},
    {TensorProto::INT32, 4, &TensorProto::int32_data_size},
    {TensorProto::INT64, 8, &TensorProto::int64_data_size},
    {TensorProto::BOOL, 1, &TensorProto::int32_data_size},
    {TensorProto::FLOAT16, 2, &TensorProto::int32_data_size},
    {TensorProto::DOUBLE, 8, &TensorProto::double_data_size},
    {TensorProto::UINT32, 4, &TensorProto::uint64_data_size},
    {TensorProto::UINT64, 8, &TensorProto::uint64_data_size},
    {TensorProto::BFLOAT16, 2, &TensorProto::int32_data_size},
};

[[noreturn]] void Refuse(const TensorProto& tensor, const std::string& what) {
  throw InputError(fmt::format("tensor '{}' {}", tensor.name(), what));
}

// Throws InputError unless a tensor has external data, or as many numbers as its shape needs.
void ReadTensor(const TensorProto& tensor, OnnxHeader* header) {
  header->has_half_weights |= tensor.data_type() == TensorProto::FLOAT16;
  if (tensor.data_location() == TensorProto::EXTERNAL) {
    const auto& entries = tensor.external_data();
    const auto file = std::ranges::find(entries, "location", &onnx::StringStringEntryProto::key);
    header->files_of_weights.insert(file == entries.end() ? "" : file->value());
    return;
  }
  constexpr std::int64_t kMax = std::numeric_limits<std::int32_t>::max();
  std::int64_t expected = 1;
  for (const std::int64_t side : tensor.dims()) {
    if (side < 0 || side > kMax || (side > 0 && expected > kMax / side)) {
      Refuse(tensor, fmt::format("is absurdly large; expected at most {} numbers", kMax));
    }
    expected *= side;
  }
  const auto type = std::ranges::find(kDataTypes, tensor.data_type(), &DataType::type);
  if (type == std::end(kDataTypes))
    Refuse(tensor, fmt::format("is of type {}", tensor.data_type()));
  const int listed = (tensor.*type->count)();
  const int of_any_type = tensor.float_data_size() + tensor.int32_data_size() +
                          tensor.int64_data_size() + tensor.double_data_size() +
                          tensor.uint64_data_size();
  if (listed != of_any_type) Refuse(tensor, "has numbers of another type");
  const size_t raw = tensor.raw_data().size();
  if (raw > 0 && listed > 0) Refuse(tensor, "has its numbers twice");
  if (raw % type->raw_bytes != 0) {
    Refuse(tensor, fmt::format("has {} bytes; expected whole numbers", raw));
  }
  const std::int64_t found = listed + static_cast<std::int64_t>(raw / type->raw_bytes);
  if (found != expected) {
    Refuse(tensor, fmt::format("has {} numbers in the file; expected the {} that its shape needs",
                               found, expected));
  }
}

// Reads the weights of a graph, those in attributes of its nodes, and those of graphs within it.
void ReadTensors(const onnx::GraphProto& graph, OnnxHeader* header) {
  for (const TensorProto& tensor : graph.initializer()) ReadTensor(tensor, header);
  for (const onnx::NodeProto& node : graph.node()) {
    for (const onnx::AttributeProto& attribute : node.attribute()) {
      if (attribute.has_t()) ReadTensor(attribute.t(), header);
      if (attribute.has_g()) ReadTensors(attribute.g(), header);
      for (const TensorProto& tensor : attribute.tensors()) ReadTensor(tensor, header);
      for (const onnx::GraphProto& inner : attribute.graphs()) ReadTensors(inner, header);
    }
  }
}

OnnxValue ReadValue(const onnx::ValueInfoProto& info) {
  constexpr int kMostSides = 32;
  constexpr std::int64_t kLargest = std::numeric_limits<std::int32_t>::max();
  const onnx::TypeProto::Tensor& tensor = info.type().tensor_type();
  if (tensor.shape().dim_size() > kMostSides) throw InputError("a shape has too many sides");
  OnnxValue value{info.name(), tensor.elem_type(), {}};
  for (const auto& side : tensor.shape().dim()) {  // 0 for one that has a name in place of a number
    const bool is_fixed = side.dim_value() > 0 && side.dim_value() <= kLargest;
    value.shape.push_back(is_fixed ? side.dim_value() : 0);
  }
  return value;
}

}  // namespace

OnnxHeader ReadOnnxHeader(std::string_view bytes, const std::string& name) {
  try {
    onnx::ModelProto model;
    constexpr size_t kMaxBytes = std::numeric_limits<int>::max();
    if (bytes.size() > kMaxBytes ||
        !model.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
      throw InputError(fmt::format(
          "its {} bytes are cut short, malformed or nested too deep; expected a complete ONNX file",
          bytes.size()));
    }
    if (!model.has_graph()) throw InputError("has no graph");
    const onnx::GraphProto& graph = model.graph();
    OnnxHeader header;
    ReadTensors(graph, &header);
    std::set<std::string> weights;
    for (const TensorProto& tensor : graph.initializer()) weights.insert(tensor.name());
    for (const onnx::ValueInfoProto& input : graph.input()) {
      if (!weights.contains(input.name())) header.inputs.push_back(ReadValue(input));
    }
    for (const onnx::ValueInfoProto& output : graph.output()) {
      header.outputs.push_back(ReadValue(output));
    }
    for (const onnx::NodeProto& node : graph.node()) header.operators.insert(node.op_type());
    for (const onnx::OperatorSetIdProto& opset : model.opset_import()) {
      if (!opset.domain().empty()) continue;
      header.opset = static_cast<int>(std::clamp<std::int64_t>(opset.version(), 0, 1000));
    }
    for (const auto& entry : model.metadata_props()) header.metadata[entry.key()] = entry.value();
    return header;
  } catch (const InputError& error) {
    const std::string kind = FileKind(bytes);
    throw InputError(
        kind.empty() ? fmt::format("{}: is not an ONNX network, or damaged: {}", name, error.what())
                     : fmt::format("{}: is {}; expected an ONNX network", name, kind));
  }
}

std::string ShapeText(const std::vector<std::int64_t>& shape) {
  std::vector<std::string> sides;
  for (const std::int64_t side : shape) sides.push_back(side == 0 ? "?" : std::to_string(side));
  return fmt::format("[{}]", fmt::join(sides, ", "));
}

}  // namespace soslam
