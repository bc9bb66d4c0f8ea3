// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/report/results_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/expect_error.h"
#include "support/results_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;

std::vector<std::string> VariantNames(const DatasetResult& dataset) {
  std::vector<std::string> names;
  for (const VariantResult& variant : dataset.variants) names.push_back(variant.name);
  return names;
}

TEST(ReadResults, DatasetsByNameAndVariantsInTheirOrder) {
  const ResultsFolder results;
  for (const char* variant : {"zeta", "OursSTE", "alpha", "MultiView", "OursPT", "SVD"}) {
    results.WriteMetrics("room", variant, {{.id = 1, .iou = 0.5}});
  }
  results.WriteStages("desk", "SVD", {"import-12"});
  results.VariantFolder("room", "shared");
  results.VariantFolder("tables", "nothing");
  const std::vector<DatasetResult> datasets = ReadResults(results.path());
  ASSERT_EQ(datasets.size(), 2u);
  EXPECT_EQ(datasets[0].name, "desk");
  EXPECT_EQ(datasets[1].name, "room");
  EXPECT_THAT(VariantNames(datasets[1]),
              ElementsAre("SVD", "OursPT", "MultiView", "OursSTE", "alpha", "zeta"));
}

// Without their sequence, metrics have the ids and labels of their objects.
TEST(ReadResults, MetricsNameTheirObjects) {
  const ResultsFolder results;
  results.WriteMetrics("room", "OursS", {{.id = 7, .iou = 0.5}, {.id = 9, .observations = 0}});
  const DatasetResult room = ReadResults(results.path()).front();
  const Metrics& metrics = *room.variants.front().metrics;
  EXPECT_EQ(metrics.dataset, "room");
  EXPECT_EQ(metrics.objects.front().object_index, 7);
  EXPECT_EQ(metrics.objects.front().label, "box");
  // An object that was not observed has no error.
  EXPECT_THAT(ObjectValues(room.variants.front(), kIou), ElementsAre(testing::Pair(7, 0.5)));
}

TEST(KnownVariants, AreThoseOfThePipelines) {
  for (const auto& file : fs::directory_iterator(SOSLAM_SOURCE_DIR "/pipelines/variants")) {
    EXPECT_THAT(kKnownVariants, testing::Contains(file.path().stem().string()));
  }
}

TEST(ReadResults, TimingsFromBeforeMachinesWereRecorded) {
  const ResultsFolder results;
  results.WriteStages("room", "InitP", {"import-12"});
  WriteBytes(results.VariantFolder("room", "shared/import-12") / "timing.json",
             R"({"stage": "soslam-import", "wall_s": 1, "cpu_s": 1, "peak_memory_mb": 1,
                 "threads": 1})");
  const DatasetResult room = ReadResults(results.path()).front();
  ASSERT_TRUE(room.variants.front().stages.front().timing);
  EXPECT_FALSE(room.variants.front().stages.front().timing->machine);
}

TEST(ReadResults, RefusesBrokenFilesByName) {
  const ResultsFolder results;
  results.WriteStages("room", "InitP", {"import-12"});
  const fs::path timing = results.VariantFolder("room", "shared/import-12") / "timing.json";
  WriteBytes(timing, R"({"wall_s": "long"})");
  ExpectError<InputError>([&] { ReadResults(results.path()); }, {"import-12/timing.json"});
  fs::remove(timing);
  WriteBytes(results.VariantFolder("room", "InitP") / "metrics.json", "{");
  ExpectError<InputError>([&] { ReadResults(results.path()); }, {"room/InitP/metrics.json"});
}

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

TEST_F(VariantStateTest, SaysWhyTheFolderDoesNotShowThePlan) {
  EXPECT_EQ(WhyUnfinished(Read()), "incomplete: refine has not run");
  WriteBytes(Shared("refine-34") / "done", "");
  EXPECT_EQ(WhyUnfinished(Read()), "");
  WriteBytes(Folder() / ".linked", "import-12\nrefine-34\n");
  EXPECT_EQ(WhyUnfinished(Read()), "");
  WriteBytes(Folder() / ".linked", "import-12\nrefine-56\n");
  EXPECT_EQ(WhyUnfinished(Read()), "incomplete: its files are those of an earlier plan");
  WriteBytes(Shared("refine-34") / "failed", "exit code 3: edges.h5: is damaged\n");
  EXPECT_EQ(WhyUnfinished(Read()), "failed: refine: exit code 3: edges.h5: is damaged");
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
