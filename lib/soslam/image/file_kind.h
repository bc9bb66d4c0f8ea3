// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace soslam {

// Number of first bytes by which FileKind tells files apart.
inline constexpr size_t kFileKindSize = 256;

// The kind of a file by its first bytes, for messages that expected another: "an HDF5 file", "a
// PNG image", "a Git LFS pointer, ...", "JSON", "XML". Empty for other texts and for unknown kinds.
std::string FileKind(std::string_view first_bytes);
std::string KindOfFile(const std::filesystem::path& path);

// Throws InputError, naming the file, if its first bytes are of a kind that is no text in UTF-8, or
// stands in place of one. `expected`: what the text was to be, "JSON".
void CheckIsText(std::string_view first_bytes, const std::string& file, const char* expected);

}  // namespace soslam
