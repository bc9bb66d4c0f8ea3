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

// At most eight bytes as a number.
std::uint64_t NumberFromBytes(std::string_view bytes, ByteOrder order);

// The bytes of a file, in memory or where they lie: only what is asked for is read.
class ImageBytes {
 public:
  // `read` gives `count` bytes from `begin` on, fewer at the end.
  using ReadAt = std::function<std::string(std::uint64_t begin, size_t count)>;
  explicit ImageBytes(ReadAt read) : read_(std::move(read)) {}
  // Those of `bytes`, which must outlive it.
  explicit ImageBytes(std::string_view bytes);

  // At most `count` bytes from `begin` on: as many as there are.
  std::string UpTo(std::uint64_t begin, size_t count) const { return read_(begin, count); }
  // Exactly so many; none when there are fewer.
  std::optional<std::string> At(std::uint64_t begin, size_t count) const;
  // The same as a number.
  std::optional<std::uint64_t> NumberAt(std::uint64_t begin, size_t count, ByteOrder order) const;

 private:
  ReadAt read_;
};

}  // namespace soslam
