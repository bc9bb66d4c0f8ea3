// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/text_file.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

using testing::ElementsAre;

TEST(CsvLineTest, SeparatorIsWhatTheHeaderHasMostOf) {
  EXPECT_EQ(SeparatorOf("frame,label"), ',');
  EXPECT_EQ(SeparatorOf("frame;label, of what;score"), ';');
  EXPECT_EQ(SeparatorOf("frame\tlabel"), '\t');
  EXPECT_EQ(SeparatorOf("frame"), ',');
}

TEST(CsvLineTest, FieldsAreTrimmedAndUnquoted) {
  EXPECT_THAT(SplitCsvLine("0, cup ,,1", ',', ""), ElementsAre("0", "cup", "", "1"));
  EXPECT_THAT(SplitCsvLine(R"("0" , "a, ""big"" cup",'x')", ',', ""),
              ElementsAre("0", "a, \"big\" cup", "'x'"));
  EXPECT_THAT(SplitCsvLine("0;a, b;", ';', ""), ElementsAre("0", "a, b", ""));
  EXPECT_THAT(SplitCsvLine("0\t\t\"\"\t1", '\t', ""), ElementsAre("0", "", "", "1"));
  EXPECT_THAT(SplitCsvLine("5\" cup,1", ',', ""), ElementsAre("5\" cup", "1"));
}

TEST(CsvLineTest, BrokenQuotesAreRefused) {
  ExpectError<InputError>([] { SplitCsvLine("0,\"cup,1", ',', "a.csv:2"); },
                          {"a.csv:2", "not closed"});
  ExpectError<InputError>([] { SplitCsvLine("0,\"cup\" 1,2", ',', "a.csv:2"); },
                          {"a.csv:2", "'1' after a quoted field", "','"});
}

}  // namespace
}  // namespace soslam
