// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "report/results_tree.h"
#include "support/results_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

class VariantStateTest : public testing::Test {
 protected:
  VariantStateTest() {
    results_.WriteStages("room", "InitPT", {"import-12", "refine-34"});
    WriteBytes(Shared("import-12") / "done", "");
  }
  fs::path Shared(const std::string& run) const {
    return results_.VariantFolder("room", "shared/" + run);
  }
  fs::path Folder() const { return results_.VariantFolder("room", "InitPT"); }
  VariantResult Read() const { return ReadResults(results_.path()).front().variants.front(); }

  ResultsFolder results_;
};

TEST_F(VariantStateTest, NothingIsUnfinishedOfACompleteVariant) {
  WriteBytes(Shared("refine-34") / "done", "");
  EXPECT_EQ(WhyUnfinished(Read()), "");
  WriteBytes(Folder() / ".linked", "import-12\nrefine-34\n");
  EXPECT_EQ(WhyUnfinished(Read()), "");
}

TEST_F(VariantStateTest, TheFirstStageThatHasNotRun) {
  EXPECT_EQ(WhyUnfinished(Read()), "incomplete: refine has not run");
}

TEST_F(VariantStateTest, TheStageThatFailedAndWhy) {
  WriteBytes(Shared("refine-34") / "done", "");
  WriteBytes(Shared("refine-34") / "failed", "exit code 3: edges.h5: is damaged\n");
  EXPECT_EQ(WhyUnfinished(Read()), "failed: refine: exit code 3: edges.h5: is damaged");
}

TEST_F(VariantStateTest, FilesOfAnEarlierPlan) {
  WriteBytes(Shared("refine-34") / "done", "");
  WriteBytes(Folder() / ".linked", "import-12\nrefine-56\n");
  EXPECT_EQ(WhyUnfinished(Read()), "incomplete: its files are those of an earlier plan");
}

TEST_F(VariantStateTest, StagesAreThoseOfTheLinks) {
  WriteBytes(Folder() / ".linked", "import-12\nlearn-priors-9\n");
  EXPECT_FALSE(ShowsStage(Read(), "refine", "refined.json"));
  EXPECT_TRUE(ShowsStage(Read(), "learn-priors", "table.json"));
  EXPECT_FALSE(ShowsStage(Read(), "learn", "table.json"));
  fs::remove(Folder() / ".linked");
  EXPECT_TRUE(ShowsStage(Read(), "refine", "refined.json"));
}

TEST_F(VariantStateTest, StagesAreToldByFilesWithoutAList) {
  results_.WriteMetrics("desk", "InitPT", {{.id = 1, .iou = 0.5}});
  const VariantResult variant = ReadResults(results_.path()).front().variants.front();
  EXPECT_EQ(WhyUnfinished(variant), "");
  EXPECT_FALSE(ShowsStage(variant, "refine", "refined.json"));
  WriteBytes(results_.VariantFolder("desk", "InitPT") / "refined.json", "{}");
  EXPECT_TRUE(ShowsStage(variant, "refine", "refined.json"));
}

}  // namespace
}  // namespace soslam
