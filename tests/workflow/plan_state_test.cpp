// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/workflow/plan_state.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <set>

#include "soslam/base/error.h"
#include "soslam/workflow/pipeline_settings.h"
#include "soslam/workflow/pipeline_stages.h"
#include "soslam/workflow/plan.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/lists.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

// A finished run of import, initialise and evaluate whose files the test writes itself, all older
// than the stamps.
class PlanStateTest : public FolderTest {
 protected:
  PlanStateTest() {
    Write("pipelines/base.json", R"({"stages": ["import", "initialise", "evaluate"]})");
    Write("pipelines/variants/Plain.json", "{}");
    Write("pipelines/priors/semantic_table.json", "{}");
    Write("data/poses.txt", "");
    Write("results/shared/dataset.txt",
          (folder_ / "data").string() + "\nposes.txt 0 1\nrgb/1.png\n");
    Write("results/shared/images.txt", (folder_ / "data").string() + "\n");
    plan_ = MakePlan(folders_.pipelines, "room", {"Plain"});
    for (const StageInstance& instance : plan_.instances) {
      Write("bin/soslam-" + instance.stage, "");
      Write(ResultOf(instance.stage, "settings.json"), instance.settings.dump());
      for (const StageOutput& output : OutputsOfStage(instance.stage)) {
        Write(ResultOf(instance.stage, output.file), "");
      }
    }
    ++minute_;
    for (const StageInstance& instance : plan_.instances) {
      Write(ResultOf(instance.stage, "done"), "");
    }
    ++minute_;
  }

  // Writes a file with the time of the current minute.
  void Write(const std::string& name, const std::string& text) {
    fs::last_write_time(FolderTest::Write(name, text), start_ + std::chrono::minutes(minute_));
  }
  const StageInstance& InstanceOf(const std::string& stage) const {
    return *std::ranges::find(plan_.instances, stage, &StageInstance::stage);
  }
  std::string ResultOf(const std::string& stage, const std::string& file) const {
    return "results/" + InstancePath(InstanceOf(stage).Id(), file);
  }
  std::vector<std::string> Reasons(const std::string& stage) const {
    return DetermineStates(plan_, folders_).at(InstanceOf(stage).Id()).reasons;
  }
  // States of import, initialise and evaluate.
  std::vector<std::string> States() const {
    const auto states = DetermineStates(plan_, folders_);
    const std::vector<std::string> stages = {"import", "initialise", "evaluate"};
    return Fields(stages, [&](const std::string& stage) {
      return std::string(NameOf(states.at(InstanceOf(stage).Id()).state));
    });
  }

  PlanFolders folders_ = {folder_ / "data", folder_ / "pipelines", folder_ / "results",
                          folder_ / "bin"};
  fs::file_time_type start_ = fs::file_time_type::clock::now() - std::chrono::hours(1);
  int minute_ = 0;
  Plan plan_;
};

TEST_F(PlanStateTest, RunAgainWithTheSameResultConcernsNobodyElse) {
  Write(ResultOf("import", "done"), "");
  EXPECT_THAT(States(), ElementsAre("done", "done", "done"));
}

TEST_F(PlanStateTest, NewerProgramArtefactAndTable) {
  Write("bin/soslam-evaluate", "");
  EXPECT_THAT(States(), ElementsAre("done", "done", "stale"));
  EXPECT_THAT(Reasons("evaluate"), ElementsAre(EndsWith("bin/soslam-evaluate has changed since")));
  Write(ResultOf("import", "sequence.json"), "");
  Write("pipelines/priors/semantic_table.json", "{}");
  EXPECT_THAT(States(), ElementsAre("done", "stale", "stale"));
  EXPECT_THAT(Reasons("initialise"),
              ElementsAre(EndsWith("sequence.json has changed since"),
                          EndsWith("semantic_table.json has changed since")));
}

TEST_F(PlanStateTest, ChangedFilesOfTheDatasetAreNamed) {
  Write("data/poses.txt", "1");
  Write("results/shared/dataset.txt", "/data\nposes.txt 1 2\nrgb/1.png\n");
  EXPECT_THAT(Reasons("import"), ElementsAre(EndsWith("have changed since: poses.txt")));
  std::string listing = "/data\n";
  for (const char name : std::string("abcdefg")) {
    Write(std::string("data/my file ") + name, "");
    listing += std::string("my file ") + name + " 0 3\n";
  }
  Write("results/shared/dataset.txt", listing);
  EXPECT_THAT(Reasons("import"),
              ElementsAre(EndsWith(": my file a, my file b, my file c, my file d, "
                                   "my file e and 2 more")));
  Write("results/shared/dataset.txt", "/data\n");
  EXPECT_THAT(Reasons("import"), ElementsAre(HasSubstr("came, went or were replaced")));
}

TEST_F(PlanStateTest, WhatIsGoneOrNeverRan) {
  fs::remove(folder_ / ResultOf("initialise", "initial.json"));
  EXPECT_THAT(States(), ElementsAre("done", "stale", "stale"));
  EXPECT_THAT(Reasons("initialise"), ElementsAre("initial.json, which it writes, is gone"));
  fs::remove(folder_ / ResultOf("evaluate", "done"));
  EXPECT_THAT(States(), ElementsAre("done", "stale", "missing"));
}

TEST_F(PlanStateTest, FailureIsSaidFirst) {
  Write("bin/soslam-import", "");
  Write(ResultOf("import", "failed"), "exit code 3: poses.txt: is empty\n");
  EXPECT_THAT(States(), ElementsAre("failed", "stale", "stale"));
  EXPECT_THAT(Reasons("import"),
              ElementsAre("its last run failed: exit code 3: poses.txt: is empty",
                          HasSubstr("soslam-import")));
}

TEST_F(PlanStateTest, WhatIsQueuedOrRunsSaysSoUnlessItIsDone) {
  Write("bin/soslam-initialise", "");
  Write(ResultOf("evaluate", "failed"), "exit code 4: nothing\n");
  const std::string import = "room " + InstanceOf("import").Id();
  const std::string initialise = "room " + InstanceOf("initialise").Id();
  const std::string evaluate = "room " + InstanceOf("evaluate").Id();
  const std::string other = "desk " + InstanceOf("evaluate").Id();
  Write("under_way", import + " queued\n" + initialise + " running\n" + initialise + " queued\n" +
                         evaluate + " queued\n" + other + " running\n");
  auto under_way = ReadStagesUnderWay(folder_ / "under_way");
  const auto states = DetermineStates(plan_, folders_, under_way["room"]);
  const auto state = [&](const std::string& stage) {
    return std::string(NameOf(states.at(InstanceOf(stage).Id()).state));
  };
  EXPECT_EQ(state("import"), "done");
  EXPECT_EQ(state("initialise"), "running");
  EXPECT_EQ(state("evaluate"), "queued");
}

TEST_F(PlanStateTest, StagesUnderWayAreRefusedUnlessTheyAreQueuedOrRunning) {
  for (const char* line : {"room import-0123456789 done", "room queued", "a b queued c", ""}) {
    Write("under_way", std::string(line) + "\n");
    ExpectError<InputError>([&] { ReadStagesUnderWay(folder_ / "under_way"); },
                            {"under_way", line, "expected"});
  }
}

TEST_F(PlanStateTest, ChangesSinceTheLastCompleteRun) {
  const VariantChain& variant = plan_.variants.front();
  EXPECT_THAT(ChangesSinceLastRun(plan_, variant, InstanceOf("initialise"), folders_), IsEmpty());
  nlohmann::json earlier = InstanceOf("initialise").settings;
  earlier["yaw_starts"] = 3;
  earlier.erase("method");
  Write("results/shared/initialise-0000000000/settings.json", earlier.dump());
  Write("results/Plain/.linked", InstanceOf("import").Id() + "\ninitialise-0000000000\n");
  EXPECT_THAT(ChangesSinceLastRun(plan_, variant, InstanceOf("initialise"), folders_),
              ElementsAre("method: absent -> \"single_frame\"", "yaw_starts: 3 -> 12"));
  EXPECT_THAT(ChangesSinceLastRun(plan_, variant, InstanceOf("import"), folders_), IsEmpty());
}

using testing::UnorderedElementsAre;

constexpr const char* kPipelines = SOSLAM_SOURCE_DIR "/pipelines";

std::vector<std::string> StagesOf(const Plan& plan, const std::vector<std::string>& ids) {
  return Fields(ids, [&](const std::string& id) { return plan.Instance(id).stage; });
}

TEST(WorkUnitsTest, BranchesBeginWhereStagesTakeLong) {
  const Plan plan = MakePlan(kPipelines, "room", {"InitP", "InitPT", "OursP", "OursPT"});
  const std::vector<WorkUnit> units = SplitPlan(plan);
  ASSERT_EQ(units.size(), 3u);
  EXPECT_EQ(units[0].name, kTrunk);
  EXPECT_THAT(StagesOf(plan, units[0].instances),
              ElementsAre("import", "initialise", "evaluate", "edges"));
  EXPECT_THAT(units[0].variants, ElementsAre("InitP"));
  EXPECT_THAT(units[0].needs, IsEmpty());

  // InitPT and OursPT refine the same.
  EXPECT_EQ(units[1].name, units[1].instances[0]);
  EXPECT_THAT(StagesOf(plan, units[1].instances),
              ElementsAre("refine", "evaluate", "optimise", "evaluate"));
  EXPECT_THAT(units[1].variants, ElementsAre("InitPT", "OursPT"));
  EXPECT_THAT(StagesOf(plan, units[1].needs),
              UnorderedElementsAre("import", "edges", "initialise"));

  EXPECT_THAT(StagesOf(plan, units[2].instances), ElementsAre("optimise", "evaluate"));
  EXPECT_THAT(units[2].variants, ElementsAre("OursP"));
  EXPECT_THAT(StagesOf(plan, units[2].needs), UnorderedElementsAre("import", "initialise"));
}

// So that jobs need no other order than the trunk first, and never write the same file.
TEST(WorkUnitsTest, BranchesReadOnlyTheTrunkAndThemselves) {
  for (const char* pipelines : {"", "/ablation", "/unannotated", "/kitti", "/raw_boxes"}) {
    const std::string folder = std::string(kPipelines) + pipelines;
    const Plan plan = MakePlan(folder, "room", VariantNames(folder));
    std::set<std::string> all;
    const std::vector<WorkUnit> units = SplitPlan(plan);
    for (const WorkUnit& unit : units) {
      std::set<std::string> known(unit.needs.begin(), unit.needs.end());
      for (const std::string& id : unit.needs) {
        EXPECT_THAT(units[0].instances, testing::Contains(id)) << unit.name;
      }
      for (const std::string& id : unit.instances) {
        EXPECT_TRUE(all.insert(id).second) << id << " is in two units";
        for (const auto& [argument, source] : plan.Instance(id).inputs) {
          EXPECT_TRUE(known.contains(source.instance)) << unit.name << ": " << id;
        }
        known.insert(id);
      }
    }
    EXPECT_EQ(all.size(), plan.instances.size()) << folder;
  }
}

}  // namespace
}  // namespace soslam
