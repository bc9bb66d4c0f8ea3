// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace soslam {

// The bytes in base 64 (RFC 4648).
std::string Base64(std::string_view bytes);

}  // namespace soslam
