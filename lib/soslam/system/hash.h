// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace soslam {

// SHA-256 as 64 lower-case hexadecimal digits.
std::string Sha256OfText(std::string_view text);
// SHA-256 of a file's bytes. Throws InputError when the file cannot be read.
std::string Sha256OfFile(const std::filesystem::path& path);

// The bytes in base 64 (RFC 4648).
std::string Base64(std::string_view bytes);

}  // namespace soslam
