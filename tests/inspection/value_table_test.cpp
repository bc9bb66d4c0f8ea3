// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/value_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace soslam {
namespace {

ValueTable SmallTable() {
  return {{{"label", ""}, {"x", "m", 2}, {"share", "%", 1}, {"count", ""}, {"flag", ""}},
          {{"b\xc3\xa4r", 1.0 / 3.0, nullptr, 12, true}, {"c", -10.0, nullptr, 3, false}}};
}

TEST(ValueTableTest, ColumnsLineUpAndEmptyOnesAreLeftOut) {
  EXPECT_EQ(FormatTable(SmallTable(), false),
            "label       x  count  flag\n"
            "            m\n"
            "b\xc3\xa4r      0.33     12  yes\n"
            "c      -10.00      3  no\n");
}

TEST(ValueTableTest, OnlyTheHeadIsColoured) {
  const std::string plain = FormatTable(SmallTable(), false);
  const std::string coloured = FormatTable(SmallTable(), true);
  EXPECT_THAT(plain, testing::Not(testing::HasSubstr("\x1b")));
  const size_t rows = plain.find("b\xc3\xa4r");
  EXPECT_THAT(coloured, testing::StartsWith("\x1b["));
  EXPECT_THAT(coloured, testing::EndsWith(plain.substr(rows)));
}

TEST(ValueTableTest, CsvHasAllColumnsAndAllDigits) {
  EXPECT_EQ(FormatCsv(SmallTable()),
            "label,x_m,share_percent,count,flag\n"
            "b\xc3\xa4r,0.3333333333333333,,12,true\n"
            "c,-10,,3,false\n");
}

}  // namespace
}  // namespace soslam
