// SPDX-License-Identifier: BSD-3-Clause
#include "base/text.h"

#include <fmt/format.h>

namespace soslam {
namespace {

// The begin and the end of a long text in UTF-8, cut between characters.
std::string WithoutMiddle(const std::string& text) {
  constexpr size_t kMaxHalf = 1000;
  if (text.size() <= 2 * kMaxHalf) return text;
  const auto is_inside_character = [&](size_t i) { return (text[i] & 0xC0) == 0x80; };
  size_t begin = kMaxHalf;
  size_t end = text.size() - kMaxHalf;
  while (begin > 0 && is_inside_character(begin)) --begin;
  while (end < text.size() && is_inside_character(end)) ++end;
  return text.substr(0, begin) + " ... " + text.substr(end);
}

}  // namespace

std::string OneLine(const std::string& message) {
  const std::string text = message.substr(0, message.find_last_not_of('\n') + 1);
  std::string line;
  for (const char character : text) {
    const bool is_control = static_cast<unsigned char>(character) < 0x20 || character == 0x7F;
    if (character == '\n') {
      line += ' ';
    } else if (is_control) {
      line += fmt::format("\\x{:02x}", static_cast<unsigned char>(character));
    } else {
      line += character;
    }
  }
  return WithoutMiddle(line);
}

}  // namespace soslam
