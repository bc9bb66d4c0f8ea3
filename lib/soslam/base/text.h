// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace soslam {

// The message as one line of printable text. Messages quote files, which may hold any bytes:
// control characters are escaped. A long message keeps its begin and its end, which hold the place
// of the error and what was expected.
std::string OneLine(const std::string& message);

// The text with capitals of ASCII as small letters.
std::string LowerCase(std::string text);

inline constexpr std::string_view kBlanks = " \t\r\v\f";

// The text without blanks at both ends.
std::string_view Trimmed(std::string_view text);
// Words separated by blanks.
std::vector<std::string_view> SplitWords(std::string_view text);
// Trimmed fields between separators; a separator cannot be part of a field.
std::vector<std::string_view> SplitFields(std::string_view text, char separator = ',');

// Number of characters of a text in UTF-8.
size_t CountCharacters(const std::string& text);

// The text with each of its lines broken at spaces to at most `width` characters, except for longer
// words; lines after the first are indented.
std::string Wrapped(const std::string& text, size_t width, size_t indent = 0);

// "a.jpg, b.jpg, c.jpg and 4 more", at most `most` of them by name.
std::string NamesInWords(const std::vector<std::string>& names, size_t most = 3);

// "1 object", "2 objects"
std::string Counted(size_t count, const char* what);

// The known name that a text probably misspells: the one with the fewest letters to insert, remove
// or replace, at most two and less than half of the name (the first of several); none without one.
std::optional<std::string> LikelyMeant(std::string_view text,
                                       const std::vector<std::string>& known);

// "7 near_border, 2 duplicate", the most frequent first; "none" when there are none.
std::string CountsInWords(const std::map<std::string, int>& counts);

}  // namespace soslam
