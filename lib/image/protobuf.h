// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace soslam {

// One field of a message: a number of some kind, or bytes, which may be a text, a message or packed
// numbers.
struct ProtobufField {
  enum class Kind { kVarint = 0, kEightBytes = 1, kBytes = 2, kFourBytes = 5 };

  std::uint64_t number;
  Kind kind;
  std::uint64_t integer;   // kVarint
  std::string_view bytes;  // otherwise
};

// Reads the fields of a message of protobuf's wire format (protobuf.dev, "Encoding") in turn.
// Returned bytes are views into the message.
class ProtobufReader {
 public:
  explicit ProtobufReader(std::string_view message) : rest_(message) {}
  // None at the end. Throws InputError, without the file's name, for a malformed message.
  std::optional<ProtobufField> Next();
  // The next integer of a packed field; none at the end. Throws likewise.
  std::optional<std::uint64_t> NextVarint();

 private:
  std::string_view Take(std::uint64_t count);

  std::string_view rest_;
};

}  // namespace soslam
