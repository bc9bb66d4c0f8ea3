// SPDX-License-Identifier: BSD-3-Clause
#include <cstdlib>

#include "soslam/image/image_format.h"

namespace soslam {
namespace {

bool IsBmp(std::string_view first_bytes) { return first_bytes.starts_with("BM"); }

// The size in a header of OS/2 (12 bytes) or of Windows, where a height below 0 says that the top
// row comes first.
std::optional<ImageHeader> Header(const ImageBytes& file) {
  const auto bytes = file.At(14, 12);
  if (!bytes) return std::nullopt;
  const auto number = [&](size_t at, size_t count) {
    return NumberFromBytes(std::string_view(*bytes).substr(at, count), ByteOrder::kLittleEndian);
  };
  const auto side = [&](size_t at) {
    return std::int64_t{static_cast<std::int32_t>(number(at, 4))};
  };
  if (number(0, 4) != 12) return ImageHeader{{side(4), std::abs(side(8))}};
  return ImageHeader{
      {static_cast<std::int64_t>(number(4, 2)), static_cast<std::int64_t>(number(6, 2))}};
}

}  // namespace

constexpr ImageFormat kBmpFormat = {"BMP", &IsBmp, &Header};

}  // namespace soslam
