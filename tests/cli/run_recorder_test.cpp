// SPDX-License-Identifier: BSD-3-Clause
// The record of a run, by way of a stage that reads and writes a few files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <functional>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/json_file.h"
#include "soslam/artefact/run_file.h"
#include "soslam/cli/command_line.h"
#include "soslam/system/hash.h"
#include "soslam/system/run_log.h"
#include "support/folder_test.h"
#include "support/lists.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

struct RecordedOptions {
  double offset_m = 1.5;
  int count = 3;
  int seed = 4;

  void Describe(OptionVisitor& visit) {
    visit.Real("offset_m", &offset_m, {-10, 10}, "An offset");
    visit.Integer("count", &count, {0, 10}, "A count");
    visit.Integer("seed", &seed, {0, 10}, "A seed");
  }
};

std::function<void()> before_writing;  // what else happens while the stage runs

void RunRecorded(const RecordedOptions& options, const StageFiles& files, int /*threads*/) {
  ParseJsonFile(files.at("sequence"));
  ParseJsonFile(files.at("dataset") / "lists/rgb.json");
  if (options.seed > 0) NoteSeed(options.seed);
  before_writing();
  WriteTextFile(files.at("output"), "made");
}

// Inputs as the pipeline has them: artefacts in folders beside that of the run, a dataset, and a
// table elsewhere.
class RunRecorderTest : public FolderTest {
 protected:
  RunRecorderTest() {
    before_writing = [] {};
    Write("results/one/sequence.json", "1");
    Write("data/room/lists/rgb.json", "2");
    Write("tables/table.json", "3");
    Write("results/two/settings.json", R"({"count": 5})");
  }

  int Run(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words = {"soslam-test"};
    for (const auto& [argument, path] : {std::pair("--sequence", "results/one/sequence.json"),
                                         {"--dataset", "data/room"},
                                         {"--table", "tables/table.json"},
                                         {"--settings", "results/two/settings.json"},
                                         {"--output", "results/two/out.json"}}) {
      words.insert(words.end(), {argument, (folder_ / path).string()});
    }
    words.insert(words.end(), more.begin(), more.end());
    std::vector<const char*> argv;
    for (const std::string& word : words) argv.push_back(word.c_str());
    const StageInfo info = {
        .name = "soslam-test",
        .purpose = "Tests the record of a run.",
        .inputs = {{"sequence", "A"}, {"dataset", "B"}, {"table", "C, which it does not open"}},
        .outputs = {{"output", "D"}},
        .example = "soslam-test"};
    testing::internal::CaptureStderr();
    const int exit_code =
        StageMain<RecordedOptions>(static_cast<int>(argv.size()), argv.data(), info, &RunRecorded);
    errors_ = testing::internal::GetCapturedStderr();
    return exit_code;
  }
  fs::path RecordFile() const { return folder_ / "results/two/run.json"; }
  RunRecord Record() const { return ReadRun(RecordFile()); }

  // "argument relative_to path" of each file.
  static std::vector<std::string> Places(const std::vector<RunFile>& files) {
    return Fields(files, [](const RunFile& file) {
      return file.argument.value_or("-") + " " + file.relative_to + " " + file.path.string();
    });
  }

  std::string errors_;
};

TEST_F(RunRecorderTest, SettingsHaveTheirOrigin) {
  ASSERT_EQ(Run({"--seed", "6"}), 0) << errors_;
  const RunRecord record = Record();
  ASSERT_EQ(record.settings->size(), 3u);
  EXPECT_EQ(record.settings->at("offset_m").value, 1.5);
  EXPECT_EQ(record.settings->at("offset_m").origin, "default");
  EXPECT_EQ(record.settings->at("count").value, 5);
  EXPECT_EQ(record.settings->at("count").origin, "settings file");
  EXPECT_EQ(record.settings->at("seed").value, 6);
  EXPECT_EQ(record.settings->at("seed").origin, "command line");
  EXPECT_EQ(record.seed, 6);
}

TEST_F(RunRecorderTest, FilesArePlacedSoThatTheyCanBeMoved) {
  ASSERT_EQ(Run(), 0) << errors_;
  const RunRecord record = Record();
  EXPECT_EQ(record.stage, "soslam-test");
  EXPECT_EQ(record.folders.at("dataset"), folder_ / "data/room");
  EXPECT_THAT(
      Places(record.inputs),
      testing::UnorderedElementsAre("sequence run ../one/sequence.json",
                                    "dataset dataset lists/rgb.json", "settings run settings.json",
                                    "table call " + (folder_ / "tables/table.json").string()));
  EXPECT_THAT(Places(record.outputs), testing::ElementsAre("output run out.json"));
  EXPECT_EQ(record.outputs[0].sha256, Sha256OfText("made"));
  const auto listed = std::ranges::find(record.inputs, "dataset", &RunFile::argument);
  EXPECT_EQ(listed->sha256, Sha256OfText("2"));
}

TEST_F(RunRecorderTest, AFailureIsRecordedAndNothingElseChanges) {
  ASSERT_EQ(Run(), 0);
  const std::string timing = FileBytes(folder_ / "results/two/timing.json");
  before_writing = [] { throw NothingUsableError("no object\nat all"); };
  EXPECT_EQ(Run(), 4);
  const RunRecord record = Record();
  EXPECT_EQ(record.exit_code, 4);
  EXPECT_EQ(record.error, "no object at all");
  EXPECT_EQ(record.inputs.size(), 4u);
  EXPECT_TRUE(record.outputs.empty());
  EXPECT_EQ(record.settings->at("count").value, 5);
  EXPECT_EQ(FileBytes(folder_ / "results/two/out.json"), "made");
  EXPECT_EQ(FileBytes(folder_ / "results/two/timing.json"), timing);
}

TEST_F(RunRecorderTest, SettingsThatAreNotValidAreRecordedAsNone) {
  EXPECT_EQ(Run({"--count", "11"}), 2);
  EXPECT_FALSE(Record().settings);
  EXPECT_THAT(Record().error, HasSubstr("count"));
}

TEST_F(RunRecorderTest, AMissingInputIsInTheErrorOnly) {
  fs::remove(folder_ / "data/room/lists/rgb.json");
  EXPECT_EQ(Run(), 3);
  EXPECT_THAT(Record().error, HasSubstr("rgb.json"));
  EXPECT_EQ(Record().inputs.size(), 3u);
}

TEST_F(RunRecorderTest, AnInputThatIsReplacedMeanwhileFailsTheRun) {
  Write("results/two/out.json", "earlier");
  for (const char* input : {"results/one/sequence.json", "data/room/lists/rgb.json"}) {
    const std::string before = FileBytes(folder_ / input);
    before_writing = [&] {
      Write("new", "9");
      fs::rename(folder_ / "new", folder_ / input);
    };
    EXPECT_EQ(Run(), 3);
    EXPECT_THAT(errors_, HasSubstr(input));
    EXPECT_THAT(errors_, HasSubstr("was changed while this run used it"));
    EXPECT_EQ(FileBytes(folder_ / "results/two/out.json"), "earlier");
    for (const RunFile& file : Record().inputs) {
      EXPECT_NE(file.sha256, Sha256OfText("9")) << "it was not what was read";
    }
    WriteBytes(folder_ / input, before);
  }
}

TEST_F(RunRecorderTest, WhereNoRecordCanBeWrittenTheErrorIsThatOfTheRun) {
  fs::remove_all(folder_ / "results/two");
  EXPECT_EQ(Run(), 2);
  EXPECT_THAT(errors_, HasSubstr("settings.json: no such file"));
}

TEST_F(RunRecorderTest, ARecordThatCannotBeWrittenFailsTheRun) {
  fs::create_directory(folder_ / "results/two/timing.json");
  EXPECT_EQ(Run(), 2);
  EXPECT_THAT(errors_, HasSubstr("timing.json: cannot be written"));
  EXPECT_EQ(Record().exit_code, 2);
  EXPECT_EQ(Record().inputs.size(), 4u);
  EXPECT_EQ(Record().outputs.size(), 1u);
}

TEST_F(RunRecorderTest, FilesOfOthersAreNotReplaced) {
  const auto never = [] { ADD_FAILURE() << "the stage has run"; };
  for (const char* name : {"run.json", "timing.json"}) {
    const std::string file = std::string("results/two/") + name;
    for (const char* text : {"{\"runs\": 3}", "[1]", "walk 3"}) {
      SCOPED_TRACE(file + text);
      Write(file, text);
      before_writing = never;
      EXPECT_EQ(Run(), 2);
      EXPECT_THAT(errors_, HasSubstr(file + ": is no record of soslam"));
      EXPECT_EQ(FileBytes(folder_ / file), text);
    }
    fs::remove(folder_ / file);
    before_writing = [] {};
    EXPECT_EQ(Run(), 0) << errors_;
    EXPECT_EQ(Run(), 0) << errors_;
    Write(file, "");
    EXPECT_EQ(Run(), 0) << errors_;
    EXPECT_NE(FileBytes(folder_ / file), "");
  }
}

TEST_F(RunRecorderTest, PathsThatTheFileSystemRefusesAreBadInput) {
  fs::remove(folder_ / "results/one/sequence.json");
  fs::create_symlink("sequence.json", folder_ / "results/one/sequence.json");  // to itself
  EXPECT_EQ(Run(), 3);
  EXPECT_THAT(errors_, HasSubstr("sequence.json: cannot be read"));
}

}  // namespace
}  // namespace soslam
