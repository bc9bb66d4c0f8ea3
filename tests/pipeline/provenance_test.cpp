// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <set>

#include "soslam/artefact/json_file.h"
#include "soslam/artefact/run_file.h"
#include "soslam/system/hash.h"
#include "support/finished_run.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

class ProvenanceTest : public FinishedRunTest {
 protected:
  fs::path Results() const { return pipeline_.Folder() / "results"; }
  // The folder of the only run of a stage.
  fs::path RunOf(const std::string& stage) const {
    for (const auto& entry : fs::directory_iterator(pipeline_.Results() / "shared")) {
      if (entry.path().filename().string().starts_with(stage + "-")) return entry.path();
    }
    ADD_FAILURE() << "no run of " << stage;
    return {};
  }
  CommandResult Verify() const {
    return RunCommand({StageProgram("verify"), "--results", Results().string()});
  }
  CommandResult Reproduce() const {
    return RunCommand({StageProgram("reproduce"), "--results", Results().string(), "--executables",
                       SOSLAM_BINARY_DIR, "--threads", "2"});
  }
  std::map<std::string, std::string> FilesBelow(const fs::path& folder) const {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
      if (entry.is_regular_file()) files[entry.path().string()] = FileBytes(entry.path());
    }
    return files;
  }
};

TEST_F(ProvenanceTest, RecordsNameEveryFileThatAStageRead) {
  std::set<fs::path> read;
  for (const RunFile& file : ReadRun(RunOf("edges") / "run.json").inputs) read.insert(file.path);
  EXPECT_EQ(read.size(), SmallPipeline::kFrames + 2u);  // and the sequence, the settings
  EXPECT_TRUE(read.contains("rgb/000003.png"));
  EXPECT_TRUE(read.contains("../" + RunOf("import").filename().string() + "/sequence.json"));
  read.clear();
  for (const RunFile& file : ReadRun(RunOf("import") / "run.json").inputs) read.insert(file.path);
  for (const char* table : {"rgb.txt", "camera.json", "planes.json", "objects.json",
                            "detections.csv", "groundtruth.txt"}) {
    EXPECT_TRUE(read.contains(table)) << table;
  }
  EXPECT_TRUE(ReadRun(pipeline_.Dataset() / "run.json").seed) << "synthesise draws noise";
}

TEST_F(ProvenanceTest, AFailedRunIsRecordedAndFound) {
  EXPECT_THAT(ExpectSuccess(Verify()), ContainsRegex("small +\\| - +\\|"));
  const auto before = SmallPipeline::Artefacts(pipeline_.Results());
  const fs::path image = pipeline_.Dataset() / "rgb/000002.png";
  WriteBytes(image, FileBytes(image).substr(0, 1000));
  EXPECT_NE(pipeline_.Run(kVariants).exit_code, 0);
  EXPECT_TRUE(SmallPipeline::Artefacts(pipeline_.Results()) == before);
  EXPECT_NE(pipeline_.Run(kVariants).exit_code, 0) << "a failure is not forgotten";
  const RunRecord record = ReadRun(RunOf("edges") / "run.json");
  EXPECT_EQ(record.exit_code, 3);
  EXPECT_THAT(record.error, HasSubstr("000002.png"));
  EXPECT_TRUE(record.outputs.empty());
  EXPECT_THAT(ExpectExit(1, Verify()).output,
              ContainsRegex("edges-[0-9a-f]+: its last run failed: exit code 3.* \\(InitPT\\)\n"));
  EXPECT_THAT(Reproduce().output,
              AllOf(ContainsRegex("not rerun .*edges-[0-9a-f]+: it failed when it was recorded"),
                    ContainsRegex("not rerun .*refine-[0-9a-f]+: .*edges.h5, which it reads")));
}

// A program that crashes cannot write a record; make writes down that it failed.
TEST_F(ProvenanceTest, ACrashKeepsTheRecordOfTheRunBefore) {
  const std::string record = FileBytes(RunOf("refine") / "run.json");
  EXPECT_NE(pipeline_.Run(kVariants, {"BIN=" + pipeline_.ProgramsWithACrashIn("refine")}).exit_code,
            0);
  EXPECT_EQ(FileBytes(RunOf("refine") / "run.json"), record);
  EXPECT_THAT(ExpectExit(1, Verify()).output,
              ContainsRegex("refine-[0-9a-f]+: its last run failed: exit code 139"));
}

TEST_F(ProvenanceTest, ReproducesEveryByteAndLeavesTheResultsAlone) {
  // What is recorded counts, not what the pipelines say now.
  nlohmann::json settings = SmallPipeline::TrueRatios();
  settings["refine"]["yaw_step_deg"] = 5.0;
  pipeline_.WriteSettings(settings);
  const auto before = FilesBelow(pipeline_.Folder());
  const std::string output = ExpectSuccess(Reproduce());
  for (const char* file : {"sequence.json", "edges.h5", "initial.json", "refined.json",
                           "symmetry.h5", "metrics.json"}) {
    EXPECT_THAT(output, ContainsRegex("same +/[^\n]*" + std::string(file) + "\n"));
  }
  EXPECT_THAT(output, AllOf(Not(HasSubstr("differs")), Not(HasSubstr("recorded with"))));
  EXPECT_TRUE(FilesBelow(pipeline_.Folder()) == before);
}

TEST_F(ProvenanceTest, ReproduceSaysWhereArtefactsDiffer) {
  const fs::path initial = RunOf("initialise") / "initial.json";
  nlohmann::json document = ParseJsonFile(initial);
  document["observations"][0]["hypotheses"][0]["cost"] = 123.0;
  WriteBytes(initial, document.dump());
  nlohmann::json record = ParseJsonFile(RunOf("import") / "run.json");
  record["libraries"]["opencv"] = "1.0.0";
  WriteBytes(RunOf("import") / "run.json", record.dump());
  EXPECT_THAT(ExpectExit(1, Reproduce()).output,
              AllOf(ContainsRegex("differs +/[^\n]*initial.json: "
                                  "/observations/0/hypotheses/0/cost: 123 is "),
                    ContainsRegex("same +/[^\n]*refined.json\n"),
                    HasSubstr("recorded with opencv 1.0.0 is ")));
}

TEST_F(ProvenanceTest, WhatWasMadeFromOtherFilesIsNotRerun) {
  WriteBytes(pipeline_.Dataset() / "planes.json", "[]");
  EXPECT_THAT(ExpectExit(1, Reproduce()).output,
              AllOf(ContainsRegex("not rerun .*import-[0-9a-f]+: .*planes.json has changed since"),
                    ContainsRegex("not rerun .*edges-[0-9a-f]+: .*sequence.json, which it reads"),
                    Not(HasSubstr("same  "))));
}

// A record is a file like any other, and may come from anybody.
TEST_F(ProvenanceTest, NothingIsWrittenOutsideOfTheResults) {
  const fs::path letter = pipeline_.Folder() / "letter.json";
  WriteBytes(letter, "dear");
  const fs::path file = RunOf("import") / "run.json";
  const nlohmann::json record = ParseJsonFile(file);
  using Change = std::function<void(nlohmann::json*)>;
  const std::vector<std::pair<Change, std::string>> changes = {
      {[&](auto* changed) {
         (*changed)["outputs"][0].update({{"relative_to", "call"}, {"path", letter.string()}});
       },
       "it wrote .*letter.json, which is outside"},
      {[&](auto* changed) {
         (*changed)["inputs"].push_back({{"argument", "output"},
                                         {"relative_to", "call"},
                                         {"path", letter.string()},
                                         {"sha256", Sha256OfText("dear")}});
       },
       "--output is among its inputs"},
      {[&](auto* changed) { (*changed)["folders"]["output"] = letter.string(); },
       "--output is a folder"},
      {[](auto* changed) { (*changed)["stage"] = "soslam-synthesise"; },
       "soslam-synthesise is no stage"},
      {[](auto* changed) { (*changed)["outputs"].clear(); }, "its record has no outputs"},
      {[](auto* changed) { (*changed)["allow_outside_paths"] = true; },
       "it was called with --allow_outside_paths"}};
  for (const auto& [change, why] : changes) {
    nlohmann::json changed = record;
    change(&changed);
    WriteBytes(file, changed.dump());
    EXPECT_THAT(ExpectExit(1, Reproduce()).output,
                ContainsRegex("not rerun .*import-[0-9a-f]+: " + why));
    EXPECT_EQ(FileBytes(letter), "dear");
  }
}

TEST_F(ProvenanceTest, DatasetsAreWhereTheyWereUnlessTheCallerSaysOtherwise) {
  const TemporaryFolder programs;
  for (const std::string name : {"soslam-verify", "soslam-reproduce"}) {
    WriteBytes(programs / name, "#!/bin/sh\necho \"$@\"\n");
    fs::permissions(programs / name, fs::perms::owner_all);
  }
  const std::string build = fs::path(SOSLAM_BINARY_DIR).parent_path();
  for (const std::string command : {"verify", "reproduce"}) {
    const std::vector<std::string> words = {SOSLAM_SOURCE_DIR "/soslam",
                                            command,
                                            "--results",
                                            "some",
                                            "--build",
                                            build,
                                            "--bin",
                                            programs.path()};
    EXPECT_THAT(ExpectSuccess(RunCommand(words)),
                AllOf(HasSubstr("--results "), Not(HasSubstr("--data_root"))));
    const std::vector<std::string> settings = {
        command, "RESULTS=some",   "BUILD=" + build, "BIN=" + programs.path().string(),
        "-C",    SOSLAM_SOURCE_DIR};
    EXPECT_THAT(ExpectSuccess(RunCommand(MakeWords(settings))), Not(HasSubstr("--data_root")));
    std::vector<std::string> elsewhere = settings;
    elsewhere.emplace_back("DATA_ROOT=data");
    EXPECT_THAT(ExpectSuccess(RunCommand(MakeWords(elsewhere))), HasSubstr("--data_root data"));
  }
}

}  // namespace
}  // namespace soslam
