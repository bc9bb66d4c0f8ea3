// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "support/eventually.h"
#include "support/finished_run.h"
#include "support/run_command.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;

class StatusTest : public FinishedRunTest {
 protected:
  CommandResult StatusResult(const std::vector<std::string>& arguments) const {
    std::vector<std::string> words = {StageProgram("status"), "--results",
                                      pipeline_.Results().parent_path().string(), "--executables",
                                      SOSLAM_BINARY_DIR};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return RunCommand(words);
  }
  std::string Status(const std::vector<std::string>& arguments = {}) const {
    return ExpectSuccess(StatusResult(arguments));
  }
  std::string Explain(const std::string& stage, const std::string& variant) const {
    return Status({"--explain", stage, "--variants", variant});
  }
};

TEST_F(StatusTest, AfterARunEverythingIsDone) {
  const std::string status = Status({"--variants", kVariants});
  EXPECT_THAT(status, ContainsRegex("small +import +edges +initialise +refine +evaluate"));
  EXPECT_THAT(status, ContainsRegex("InitP +done +- +done +- +done"));
  EXPECT_THAT(status, ContainsRegex("InitPT +done +done +done +done +done"));
  EXPECT_THAT(Status(), ContainsRegex("OursP +done +- +- +done +- +missing +missing"));
  EXPECT_THAT(Explain("refine", "InitPT"),
              AllOf(ContainsRegex("small: refine-[0-9a-f]+ .*InitPT.* is done"),
                    HasSubstr("nothing that it is made from has changed")));
}

TEST_F(StatusTest, FailureIsShownWithItsErrorUntilTheStageRuns) {
  const fs::path image = pipeline_.Dataset() / "rgb/000002.png";
  const std::string whole_image = FileBytes(image);
  WriteBytes(image, "not an image");
  EXPECT_NE(pipeline_.Run(kVariants).exit_code, 0);
  const std::string status = Status({"--variants", kVariants});
  EXPECT_THAT(status, ContainsRegex("InitP +done +- +done +- +done"));
  EXPECT_THAT(status, ContainsRegex("InitPT +done +failed +done +stale +stale"));
  EXPECT_THAT(status, ContainsRegex("edges-[0-9a-f]+: its last run failed: exit code 3: .*000002"));
  WriteBytes(image, whole_image);
  ExpectSuccess(pipeline_.Run(kVariants));
  EXPECT_THAT(Status({"--variants", kVariants}),
              ContainsRegex("InitPT +done +done +done +done +done"));
}

// State during a run: the process that runs stages has the lock, and a stage has begun but not
// ended.
TEST_F(StatusTest, WhatBeganRunsAsLongAsTheLockIsHeld) {
  const fs::path stage = fs::canonical(pipeline_.Results() / "InitP/metrics.json").parent_path();
  WriteBytes(stage / "done.begun", "");
  const fs::path results = pipeline_.Results().parent_path();
  const auto under_way = [&] {
    return ExpectSuccess(RunCommand({SOSLAM_SOURCE_DIR "/pipelines/under-way", results.string()}));
  };
  WriteBytes(results / ".small.lock", "");
  EXPECT_EQ(under_way(), "");
  {
    const BackgroundCommand run({"flock", (results / ".small.lock").string(), "sleep", "600"});
    const std::string line = "small " + stage.filename().string() + " running\n";
    EXPECT_TRUE(Eventually([&] { return under_way() == line; }));
    WriteBytes(pipeline_.Folder() / "under_way", line);
    fs::remove(stage / "done");
    EXPECT_THAT(
        Status({"--variants", "InitP", "--under_way", (pipeline_.Folder() / "under_way").string()}),
        ContainsRegex("InitP +done +done +running"));
  }
  EXPECT_EQ(under_way(), "");
}

TEST_F(StatusTest, UnknownStageIsRefused) {
  EXPECT_THAT(ExpectExit(2, StatusResult({"--explain", "paint"})).errors,
              AllOf(HasSubstr("'paint'"), HasSubstr("initialise")));
}

class DoctorTest : public FinishedRunTest {
 protected:
  CommandResult Doctor() const {
    return RunCommand({StageProgram("doctor"), "--results",
                       pipeline_.Results().parent_path().string(), "--name", "small"});
  }
  void ReplaceAll(const std::string& file, const std::string& pattern,
                  const std::string& to) const {
    const std::string text = FileBytes(pipeline_.Dataset() / file);
    const std::string replaced = std::regex_replace(text, std::regex(pattern), to);
    ASSERT_NE(replaced, text);
    WriteBytes(pipeline_.Dataset() / file, replaced);
  }
};

TEST_F(DoctorTest, FindsNothingWhereNothingIsWrong) {
  EXPECT_EQ(ExpectSuccess(Doctor()),
            "small: 0 error(s), 0 warning(s) in 6 of 6 stage runs of 2 variant(s)\n");
}

TEST_F(DoctorTest, WarningsOfTheImportAreNoErrors) {
  ReplaceAll("detections.csv", ",1\\.0,", ",87.0,");
  ExpectSuccess(pipeline_.Run("InitP"));
  EXPECT_THAT(ExpectSuccess(Doctor()),
              AllOf(HasSubstr("warning: import (InitP InitPT): 12 of 12 scores"),
                    HasSubstr("likely cause  per cent"), HasSubstr("0 error(s), 1 warning(s)")));
}

TEST_F(DoctorTest, AStageThatFailedIsAnError) {
  ReplaceAll("planes.json", "\\[0, 0, 1\\]", "[0, 0, -1]");
  EXPECT_NE(pipeline_.Run("InitP").exit_code, 0);
  EXPECT_THAT(ExpectExit(1, Doctor()).output,
              AllOf(HasSubstr("error: import (InitP InitPT): "), HasSubstr("from below"),
                    HasSubstr("1 error(s)")));
}

TEST_F(DoctorTest, SettingsWithoutEffectAreWarnings) {
  pipeline_.WriteSettings({{"planes", {{"planes", "given"}, {"refine_poses", true}}}});
  EXPECT_THAT(ExpectSuccess(Doctor()),
              AllOf(HasSubstr("warning: settings: "),
                    HasSubstr("small.json: planes: refine_poses = true has no effect\n"),
                    HasSubstr("expected      planes = estimated or where_missing"),
                    HasSubstr("0 error(s), 1 warning(s)")));
  fs::rename(pipeline_.Pipelines() / "datasets/small.json",
             pipeline_.Pipelines() / "datasets/Small.json.txt");
  EXPECT_THAT(ExpectSuccess(Doctor()), HasSubstr("datasets/Small.json.txt is not read"));
}

TEST_F(DoctorTest, AMissingSemanticTableIsNamedBeforeAnythingRuns) {
  pipeline_.WriteSettings({{"semantic_table", "priors/mine.json"}});
  const auto is_named = AllOf(HasSubstr("datasets/small.json: 'semantic_table' is"),
                              HasSubstr("priors/mine.json does not exist"));
  EXPECT_THAT(ExpectExit(3, Doctor()).errors, is_named);
  EXPECT_THAT(ExpectExit(3, pipeline_.Run("InitP")).errors, is_named);
}

TEST_F(DoctorTest, WithoutAPlanThereIsNothingToSay) {
  std::filesystem::remove(pipeline_.Results() / "plan.mk");
  EXPECT_THAT(ExpectExit(3, Doctor()).errors, HasSubstr("nothing was planned yet"));
}

TEST_F(DoctorTest, WithoutANameThePlannedDatasetsAreNamed) {
  const std::string results = pipeline_.Results().parent_path().string();
  EXPECT_THAT(ExpectExit(2, RunCommand({StageProgram("doctor"), "--results", results})).errors,
              AllOf(HasSubstr("setting 'name' is ''"), HasSubstr(results + ": small")));
}

// Plans name the folder of settings relative to where they were made.
TEST_F(DoctorTest, ElsewhereItSaysWhereToStart) {
  const fs::path plan = pipeline_.Results() / "plan.mk";
  WriteBytes(plan, std::regex_replace(FileBytes(plan), std::regex("(^|\n)pipelines := [^\n]*"),
                                      "$1pipelines := pipelines_elsewhere"));
  EXPECT_THAT(ExpectExit(3, Doctor()).errors,
              AllOf(HasSubstr("'pipelines_elsewhere', is not there"), HasSubstr("started")));
}

}  // namespace
}  // namespace soslam
