// SPDX-License-Identifier: BSD-3-Clause
#include "base/table.h"

#include <gtest/gtest.h>

namespace soslam {
namespace {

Table TwoColumns(const std::string& name, const Cell& cell) {
  return {"numbers", "Numbers", {"name", "x"}, {{name, cell}}, 1, {}};
}

TEST(TableMarkdown, PadsNamesToTheRightAndNumbersToTheLeft) {
  const Table table = {"t",
                       "Numbers",
                       {"name", "metres", "s"},
                       {{"a", "1.25", "7"}, {"longer", Cell("10.5", true), "-"}},
                       1,
                       {"A note."}};
  EXPECT_EQ(ToMarkdown(table),
            "## Numbers\n"
            "\n"
            "| name   |   metres | s |\n"
            "|--------|---------:|--:|\n"
            "| a      |     1.25 | 7 |\n"
            "| longer | **10.5** | - |\n"
            "\n"
            "A note.\n");
}

TEST(TableMarkdown, PadsByCharactersNotBytes) {
  EXPECT_EQ(ToMarkdown(TwoColumns("n", "5 ± 1")),
            "## Numbers\n"
            "\n"
            "| name |     x |\n"
            "|------|------:|\n"
            "| n    | 5 ± 1 |\n");
}

TEST(TableMarkdown, EscapesWhatWouldBeMarkup) {
  const std::string text = ToMarkdown(TwoColumns("a|b*c`d<e\\f_g", "1"));
  EXPECT_NE(text.find("| a\\|b\\*c\\`d\\<e\\\\f_g | 1 |"), std::string::npos) << text;
}

TEST(TableCsv, QuotesWhatWouldBeSyntax) {
  const Table table = {
      "t", "Numbers",  {"name", "x"}, {{"a,b", "1"}, {"say \"b\"", Cell("2", true)}},
      1,   {"A note."}};
  EXPECT_EQ(ToCsv(table),
            "name,x\n"
            "\"a,b\",1\n"
            "\"say \"\"b\"\"\",2\n");
}

TEST(TableLatex, IsATableWithRulesOfBooktabs) {
  Table table = {"numbers",
                 "50 % of_all",
                 {"name", "set", "x"},
                 {{"a_b", "c", Cell("-1.5", true)}, {"d", "e", "-"}},
                 2,
                 {"5 ± 1"}};
  EXPECT_EQ(ToLatex(table),
            "% Needs \\usepackage{booktabs}.\n"
            "\\begin{table*}\n"
            "\\centering\\footnotesize\\setlength{\\tabcolsep}{3pt}\n"
            "\\caption{50 \\% of\\_all}\n"
            "\\label{tab:numbers}\n"
            "\\begin{tabular}{llr}\n"
            "\\toprule\n"
            "name & set & x \\\\\n"
            "\\midrule\n"
            "a\\_b & c & \\textbf{$-$1.5} \\\\\n"
            "d & e & -- \\\\\n"
            "\\bottomrule\n"
            "\\end{tabular}\n"
            "\\par\\smallskip 5 $\\pm$ 1\n"
            "\\end{table*}\n");
}

TEST(TableLatex, EscapesEverySpecialCharacter) {
  const std::string text = ToLatex(TwoColumns("\\{}_&%$#~^<>", "Init1-1"));
  EXPECT_NE(text.find("\\textbackslash{}\\{\\}\\_\\&\\%\\$\\#\\textasciitilde{}\\textasciicircum{}"
                      "$<$$>$ & Init1-1 \\\\\n"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace soslam
