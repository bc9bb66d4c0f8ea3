// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace soslam {

struct ImageSize {
  std::int64_t width = 0;
  std::int64_t height = 0;
};

// The size that an image file claims to have; none for what is neither PNG nor JPEG, or cut short
// before it. Other decoders of OpenCV allocate whatever a few bytes ask for.
std::optional<ImageSize> SizeInHeader(std::string_view bytes);

}  // namespace soslam
