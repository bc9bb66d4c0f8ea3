// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/base/table.h"

#include <gtest/gtest.h>

namespace soslam {
namespace {

TEST(TableMarkdown, PadsByCharactersAndEscapesMarkup) {
  const Table table = {"t",
                       "Numbers",
                       {"name", "metres", "s"},
                       {{"a", "5 ± 1", "7"}, {"a|b*c`d<e\\f_g", Cell("10.5", true), "-"}},
                       1,
                       {"A note."}};
  EXPECT_EQ(ToMarkdown(table),
            "## Numbers\n"
            "\n"
            "| name               |   metres | s |\n"
            "|--------------------|---------:|--:|\n"
            "| a                  |    5 ± 1 | 7 |\n"
            "| a\\|b\\*c\\`d\\<e\\\\f_g | **10.5** | - |\n"
            "\n"
            "A note.\n");
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
                 {{"a_b", "c", Cell("-1.5", true)}, {"\\{}_&%$#~^<>", "Init1-1", "-"}},
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
            "\\textbackslash{}\\{\\}\\_\\&\\%\\$\\#\\textasciitilde{}\\textasciicircum{}"
            "$<$$>$ & Init1-1 & -- \\\\\n"
            "\\bottomrule\n"
            "\\end{tabular}\n"
            "\\par\\smallskip 5 $\\pm$ 1\n"
            "\\end{table*}\n");
}

}  // namespace
}  // namespace soslam
