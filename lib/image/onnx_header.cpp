// SPDX-License-Identifier: BSD-3-Clause
#include "image/onnx_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <utility>

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

namespace {

// Reads Python's notation of a list of texts, or of a dictionary from 0, 1, ... to texts.
class PythonNames {
 public:
  explicit PythonNames(std::string_view text) : rest_(text) {}

  // None if the text is anything else.
  std::optional<std::vector<std::string>> Read() {
    const bool is_list = Skip('[');
    if (!is_list && !Skip('{')) return std::nullopt;
    const char end = is_list ? ']' : '}';
    std::vector<std::string> names;
    while (!Skip(end)) {
      if (!names.empty() && !Skip(',')) return std::nullopt;
      if (!is_list && !(SkipNumber(names.size()) && Skip(':'))) return std::nullopt;
      auto name = Text();
      if (!name) return std::nullopt;
      names.push_back(std::move(*name));
    }
    SkipBlanks();
    return rest_.empty() ? std::optional(std::move(names)) : std::nullopt;
  }

 private:
  void SkipBlanks() { rest_.remove_prefix(std::min(rest_.find_first_not_of(" \n"), rest_.size())); }

  bool Skip(char expected) {
    SkipBlanks();
    if (rest_.empty() || rest_.front() != expected) return false;
    rest_.remove_prefix(1);
    return true;
  }

  bool SkipNumber(size_t expected) {
    SkipBlanks();
    size_t number = 0;
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), number);
    if (error != std::errc() || number != expected) return false;
    rest_.remove_prefix(static_cast<size_t>(end - rest_.data()));
    return true;
  }

  // A text in quotes of either kind, in which a backslash stands before quotes and itself.
  std::optional<std::string> Text() {
    SkipBlanks();
    if (rest_.empty() || (rest_.front() != '\'' && rest_.front() != '"')) return std::nullopt;
    const char quote = rest_.front();
    std::string text;
    for (size_t i = 1; i < rest_.size(); ++i) {
      if (rest_[i] == quote) {
        rest_.remove_prefix(i + 1);
        return text;
      }
      if (rest_[i] == '\\' && (++i == rest_.size() || !IsEscaped(rest_[i]))) break;
      text += rest_[i];
    }
    return std::nullopt;
  }

  static bool IsEscaped(char c) { return c == '\\' || c == '\'' || c == '"'; }

  std::string_view rest_;
};

// True for a name that detections.csv cannot hold.
bool IsBadName(const std::string& label) {
  return label.empty() || std::ranges::any_of(label, [](char c) {
           return c == ',' || static_cast<unsigned char>(c) < 0x20;
         });
}

}  // namespace

std::vector<std::string> ClassNames(const OnnxHeader& header, const std::string& name) {
  const auto found = header.metadata.find("names");
  if (found == header.metadata.end()) return {};
  auto names = PythonNames(found->second).Read();
  if (!names || names->empty() || std::ranges::any_of(*names, IsBadName)) {
    constexpr size_t kShown = 100;
    throw InputError(
        fmt::format("{}: its class names are '{}'; expected {{0: 'cup', 1: 'book', ...}}, no name "
                    "with a comma (--labels FILE gives others)",
                    name, found->second.substr(0, kShown)));
  }
  return *std::move(names);
}

std::string ShapeText(const std::vector<std::int64_t>& shape) {
  std::vector<std::string> sides;
  for (const std::int64_t side : shape) sides.push_back(side == 0 ? "?" : std::to_string(side));
  return fmt::format("[{}]", fmt::join(sides, ", "));
}

}  // namespace soslam
