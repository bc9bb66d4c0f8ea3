// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace soslam {

// The lines of a table of which each is a row: RFC 4180 without line ends in fields.

// The character between fields: of comma, semicolon and tab the one that the header has most of.
char SeparatorOf(std::string_view header);

// The trimmed fields. One that begins with a quote ends with one; two quotes within it are one.
// Throws InputError, naming `place`, for a quote that is not closed, and for text after it.
std::vector<std::string> SplitCsvLine(std::string_view line, char separator,
                                      const std::string& place);

}  // namespace soslam
