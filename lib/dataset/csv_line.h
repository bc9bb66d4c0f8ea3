// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace soslam {

// Lines of a CSV table with one row per line: RFC 4180 without line ends in fields.

// Separator of the fields: the most frequent one of comma, semicolon and tab in the header.
char SeparatorOf(std::string_view header);

// The trimmed fields. A field that begins with a quote ends with one; two quotes within it stand
// for one. Throws InputError, naming `place`, for an unclosed quote and for text after a closing
// one.
std::vector<std::string> SplitCsvLine(std::string_view line, char separator,
                                      const std::string& place);

}  // namespace soslam
