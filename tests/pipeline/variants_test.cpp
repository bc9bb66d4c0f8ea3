// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/small_pipeline.h"

namespace soslam {
namespace {

using nlohmann::json;
using testing::HasSubstr;

constexpr int kFrames = 10;
constexpr int kObjects = 3;

// Pixels and the edges found in them are what keeps texture symmetry from being exact.
constexpr double kMinIou = 0.99;

json Metrics(const SmallPipeline& pipeline, const std::string& variant) {
  const json metrics = json::parse(FileBytes(pipeline.Results() / variant / "metrics.json"));
  EXPECT_EQ(metrics["summary"]["objects"], kObjects) << variant;
  EXPECT_EQ(metrics["summary"]["observations"], kObjects * kFrames) << variant;
  return metrics;
}

TEST(VariantsTest, NoiseFreeEllipsoidsWithTheirTrueRatiosAreRecovered) {
  const SmallPipeline pipeline(kFrames);
  const CommandResult run = pipeline.Run("");
  ASSERT_EQ(run.exit_code, 0) << run.errors;

  for (const std::string variant : {"InitP", "InitPT"}) {
    const json metrics = Metrics(pipeline, variant);
    EXPECT_GE(metrics["summary"]["iou_mean"], kMinIou) << variant;
    EXPECT_GE(metrics["first_observation"]["iou_mean"], kMinIou) << variant;
  }
  for (const std::string variant : {"OursP", "OursPT"}) {
    const json metrics = Metrics(pipeline, variant);
    EXPECT_GE(metrics["summary"]["iou_mean"], kMinIou) << variant;
    EXPECT_LT(metrics["trajectory"]["ate_rmse_m"], 1e-3) << variant;
  }
  // Without planes and ratios, or with one ratio for all, the method itself sets the limit.
  for (const std::string variant : {"SVD", "Quadric", "Init1-1"}) {
    EXPECT_GT(Metrics(pipeline, variant)["summary"]["iou_mean"], 0.0) << variant;
  }
  EXPECT_LT(Metrics(pipeline, "Init1-1")["summary"]["iou_mean"], 0.9);

  const CommandResult report =
      RunCommand({StageProgram("report"), "--results", (pipeline.Folder() / "results").string(),
                  "--output", (pipeline.Folder() / "tables.md").string()});
  EXPECT_EQ(report.exit_code, 0) << report.errors;
  for (const std::string variant :
       {"SVD", "Init1-1", "InitP", "InitPT", "Quadric", "OursP", "OursPT"}) {
    EXPECT_THAT(report.output, HasSubstr("\n| " + variant + " "));
  }
}

TEST(VariantsTest, ResultsDoNotDependOnThreadsOrFolders) {
  const SmallPipeline one_thread(kFrames, 1);
  const SmallPipeline two_threads(kFrames, 2);
  for (const SmallPipeline* pipeline : {&one_thread, &two_threads}) {
    const CommandResult run = pipeline->Run("");
    ASSERT_EQ(run.exit_code, 0) << run.errors;
  }
  for (const char* place : {"data", "results"}) {
    const auto expected = SmallPipeline::Artefacts(one_thread.Folder() / place);
    const auto found = SmallPipeline::Artefacts(two_threads.Folder() / place);
    ASSERT_FALSE(expected.empty());
    ASSERT_EQ(found.size(), expected.size());
    for (const auto& [name, bytes] : expected) {
      ASSERT_EQ(found.count(name), 1) << name;
      EXPECT_TRUE(found.at(name) == bytes) << name << " differs";
    }
  }
}

}  // namespace
}  // namespace soslam
