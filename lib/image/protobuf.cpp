// SPDX-License-Identifier: BSD-3-Clause
#include "image/protobuf.h"

#include <fmt/format.h>

#include "base/error.h"

namespace soslam {

std::string_view ProtobufReader::Take(std::uint64_t count) {
  if (count > rest_.size()) {
    throw InputError(fmt::format("a field of {} bytes has only {}", count, rest_.size()));
  }
  const std::string_view taken = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return taken;
}

std::optional<std::uint64_t> ProtobufReader::NextVarint() {
  if (rest_.empty()) return std::nullopt;
  constexpr int kBits = 64;
  std::uint64_t number = 0;
  for (int shift = 0; shift < kBits; shift += 7) {
    const auto byte = static_cast<unsigned char>(Take(1).front());
    number |= std::uint64_t{byte & 0x7fU} << shift;
    if (byte < 0x80) return number;
  }
  throw InputError("an integer has more than 64 bits");
}

std::optional<ProtobufField> ProtobufReader::Next() {
  const auto tag = NextVarint();
  if (!tag) return std::nullopt;
  constexpr std::uint64_t kMaxTag = 0xffffffff;
  if (*tag > kMaxTag || *tag >> 3 == 0) throw InputError(fmt::format("a field has tag {}", *tag));
  ProtobufField field{*tag >> 3, static_cast<ProtobufField::Kind>(*tag & 7), 0, {}};
  const auto varint = [&] {
    const auto number = NextVarint();
    if (!number) throw InputError("its last field is cut short");
    return *number;
  };
  switch (field.kind) {
    case ProtobufField::Kind::kVarint:
      field.integer = varint();
      return field;
    case ProtobufField::Kind::kEightBytes:
      field.bytes = Take(8);
      return field;
    case ProtobufField::Kind::kBytes:
      field.bytes = Take(varint());
      return field;
    case ProtobufField::Kind::kFourBytes:
      field.bytes = Take(4);
      return field;
  }
  throw InputError(fmt::format("a field is of kind {}", *tag & 7));
}

}  // namespace soslam
