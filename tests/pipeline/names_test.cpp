// SPDX-License-Identifier: BSD-3-Clause
// Names that mean something to make or the shell: refused from the caller, harmless in files of
// others.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "support/run_command.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

// A small pipeline, and the project's commands with what the caller sets for it.
class NamesTest : public testing::Test {
 protected:
  CommandResult Make(const std::string& goal, std::vector<std::string> settings) const {
    settings.push_back(goal);
    return RunCommand(pipeline_.WordsOfProject(settings));
  }
  CommandResult Command(const std::string& command, const std::vector<std::string>& options) const {
    return RunCommand(pipeline_.WordsOfCommand(command, options));
  }
  void ExpectRefused(const std::string& option, const std::string& value,
                     const std::string& expected) const {
    SCOPED_TRACE(option + " " + value);
    const std::string errors = ExpectExit(2, Command("run-built", {option, value})).errors;
    EXPECT_THAT(errors, HasSubstr(expected));
    EXPECT_EQ(std::ranges::count(errors, '\n'), 1) << errors;
    EXPECT_FALSE(fs::exists(Marker()));
    EXPECT_FALSE(fs::exists(pipeline_.Results() / "plan.mk"));
  }
  // What a name that is carried out would make.
  fs::path Marker() const { return pipeline_.Folder() / "marker"; }

  SmallPipeline pipeline_{3};
};

TEST_F(NamesTest, OfTheCallerAreNeverCarriedOut) {
  const std::string touch = "touch " + Marker().string();
  for (const std::string& text : {"a;" + touch + ";'`" + touch + "`", "$(shell " + touch + ")"}) {
    for (const std::string option : {"dataset", "data_root", "results", "pipelines", "build",
                                     "variant", "threads", "jobs", "outside_paths"}) {
      ExpectRefused("--" + option, text, "expected");
    }
    for (const std::string option : {"annotations", "networks", "without", "downloads"}) {
      EXPECT_NE(Command("data", {"--" + option, text}).exit_code, 0);
    }
    EXPECT_FALSE(fs::exists(Marker()));
  }
}

TEST_F(NamesTest, OfTheCallerAreNeitherSplitNorOptions) {
  for (const std::string option : {"--data_root", "--results", "--pipelines", "--build"}) {
    ExpectRefused(option, "a b", "expected one folder without spaces");
  }
  for (const std::string name : {"a b", "-n", ".", "..", "../data/..", "/"}) {
    ExpectRefused("--dataset", name, "data root");
  }
  ExpectRefused("--dataset", "/elsewhere/room/", "(or dataset room, data root /elsewhere)");
  EXPECT_THAT(ExpectExit(2, Command("run", {"--dataset", "nowhere"})).errors,
              HasSubstr("dataset is 'nowhere'; there is no such folder"));
  ExpectRefused("--variant", "OursX", "no such variant");
  EXPECT_THAT(ExpectExit(2, Command("run", {"--variant", "OursX"})).errors,
              HasSubstr("variant 'OursX': no such variant; known are"));
  ExpectRefused("--variants", "OursS", "--variants: no such option");
  EXPECT_THAT(ExpectExit(2, Command("fly", {})).errors, HasSubstr("'fly': no such command"));
  EXPECT_THAT(ExpectExit(2, Command("run", {"--variant"})).errors,
              HasSubstr("expected a value after it"));
  EXPECT_THAT(ExpectExit(2, Make("run-built", {"VARIANTS=OursS"})).errors,
              HasSubstr("VARIANTS=...: no variable of this Makefile"));
}

TEST_F(NamesTest, WhatIsNotThereIsSaid) {
  EXPECT_THAT(ExpectExit(3, Command("doctor", {"--dataset", "nowhere"})).errors,
              HasSubstr("nowhere: no such dataset folder"));
  fs::create_directories(pipeline_.Results() / "OursS");
  WriteBytes(pipeline_.Results() / "OursS/map.json", "{}");
  for (const std::string command : {"export", "check-minima"}) {
    EXPECT_THAT(ExpectExit(2, Command(command, {"--variant", "Typo"})).errors,
                HasSubstr("no map.json of variant 'Typo'"));
  }
  EXPECT_THAT(ExpectExit(2, Command("reproduce", {})).errors, HasSubstr("about all datasets"));
}

TEST_F(NamesTest, MakeRefusesWhatItWouldSplitOrIgnore) {
  fs::create_directories(pipeline_.Results());
  WriteBytes(pipeline_.Results() / "plan.mk", "");
  for (const auto& [goal, setting, expected] : std::vector<std::array<std::string, 3>>{
           {"clean", "RESULTS=a b", "expected one folder without spaces"},
           {"clean", "RESULTS=", "expected one folder without spaces"},
           {"distclean", "BUILD=a b", "expected one folder without spaces"},
           {"demo", "NAME=room", "takes no NAME"},
           {"clean", "NAME=room", "no such map"},
           {"sweep", "DATASETS=/elsewhere/small", "expected a folder in DATA_ROOT"}}) {
    EXPECT_THAT(ExpectExit(2, Make(goal, {setting})).errors, HasSubstr(expected)) << setting;
  }
  EXPECT_TRUE(fs::exists(pipeline_.Results() / "plan.mk"));
}

TEST_F(NamesTest, ADatasetMayBeNamedByItsPath) {
  const std::string path = pipeline_.Dataset().string();
  for (const std::string& name : {path, path + "/", std::string("small/")}) {
    ExpectSuccess(Command("run-built", {"--dataset", name, "--variant", "SVD"}));
    EXPECT_TRUE(fs::exists(pipeline_.Results() / "SVD/metrics.json"));
    fs::remove_all(pipeline_.Results());
    ExpectSuccess(Make("run-built", {"DATASET=" + name, "VARIANT=SVD"}));
    EXPECT_TRUE(fs::exists(pipeline_.Results() / "SVD/metrics.json"));
    fs::remove_all(pipeline_.Results());
  }
}

TEST_F(NamesTest, OfImagesMayBeAnything) {
  const std::vector<std::string> names = {"$(touch marker).png", "-n a'b\";touch marker.png",
                                          "%41`touch marker`\\.png"};
  std::ofstream list(pipeline_.Dataset() / "rgb.txt");
  for (size_t i = 0; i < names.size(); ++i) {
    fs::rename(pipeline_.Dataset() / ("rgb/00000" + std::to_string(i) + ".png"),
               pipeline_.Dataset() / names[i]);
    list << 0.1 * static_cast<double>(i) << " " << names[i] << "\n";
  }
  list.close();
  ExpectSuccess(Make("run-built", {"VARIANT=OursPT"}));
  EXPECT_TRUE(fs::exists(pipeline_.Results() / "OursPT/metrics.json"));
  EXPECT_FALSE(fs::exists(SOSLAM_SOURCE_DIR "/marker"));
  ExpectSuccess(
      RunCommand({StageProgram("pages"), "--results", pipeline_.Results().parent_path().string()}));
}

// Folders in results that came from others.
TEST_F(NamesTest, OfResultsMayBeAnything) {
  const fs::path results = pipeline_.Results().parent_path();
  fs::create_directories(pipeline_.Results() / "$(touch marker);touch marker");
  fs::create_directories(results / "kept");
  WriteBytes(pipeline_.Results() / "plan.mk", "");
  WriteBytes(pipeline_.Results() / "$(touch marker);touch marker/map.json", "{}");
  const CommandResult refused = Make("export", {"BIN=" SOSLAM_BINARY_DIR});
  EXPECT_NE(refused.exit_code, 0);
  EXPECT_THAT(refused.errors, HasSubstr("$(touch marker);touch marker"));

  const fs::path two_words = results / "a kept";
  fs::create_directories(two_words);
  WriteBytes(two_words / "plan.mk", "");
  ExpectSuccess(Make("clean", {}));
  EXPECT_FALSE(fs::exists(SOSLAM_SOURCE_DIR "/marker"));
  EXPECT_FALSE(fs::exists(two_words));
  EXPECT_FALSE(fs::exists(pipeline_.Results()));
  EXPECT_TRUE(fs::exists(results / "kept"));
}

// A folder with a build of its own, in which `target` is made from `source`, as one may only read
// it.
class ForeignBuildTest : public testing::Test {
 protected:
  ForeignBuildTest() {
    WriteBytes(folder_ / "build.ninja",
               "rule copy\n  command = cp $in $out\nbuild target: copy source\n"
               "build build.ninja: phony always\nbuild always: phony\n");
    WriteBytes(folder_ / "source", "1");
  }
  CommandResult Build() const {
    return RunCommand({"unshare", "--mount", "sh", "-c",
                       "mount --bind -o ro \"$1\" \"$1\" && exec \"$0\" \"$1\" target",
                       SOSLAM_SOURCE_DIR "/pipelines/build.sh", folder_.path().string()});
  }
  bool CanMount() const {
    return RunCommand({"unshare", "--mount", "mount", "--bind", folder_.path().string(),
                       folder_.path().string()})
               .exit_code == 0;
  }

  TemporaryFolder folder_;
};

TEST_F(ForeignBuildTest, HasToBeUpToDate) {
  if (!CanMount()) GTEST_SKIP() << "needs root, to mount a folder";
  EXPECT_THAT(ExpectExit(2, Build()).errors,
              testing::AllOf(HasSubstr("not up to date"), HasSubstr("BUILD=")));
  EXPECT_FALSE(fs::exists(folder_ / "target"));

  ExpectSuccess(RunCommand({"ninja", "-C", folder_.path().string(), "target"}));
  EXPECT_EQ(ExpectExit(0, Build()).errors, "");
}

}  // namespace
}  // namespace soslam
