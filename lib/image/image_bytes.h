// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace soslam {

enum class ByteOrder { kLittleEndian, kBigEndian };

// An unsigned integer stored in at most eight bytes.
std::uint64_t NumberFromBytes(std::string_view bytes, ByteOrder order);

// Access to the bytes of a file, in memory or on disk: reads only the bytes that are requested.
class ImageBytes {
 public:
  // `read` returns `count` bytes from `begin` on, fewer at the end of the file.
  using ReadAt = std::function<std::string(std::uint64_t begin, size_t count)>;
  explicit ImageBytes(ReadAt read) : read_(std::move(read)) {}
  // Reads from `bytes`, which must outlive this object.
  explicit ImageBytes(std::string_view bytes);

  // Up to `count` bytes from `begin` on, fewer at the end of the file.
  std::string UpTo(std::uint64_t begin, size_t count) const { return read_(begin, count); }
  // Exactly `count` bytes; none when there are fewer.
  std::optional<std::string> At(std::uint64_t begin, size_t count) const;
  // The same bytes as an unsigned integer.
  std::optional<std::uint64_t> NumberAt(std::uint64_t begin, size_t count, ByteOrder order) const;

 private:
  ReadAt read_;
};

}  // namespace soslam
