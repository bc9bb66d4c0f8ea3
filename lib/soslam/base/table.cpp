// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <string_view>

#include "soslam/base/text.h"

namespace soslam {
namespace {

std::string MarkdownText(const std::string& text) {
  constexpr std::string_view kSpecial = "\\|*`<";
  std::string escaped;
  for (const char c : text) {
    if (kSpecial.find(c) != std::string_view::npos) escaped += '\\';
    escaped += c;
  }
  return escaped;
}

std::string MarkdownText(const Cell& cell) {
  const std::string text = MarkdownText(cell.text);
  return cell.bold ? "**" + text + "**" : text;
}

std::string LatexText(const std::string& text) {
  constexpr std::string_view kPlusMinus = "±", kSpecial = "_&%$#{}";
  std::string escaped;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool is_sign = c == '-' && (i == 0 || text[i - 1] == ' ' || text[i - 1] == '[') &&
                         i + 1 < text.size() &&
                         std::isdigit(static_cast<unsigned char>(text[i + 1]));
    if (text.compare(i, kPlusMinus.size(), kPlusMinus) == 0) {
      escaped += "$\\pm$";
      i += kPlusMinus.size() - 1;
    } else if (is_sign || c == '<' || c == '>') {
      escaped += fmt::format("${}$", c);
    } else if (c == '\\') {
      escaped += "\\textbackslash{}";
    } else if (c == '~') {
      escaped += "\\textasciitilde{}";
    } else if (c == '^') {
      escaped += "\\textasciicircum{}";
    } else {
      if (kSpecial.find(c) != kSpecial.npos) escaped += '\\';
      escaped += c;
    }
  }
  return escaped;
}

std::string LatexText(const Cell& cell) {
  if (cell.text == kNoValue) return "--";
  const std::string text = LatexText(cell.text);
  return cell.bold ? "\\textbf{" + text + "}" : text;
}

template <typename Values, typename Format>
std::vector<std::string> Formatted(const Values& values, const Format& format) {
  std::vector<std::string> texts;
  for (const auto& value : values) texts.push_back(format(value));
  return texts;
}

}  // namespace

std::string CsvText(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

std::string ToMarkdown(const Table& table) {
  const auto format = [](const Cell& cell) { return MarkdownText(cell); };
  std::vector<std::vector<std::string>> lines = {Formatted(table.header, format)};
  for (const auto& row : table.rows) lines.push_back(Formatted(row, format));
  std::vector<size_t> widths(lines.front().size(), 0);
  for (const auto& line : lines) {
    for (size_t i = 0; i < line.size(); ++i)
      widths[i] = std::max(widths[i], CountCharacters(line[i]));
  }
  const auto format_line = [&](const std::vector<std::string>& line) {
    std::string text = "|";
    for (size_t i = 0; i < line.size(); ++i) {
      const std::string padding(widths[i] - CountCharacters(line[i]), ' ');
      text += i < table.left_columns ? " " + line[i] + padding : " " + padding + line[i];
      text += " |";
    }
    return text + "\n";
  };
  std::string text =
      fmt::format("## {}\n\n{}|", MarkdownText(table.title), format_line(lines.front()));
  for (size_t i = 0; i < widths.size(); ++i) {
    text += std::string(widths[i] + 1, '-') + (i < table.left_columns ? "-|" : ":|");
  }
  text += "\n";
  for (size_t i = 1; i < lines.size(); ++i) text += format_line(lines[i]);
  for (const std::string& note : table.notes) text += "\n" + MarkdownText(note) + "\n";
  return text;
}

std::string ToCsv(const Table& table) {
  const auto format = [](const Cell& cell) { return CsvText(cell.text); };
  std::string text = fmt::format("{}\n", fmt::join(Formatted(table.header, format), ","));
  for (const auto& row : table.rows) {
    text += fmt::format("{}\n", fmt::join(Formatted(row, format), ","));
  }
  return text;
}

std::string ToLatex(const Table& table) {
  const auto format = [](const Cell& cell) { return LatexText(cell); };
  const auto format_row = [&](const auto& row) {
    return fmt::format("{} \\\\\n", fmt::join(Formatted(row, format), " & "));
  };
  const std::string columns = std::string(table.left_columns, 'l') +
                              std::string(table.header.size() - table.left_columns, 'r');
  std::string text = fmt::format(
      "% Needs \\usepackage{{booktabs}}.\n\\begin{{table*}}\n\\centering\\footnotesize"
      "\\setlength{{\\tabcolsep}}{{3pt}}\n"
      "\\caption{{{}}}\n\\label{{tab:{}}}\n\\begin{{tabular}}{{{}}}\n\\toprule\n",
      LatexText(table.title), table.name, columns);
  text += format_row(table.header) + "\\midrule\n";
  for (const auto& row : table.rows) text += format_row(row);
  text += "\\bottomrule\n\\end{tabular}\n";
  for (const std::string& note : table.notes) text += "\\par\\smallskip " + LatexText(note) + "\n";
  return text + "\\end{table*}\n";
}

}  // namespace soslam
