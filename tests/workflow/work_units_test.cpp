// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "workflow/pipeline_settings.h"
#include "workflow/plan.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

constexpr const char* kPipelines = SOSLAM_SOURCE_DIR "/pipelines";

std::vector<std::string> StagesOf(const Plan& plan, const std::vector<std::string>& ids) {
  std::vector<std::string> stages;
  for (const std::string& id : ids) stages.push_back(plan.Instance(id).stage);
  return stages;
}

TEST(WorkUnitsTest, BranchesBeginWhereStagesTakeLong) {
  const Plan plan = MakePlan(kPipelines, "room", {"InitP", "InitPT", "OursP", "OursPT"});
  const std::vector<WorkUnit> units = WorkUnitsOf(plan);
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
    const std::vector<WorkUnit> units = WorkUnitsOf(plan);
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
