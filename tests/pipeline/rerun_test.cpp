// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <set>

#include "support/finished_run.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::ContainsRegex;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kRerunVariants = "InitP InitPT OursPT";

// The stages that a run names, sorted, from lines "[small] evaluate-34ae5c2b86 (InitP)".
std::multiset<std::string> StagesIn(const std::string& output) {
  const std::string mark = "[small] ";
  std::multiset<std::string> stages;
  for (size_t at = output.find(mark); at != std::string::npos; at = output.find(mark, at)) {
    at += mark.size();
    stages.insert(output.substr(at, output.find('-', at) - at));
  }
  return stages;
}

void Touch(const fs::path& path) {
  fs::last_write_time(path, fs::last_write_time(path) + std::chrono::seconds(1));
}

class RerunTest : public testing::Test {
 protected:
  static const FinishedRun& Finished() {
    static const FinishedRun run(kRerunVariants);
    return run;
  }
  std::multiset<std::string> RunStages() const {
    return StagesIn(ExpectSuccess(pipeline_.Run(kRerunVariants)));
  }
  std::map<std::string, std::string> Artefacts() const {
    return SmallPipeline::Artefacts(pipeline_.Results());
  }

  const SmallPipeline& pipeline_ = Finished().Restored();
};

TEST_F(RerunTest, EachStageRunsOnce) {
  EXPECT_THAT(StagesIn(Finished().Output()),
              ElementsAre("edges", "evaluate", "evaluate", "evaluate", "import", "initialise",
                          "optimise", "refine"));
  EXPECT_THAT(StagesIn(ExpectSuccess(pipeline_.Run(kRerunVariants, {"-n"}))), IsEmpty());
  const auto before = Artefacts();
  EXPECT_THAT(RunStages(), IsEmpty());
  EXPECT_TRUE(Artefacts() == before);
}

TEST_F(RerunTest, TouchedInputWithTheSameContentRerunsItsReadersOnly) {
  const auto before = Artefacts();
  Touch(pipeline_.Dataset() / "planes.json");
  EXPECT_THAT(RunStages(), ElementsAre("import"));
  Touch(pipeline_.Dataset() / "rgb/000002.png");
  EXPECT_THAT(RunStages(), ElementsAre("edges", "import"));
  EXPECT_THAT(RunStages(), IsEmpty());
  EXPECT_TRUE(Artefacts() == before);
}

TEST_F(RerunTest, ChangedSettingRerunsWhatDependsOnIt) {
  const std::string before = FileBytes(pipeline_.Results() / "InitPT/refined.json");
  nlohmann::json settings = SmallPipeline::TrueRatios();
  settings["refine"]["yaw_step_deg"] = 5.0;
  pipeline_.WriteSettings(settings);
  EXPECT_THAT(RunStages(), ElementsAre("evaluate", "evaluate", "optimise", "refine"));
  EXPECT_THAT(RunStages(), IsEmpty());
  EXPECT_NE(FileBytes(pipeline_.Results() / "InitPT/refined.json"), before);

  // Going back finds what was made with the earlier settings.
  pipeline_.WriteSettings(SmallPipeline::TrueRatios());
  EXPECT_THAT(RunStages(), IsEmpty());
  EXPECT_EQ(FileBytes(pipeline_.Results() / "InitPT/refined.json"), before);
}

// A command that notes how it was called and starts the rest, unless that is an `edges`.
class LaunchTest : public testing::Test {
 protected:
  LaunchTest() {
    WriteBytes(launcher_, "#!/bin/sh\necho \"$1, $2\" >> " + log_.string() +
                              "\ncase $2 in *-edges) exit 9;; esac\nshift\nexec \"$@\"\n");
    fs::permissions(launcher_, fs::perms::owner_all);
  }
  std::string FailureOf(const std::string& stage) const {
    for (const auto& entry : fs::directory_iterator(pipeline_.Results() / "shared")) {
      const bool is_stage = entry.path().filename().string().rfind(stage, 0) == 0;
      if (is_stage && fs::exists(entry.path() / "failed")) {
        return FileBytes(entry.path() / "failed");
      }
    }
    return "";
  }

  SmallPipeline pipeline_;
  fs::path launcher_ = pipeline_.Folder() / "launch";
  fs::path log_ = pipeline_.Folder() / "log";
};

TEST_F(LaunchTest, StartsEveryStageAndItsFailuresAreToldFromThoseOfStages) {
  const std::string launch = "LAUNCH=" + launcher_.string() + " \"two words, \"";
  const CommandResult first = pipeline_.Run(kRerunVariants, {launch, "--keep-going"});
  EXPECT_NE(first.exit_code, 0);
  for (const std::string stage : {"import", "edges", "initialise", "evaluate"}) {
    EXPECT_THAT(FileBytes(log_), HasSubstr("two words, , " + StageProgram(stage) + "\n"));
  }
  EXPECT_EQ(FailureOf("edges"), "exit code 9 of LAUNCH or of a stage that was killed\n");
  EXPECT_TRUE(fs::exists(pipeline_.Results() / "InitP/metrics.json"));

  ExpectSuccess(pipeline_.Run(kRerunVariants));
  const auto unlaunched = SmallPipeline::Artefacts(pipeline_.Results() / "InitP");
  WriteBytes(pipeline_.Dataset() / "objects.json", "[");
  EXPECT_NE(pipeline_.Run("InitP", {launch}).exit_code, 0);
  EXPECT_THAT(FailureOf("import"), HasSubstr("exit code 3: "));
  EXPECT_THAT(FailureOf("import"), HasSubstr("objects.json"));
  EXPECT_EQ(SmallPipeline::Artefacts(pipeline_.Results() / "InitP"), unlaunched);
}

// The project's Makefile, up to what would build the executables.
TEST(FrontDoorTest, DryRunAndStatusFollowTheRun) {
  const SmallPipeline pipeline;
  const fs::path results = pipeline.Folder() / "results";
  const auto make = [&](const std::vector<std::string>& arguments) {
    return ExpectSuccess(RunCommand(pipeline.WordsOfProject(arguments)));
  };

  EXPECT_THAT(StagesIn(make({"-n", "run", "VARIANT=InitP"})),
              ElementsAre("evaluate", "import", "initialise"));
  EXPECT_THAT(make({"status"}), ContainsRegex("InitP +missing +- +- +missing +- +- +missing"));
  EXPECT_FALSE(fs::exists(results / "small/InitP/metrics.json"));

  make({"-f", (results / "small/plan.mk").string(), "BIN=" SOSLAM_BINARY_DIR, "InitP"});
  EXPECT_TRUE(fs::exists(results / "small/InitP/metrics.json"));
  EXPECT_THAT(StagesIn(make({"-n", "run", "VARIANT=InitP"})), IsEmpty());
  EXPECT_THAT(make({"status"}), ContainsRegex("InitP +done +- +- +done +- +- +done"));
  EXPECT_THAT(make({"explain", "VARIANT=InitP", "STAGE=evaluate"}), HasSubstr("is done"));
}

// Corrections by hand are kept by later runs, and change what association and later stages make.
TEST(FrontDoorTest, EditsStayUntilOthersAreGiven) {
  const SmallPipeline pipeline;
  nlohmann::json settings = SmallPipeline::TrueRatios();
  settings["associate"] = {{"association", "estimated"}};
  pipeline.WriteSettings(settings);
  const fs::path edits = pipeline.Folder() / "my edits.json";
  const auto run = [&](const std::vector<std::string>& options) {
    std::vector<std::string> words = pipeline.WordsOfCommand("run-built", {"--variant", "InitP"});
    words.insert(words.end(), options.begin(), options.end());
    return RunCommand(words);
  };
  const auto sequence = [&] {
    return nlohmann::json::parse(FileBytes(pipeline.Results() / "InitP/sequence.json"));
  };
  const auto write = [&](const nlohmann::json& anchor) {
    const nlohmann::json edit = {{"edit", "delete"}, {"boxes", {anchor}}};
    WriteBytes(edits, nlohmann::json{{"edits", {edit}}}.dump());
  };
  EXPECT_THAT(StagesIn(ExpectSuccess(run({}))),
              ElementsAre("associate", "evaluate", "import", "initialise"));
  const nlohmann::json before = sequence();
  nlohmann::json anchor = {{"image", before["frames"][0]["image"]},
                           {"box", before["detections"][0]["box"]}};
  write(anchor);
  EXPECT_THAT(StagesIn(ExpectSuccess(run({"--edits", edits.string()}))),
              ElementsAre("associate", "evaluate", "initialise"));
  EXPECT_EQ(sequence()["objects"].size(), before["objects"].size() - 1);
  EXPECT_EQ(sequence()["edits"]["kinds"], (nlohmann::json{{"delete", 1}}));
  const nlohmann::json edited = sequence();
  EXPECT_THAT(StagesIn(ExpectSuccess(run({}))), IsEmpty());
  EXPECT_EQ(sequence(), edited);

  // A box that the detector no longer gives.
  anchor["box"] = {1, 1, 9, 9};
  write(anchor);
  const CommandResult stale = run({"--edits", edits.string()});
  EXPECT_NE(stale.exit_code, 0);
  EXPECT_THAT(stale.errors, HasSubstr("/edits/0/boxes/0/box is [1.0, 1.0, 9.0, 9.0]"));
  EXPECT_THAT(stale.errors, HasSubstr("Error 3"));
  EXPECT_EQ(sequence(), edited);

  WriteBytes(edits, R"({"edits": []})");
  EXPECT_THAT(StagesIn(ExpectSuccess(run({"--edits", edits.string()}))),
              ElementsAre("associate", "evaluate", "initialise"));
  EXPECT_EQ(sequence()["objects"], before["objects"]);

  // Ids of the dataset leave nothing to correct.
  pipeline.WriteSettings(SmallPipeline::TrueRatios());
  const CommandResult refused = run({"--edits", edits.string()});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("my edits.json: corrects which boxes"));
}

TEST(FrontDoorTest, DryRunsNeedNeitherProgramsNorData) {
  const SmallPipeline pipeline;
  EXPECT_THAT(ExpectSuccess(RunCommand(pipeline.WordsOfProject(
                  {"-n", "run-built", "BIN=" + pipeline.Folder().string()}))),
              HasSubstr("then the stages that"));
  EXPECT_FALSE(fs::exists(pipeline.Folder() / "results"));
}

TEST(FrontDoorTest, SeveralVariantsRunSideBySideUnlessToldOtherwise) {
  const SmallPipeline pipeline;
  const auto are_side_by_side = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> words = pipeline.WordsOfProject(arguments);
    std::erase(words, "-j2");
    return ExpectSuccess(RunCommand(words)).find("side by side") != std::string::npos;
  };
  EXPECT_TRUE(are_side_by_side({"-n", "run", "VARIANT=InitP OursS"}));
  EXPECT_TRUE(are_side_by_side({"-n", "run", "VARIANT=all"}));
  EXPECT_FALSE(are_side_by_side({"-n", "run", "VARIANT=InitP"}));
  EXPECT_FALSE(are_side_by_side({"-n", "-j1", "run", "VARIANT=all"}));
  EXPECT_FALSE(are_side_by_side({"-n", "run", "VARIANT=all", "LAUNCH=srun"}));
}

}  // namespace
}  // namespace soslam
