// SPDX-License-Identifier: BSD-3-Clause
#include "image/onnx_header.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "image/protobuf_reader.h"

namespace soslam {
namespace {

constexpr int kHalfType = OnnxValue::kHalf;
constexpr size_t kMostValues = 1000;  // inputs or outputs
constexpr size_t kMostSides = 32;

// Calls visit(field) for each field of a message.
template <typename Visit>
void ForEachField(std::string_view message, const Visit& visit) {
  ProtobufReader reader(message);
  while (const auto field = reader.Next()) visit(*field);
}

// The last of the fields with this number, as protobuf has it; empty without one.
std::string_view BytesOf(std::string_view message, std::uint64_t number) {
  std::string_view bytes;
  ForEachField(message, [&](const ProtobufField& field) {
    if (field.number == number) bytes = field.bytes;
  });
  return bytes;
}
std::uint64_t IntegerOf(std::string_view message, std::uint64_t number) {
  std::uint64_t integer = 0;
  ForEachField(message, [&](const ProtobufField& field) {
    if (field.number == number) integer = field.integer;
  });
  return integer;
}

// A side of TensorShapeProto: a number, or the name of a size that is not fixed.
std::int64_t Side(std::string_view dimension) {
  constexpr std::uint64_t kLargest = 1U << 31;
  const std::uint64_t side = IntegerOf(dimension, 1);
  return side < kLargest ? static_cast<std::int64_t>(side) : 0;
}

// ValueInfoProto: name, then type.tensor_type with elem_type and shape.dim.
OnnxValue ReadValue(std::string_view message) {
  const std::string_view tensor = BytesOf(BytesOf(message, 2), 1);
  OnnxValue value{std::string(BytesOf(message, 1)), static_cast<int>(IntegerOf(tensor, 1)), {}};
  ForEachField(BytesOf(tensor, 2), [&](const ProtobufField& field) {
    if (field.number != 1) return;
    if (value.shape.size() >= kMostSides) throw InputError("a shape has too many sides");
    value.shape.push_back(Side(field.bytes));
  });
  return value;
}

void AddValue(std::string_view message, std::vector<OnnxValue>* values) {
  if (values->size() >= kMostValues) throw InputError("has too many inputs or outputs");
  values->push_back(ReadValue(message));
}

// TensorProto.data_type of the tensor of a Constant's attribute.
bool HasHalfConstant(std::string_view node) {
  bool found = false;
  ForEachField(node, [&](const ProtobufField& field) {
    if (field.number == 5) found |= IntegerOf(BytesOf(field.bytes, 5), 2) == kHalfType;
  });
  return found;
}

// GraphProto: node, initializer, input, output.
void ReadGraph(std::string_view graph, OnnxHeader* header) {
  std::set<std::string, std::less<>> weights;
  ForEachField(graph, [&](const ProtobufField& field) {
    switch (field.number) {
      case 1:
        header->operators.emplace(BytesOf(field.bytes, 4));
        header->has_half_weights |= HasHalfConstant(field.bytes);
        break;
      case 5:
        weights.emplace(BytesOf(field.bytes, 8));
        header->has_half_weights |= IntegerOf(field.bytes, 2) == kHalfType;
        break;
      case 12:
        AddValue(field.bytes, &header->outputs);
        break;
      default:
        break;
    }
  });
  ForEachField(graph, [&](const ProtobufField& field) {
    if (field.number == 11 && !weights.contains(BytesOf(field.bytes, 1))) {
      AddValue(field.bytes, &header->inputs);
    }
  });
}

}  // namespace

OnnxHeader ReadOnnxHeader(std::string_view bytes, const std::string& name) {
  OnnxHeader header;
  bool has_graph = false;
  try {
    ForEachField(bytes, [&](const ProtobufField& field) {  // ModelProto
      if (field.number == 7) {
        has_graph = true;
        ReadGraph(field.bytes, &header);
      } else if (field.number == 8 && BytesOf(field.bytes, 1).empty()) {
        header.opset = static_cast<int>(std::min<std::uint64_t>(IntegerOf(field.bytes, 2), 1000));
      } else if (field.number == 14) {
        header.metadata[std::string(BytesOf(field.bytes, 1))] = BytesOf(field.bytes, 2);
      }
    });
    if (!has_graph) throw InputError("has no graph");
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: is not an ONNX network, or damaged: {}", name, error.what()));
  }
  return header;
}

std::string ShapeText(const std::vector<std::int64_t>& shape) {
  std::vector<std::string> sides;
  for (const std::int64_t side : shape) sides.push_back(side == 0 ? "?" : std::to_string(side));
  return fmt::format("[{}]", fmt::join(sides, ", "));
}

}  // namespace soslam
