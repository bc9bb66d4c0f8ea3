// SPDX-License-Identifier: BSD-3-Clause
#include "image/onnx_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "base/error.h"
#include "image/file_kind.h"

namespace soslam {
namespace {

// One field of a message: a number of some kind, or bytes, which may be a text, a message or packed
// numbers.
struct ProtobufField {
  enum class Kind { kVarint = 0, kEightBytes = 1, kBytes = 2, kFourBytes = 5 };

  std::uint64_t number;
  Kind kind;
  std::uint64_t integer;   // kVarint
  std::string_view bytes;  // otherwise
};
using Kind = ProtobufField::Kind;

// Readers of protobuf's wire format (protobuf.dev, "Encoding"): each takes what it returns from the
// beginning of `rest`, and throws InputError, without the file's name, where that is malformed.
std::string_view TakeBytes(std::uint64_t count, std::string_view* rest) {
  if (count > rest->size()) {
    throw InputError(fmt::format("a field of {} bytes has only {}", count, rest->size()));
  }
  const std::string_view taken = rest->substr(0, count);
  rest->remove_prefix(count);
  return taken;
}

std::uint64_t TakeVarint(std::string_view* rest) {
  if (rest->empty()) throw InputError("its last field is cut short");
  constexpr int kBits = 64;
  std::uint64_t number = 0;
  for (int shift = 0; shift < kBits; shift += 7) {
    const auto byte = static_cast<unsigned char>(TakeBytes(1, rest).front());
    number |= std::uint64_t{byte & 0x7fU} << shift;
    if (byte < 0x80) return number;
  }
  throw InputError("an integer has more than 64 bits");
}

ProtobufField TakeField(std::string_view* rest) {
  constexpr std::uint64_t kMaxTag = 0xffffffff;
  const std::uint64_t tag = TakeVarint(rest);
  if (tag > kMaxTag || tag >> 3 == 0) throw InputError(fmt::format("a field has tag {}", tag));
  ProtobufField field{tag >> 3, static_cast<Kind>(tag & 7), 0, {}};
  switch (field.kind) {
    case Kind::kVarint:
      field.integer = TakeVarint(rest);
      return field;
    case Kind::kEightBytes:
      field.bytes = TakeBytes(8, rest);
      return field;
    case Kind::kBytes:
      field.bytes = TakeBytes(TakeVarint(rest), rest);
      return field;
    case Kind::kFourBytes:
      field.bytes = TakeBytes(4, rest);
      return field;
  }
  throw InputError(fmt::format("a field is of kind {}", tag & 7));
}

// Calls visit(field) for each field of a message. Bytes are views into the message.
template <typename Visit>
void ForEachField(std::string_view message, const Visit& visit) {
  while (!message.empty()) visit(TakeField(&message));
}

constexpr int kHalfType = OnnxValue::kHalf;
constexpr size_t kMostValues = 1000;  // inputs or outputs
constexpr size_t kMostSides = 32;

// The last of the fields with this number, as protobuf has it; 0 and empty without one.
ProtobufField Last(std::string_view message, std::uint64_t number) {
  ProtobufField last{};
  ForEachField(message, [&](const ProtobufField& field) {
    if (field.number == number) last = field;
  });
  return last;
}

// A side of TensorShapeProto: a number, or the name of a size that is not fixed.
std::int64_t Side(std::string_view dimension) {
  constexpr std::uint64_t kLargest = 1U << 31;
  const std::uint64_t side = Last(dimension, 1).integer;
  return side < kLargest ? static_cast<std::int64_t>(side) : 0;
}

// ValueInfoProto: type.tensor_type with elem_type and shape.dim.
void AddValue(std::string_view message, std::vector<OnnxValue>* values) {
  if (values->size() >= kMostValues) throw InputError("has too many inputs or outputs");
  const std::string_view tensor = Last(Last(message, 2).bytes, 1).bytes;
  OnnxValue value{static_cast<int>(Last(tensor, 1).integer), {}};
  ForEachField(Last(tensor, 2).bytes, [&](const ProtobufField& field) {
    if (field.number != 1) return;
    if (value.shape.size() >= kMostSides) throw InputError("a shape has too many sides");
    value.shape.push_back(Side(field.bytes));
  });
  values->push_back(std::move(value));
}

// TensorProto.data_type of the tensor of a Constant's attribute.
bool HasHalfConstant(std::string_view node) {
  bool found = false;
  ForEachField(node, [&](const ProtobufField& field) {
    if (field.number == 5) found |= Last(Last(field.bytes, 5).bytes, 2).integer == kHalfType;
  });
  return found;
}

// GraphProto: node, initializer, input, output.
void ReadGraph(std::string_view graph, OnnxHeader* header) {
  std::set<std::string, std::less<>> weights;
  ForEachField(graph, [&](const ProtobufField& field) {
    switch (field.number) {
      case 1:
        header->operators.emplace(Last(field.bytes, 4).bytes);
        header->has_half_weights |= HasHalfConstant(field.bytes);
        break;
      case 5:
        weights.emplace(Last(field.bytes, 8).bytes);
        header->has_half_weights |= Last(field.bytes, 2).integer == kHalfType;
        break;
      case 12:
        AddValue(field.bytes, &header->outputs);
        break;
      default:
        break;
    }
  });
  ForEachField(graph, [&](const ProtobufField& field) {
    if (field.number == 11 && !weights.contains(Last(field.bytes, 1).bytes)) {
      AddValue(field.bytes, &header->inputs);
    }
  });
}

// Fields of TensorProto in onnx.proto.
constexpr std::uint64_t kDims = 1, kDataType = 2, kName = 8, kRawData = 9;
constexpr std::uint64_t kFloatData = 4, kInt32Data = 5, kInt64Data = 7, kDoubleData = 10;
constexpr std::uint64_t kUint64Data = 11, kExternalData = 13, kDataLocation = 14;

// Storage of the numbers of a type: in raw_data, or in a field of their own.
struct DataType {
  std::uint64_t type;
  std::uint64_t raw_bytes;
  std::uint64_t field;
};
constexpr DataType kDataTypes[] = {
    {1, 4, kFloatData},    // FLOAT
    {2, 1, kInt32Data},    // UINT8
    {3, 1, kInt32Data},    // INT8
    {4, 2, kInt32Data},    // UINT16
    {5, 2, kInt32Data},    // INT16
    {6, 4, kInt32Data},    // INT32
    {7, 8, kInt64Data},    // INT64
    {9, 1, kInt32Data},    // BOOL
    {10, 2, kInt32Data},   // FLOAT16
    {11, 8, kDoubleData},  // DOUBLE
    {12, 4, kUint64Data},  // UINT32
    {13, 8, kUint64Data},  // UINT64
    {16, 2, kInt32Data},   // BFLOAT16
};

// Wire type of each number of a field, whether they are packed or one by one.
Kind KindOfNumbers(std::uint64_t field) {
  if (field == kFloatData) return Kind::kFourBytes;
  return field == kDoubleData ? Kind::kEightBytes : Kind::kVarint;
}

std::uint64_t CountPacked(std::string_view bytes, Kind kind) {
  if (kind == Kind::kFourBytes) return bytes.size() / 4;
  if (kind == Kind::kEightBytes) return bytes.size() / 8;
  return static_cast<std::uint64_t>(
      std::ranges::count_if(bytes, [](char c) { return static_cast<unsigned char>(c) < 0x80; }));
}

// The type and shape that a tensor states, and the data that it has.
class Tensor {
 public:
  explicit Tensor(std::string_view message) {
    ForEachField(message, [&](const ProtobufField& field) { Add(field); });
  }

  // The file that has the numbers; none if this one has them.
  std::optional<std::string> ExternalFile() const {
    constexpr std::uint64_t kKey = 1, kValue = 2;  // of StringStringEntryProto
    if (!is_external_) return std::nullopt;
    std::string file;
    for (const std::string_view entry : external_data_) {
      if (Last(entry, kKey).bytes == "location") file = Last(entry, kValue).bytes;
    }
    return file;
  }

  void Check() const {
    const auto type = std::ranges::find(kDataTypes, type_.value_or(0), &DataType::type);
    if (type == std::end(kDataTypes)) Refuse(fmt::format("is of type {}", type_.value_or(0)));
    std::uint64_t found = 0;
    for (const auto& [field, count] : numbers_) {
      if (field != type->field && count > 0) Refuse("has numbers of another type");
      found += count;
    }
    const std::uint64_t raw = raw_bytes_.value_or(0);
    if (raw > 0 && found > 0) Refuse("has its numbers twice");
    if (raw % type->raw_bytes != 0)
      Refuse(fmt::format("has {} bytes; expected whole numbers", raw));
    found += raw / type->raw_bytes;
    if (found != count_) {
      Refuse(fmt::format("has {} numbers in the file; expected the {} that its shape needs", found,
                         count_));
    }
  }

 private:
  void Add(const ProtobufField& field) {
    if (field.number == kName) name_ = field.bytes;
    if (field.number == kDims) AddSides(field);
    if (field.number == kExternalData) external_data_.push_back(field.bytes);
    if (field.number == kDataLocation) is_external_ = field.integer == 1;
    if (field.number == kDataType) SetOnce(field, Kind::kVarint, field.integer, &type_);
    if (field.number == kRawData) SetOnce(field, Kind::kBytes, field.bytes.size(), &raw_bytes_);
    if (std::ranges::find(kDataTypes, field.number, &DataType::field) == std::end(kDataTypes))
      return;
    const Kind kind = KindOfNumbers(field.number);
    if (field.kind != kind && field.kind != Kind::kBytes) Refuse("is not as ONNX has it");
    numbers_[field.number] += field.kind == kind ? 1 : CountPacked(field.bytes, kind);
  }

  void AddSides(const ProtobufField& field) {
    if (field.kind == Kind::kVarint) return AddSide(field.integer);
    if (field.kind != Kind::kBytes) Refuse("is not as ONNX has it");
    for (std::string_view packed = field.bytes; !packed.empty();) AddSide(TakeVarint(&packed));
  }

  void AddSide(std::uint64_t side) {
    constexpr std::uint64_t kMax = std::numeric_limits<std::int32_t>::max();
    if (side > kMax || (side > 0 && count_ > kMax / side)) {
      Refuse(fmt::format("is absurdly large; expected at most {} numbers", kMax));
    }
    count_ *= side;
  }

  // Sets a value that may be there only once: readers differ in which of two they take.
  void SetOnce(const ProtobufField& field, Kind kind, std::uint64_t number,
               std::optional<std::uint64_t>* value) const {
    if (field.kind != kind || *value) Refuse("is not as ONNX has it");
    *value = number;
  }

  [[noreturn]] void Refuse(const std::string& what) const {
    throw InputError(fmt::format("tensor '{}' {}", name_, what));
  }

  std::string_view name_;
  std::uint64_t count_ = 1;
  bool is_external_ = false;
  std::vector<std::string_view> external_data_;
  std::optional<std::uint64_t> type_, raw_bytes_;
  std::map<std::uint64_t, std::uint64_t> numbers_;  // count of numbers by field
};

// The messages that contain tensors.
enum class Message { kModel, kGraph, kNode, kAttribute, kTensor };

struct Member {
  Message of;
  std::uint64_t field;
  Message is;
};
constexpr Member kMembers[] = {
    {Message::kModel, 7, Message::kGraph},       {Message::kGraph, 1, Message::kNode},
    {Message::kGraph, 5, Message::kTensor},      {Message::kNode, 5, Message::kAttribute},
    {Message::kAttribute, 5, Message::kTensor},  {Message::kAttribute, 6, Message::kGraph},
    {Message::kAttribute, 10, Message::kTensor}, {Message::kAttribute, 11, Message::kGraph},
};

void Check(Message message, std::string_view bytes, int depth, OnnxHeader* header) {
  constexpr int kMaxDepth = 64;
  if (depth > kMaxDepth) throw InputError("is nested too deep");
  if (message == Message::kTensor) {
    const Tensor tensor(bytes);
    if (auto file = tensor.ExternalFile()) {
      header->files_of_weights.insert(std::move(*file));
    } else {
      tensor.Check();
    }
    return;
  }
  bool has_tensor = false;
  ForEachField(bytes, [&](const ProtobufField& field) {
    const auto member = std::ranges::find_if(kMembers, [&](const Member& candidate) {
      return candidate.of == message && candidate.field == field.number;
    });
    if (member == std::end(kMembers)) return;
    if (field.kind != Kind::kBytes)
      throw InputError(fmt::format("field {} is not a message", field.number));
    const bool is_only_tensor = message == Message::kAttribute && member->field == 5;
    if (is_only_tensor && std::exchange(has_tensor, true)) {  // readers would merge the two
      throw InputError("an attribute has two tensors");
    }
    Check(member->is, field.bytes, depth + 1, header);
  });
}

}  // namespace

OnnxHeader ReadOnnxHeader(std::string_view bytes, const std::string& name) {
  OnnxHeader header;
  bool has_graph = false;
  try {
    Check(Message::kModel, bytes, 0, &header);
    ForEachField(bytes, [&](const ProtobufField& field) {  // ModelProto
      if (field.number == 7) {
        has_graph = true;
        ReadGraph(field.bytes, &header);
      } else if (field.number == 8 && Last(field.bytes, 1).bytes.empty()) {
        header.opset =
            static_cast<int>(std::min<std::uint64_t>(Last(field.bytes, 2).integer, 1000));
      } else if (field.number == 14) {
        header.metadata[std::string(Last(field.bytes, 1).bytes)] = Last(field.bytes, 2).bytes;
      }
    });
    if (!has_graph) throw InputError("has no graph");
  } catch (const InputError& error) {
    const std::string kind = FileKind(bytes);
    if (!kind.empty()) {
      throw InputError(fmt::format("{}: is {}; expected an ONNX network", name, kind));
    }
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
