// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/csv_line.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "dataset/text_file.h"

namespace soslam {
namespace {

// Content of the quoted field at the beginning of `rest`, which becomes the text after the field.
std::string TakeQuoted(std::string_view* rest, const std::string& place) {
  std::string field;
  for (size_t i = 1; i < rest->size(); ++i) {
    if ((*rest)[i] != '"') {
      field += (*rest)[i];
    } else if (i + 1 < rest->size() && (*rest)[i + 1] == '"') {
      field += (*rest)[++i];
    } else {
      rest->remove_prefix(i + 1);
      return std::string(Trimmed(field));
    }
  }
  throw InputError(place + ": has a quote that is not closed; expected \"field\" on one line");
}

}  // namespace

char SeparatorOf(std::string_view header) {
  char most = ',';
  for (const char separator : {';', '\t'}) {
    if (std::ranges::count(header, separator) > std::ranges::count(header, most)) most = separator;
  }
  return most;
}

std::vector<std::string> SplitCsvLine(std::string_view line, char separator,
                                      const std::string& place) {
  std::vector<std::string> fields;
  for (std::string_view rest = line;;) {
    const size_t begin = rest.find_first_not_of(' ');
    const bool is_quoted = begin != std::string_view::npos && rest[begin] == '"';
    if (is_quoted) {
      rest.remove_prefix(begin);
      fields.push_back(TakeQuoted(&rest, place));
    }
    const size_t end = std::min(rest.find(separator), rest.size());
    const std::string_view text = Trimmed(rest.substr(0, end));
    if (!is_quoted) fields.emplace_back(text);
    if (is_quoted && !text.empty()) {
      throw InputError(fmt::format("{}: has '{}' after a quoted field; expected '{}'", place, text,
                                   separator == '\t' ? "tab" : std::string(1, separator)));
    }
    if (end == rest.size()) return fields;
    rest.remove_prefix(end + 1);
  }
}

}  // namespace soslam
