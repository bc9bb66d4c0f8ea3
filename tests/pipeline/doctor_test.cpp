// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/finished_run.h"

namespace soslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class DoctorTest : public FinishedRunTest {
 protected:
  CommandResult Doctor() const {
    return RunCommand({StageProgram("doctor"), "--results",
                       pipeline_.Results().parent_path().string(), "--name", "small"});
  }
  // Replaces text in a file of the dataset, everywhere.
  void ReplaceAll(const std::string& file, const std::string& from, const std::string& to) const {
    std::string text = FileBytes(pipeline_.Dataset() / file);
    size_t found = text.find(from);
    ASSERT_NE(found, std::string::npos);
    for (; found != std::string::npos; found = text.find(from, found + to.size())) {
      text.replace(found, from.size(), to);
    }
    WriteBytes(pipeline_.Dataset() / file, text);
  }
};

TEST_F(DoctorTest, FindsNothingWhereNothingIsWrong) {
  const CommandResult result = Doctor();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.output,
            "small: 0 error(s), 0 warning(s) in 6 of 6 stage runs of 2 variant(s)\n");
}

TEST_F(DoctorTest, WarningsOfTheImportAreNoErrors) {
  ReplaceAll("detections.csv", ",1.0,", ",87.0,");
  ASSERT_EQ(pipeline_.Run("InitP").exit_code, 0);
  const CommandResult result = Doctor();
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_THAT(result.output,
              AllOf(HasSubstr("warning: import (InitP InitPT): 12 of 12 scores"),
                    HasSubstr("likely cause  per cent"), HasSubstr("0 error(s), 1 warning(s)")));
}

TEST_F(DoctorTest, AStageThatFailedIsAnError) {
  ReplaceAll("planes.json", "[0, 0, 1]", "[0, 0, -1]");
  EXPECT_NE(pipeline_.Run("InitP").exit_code, 0);
  const CommandResult result = Doctor();
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.output, AllOf(HasSubstr("error: import (InitP InitPT): "),
                                   HasSubstr("from below"), HasSubstr("1 error(s)")));
}

TEST_F(DoctorTest, WithoutAPlanThereIsNothingToSay) {
  std::filesystem::remove(pipeline_.Results() / "plan.mk");
  const CommandResult result = Doctor();
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_THAT(result.errors, HasSubstr("nothing was planned yet"));
}

}  // namespace
}  // namespace soslam
