// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

TEST(VariantsTest, ResultsDoNotDependOnThreadsOrFolders) {
  const SmallPipeline one_thread(SmallPipeline::kFrames, 1);
  const SmallPipeline two_threads(SmallPipeline::kFrames, 2);
  for (const SmallPipeline* pipeline : {&one_thread, &two_threads}) {
    pipeline->WriteSettings({{"refine", {{"yaw_step_deg", 15}, {"yaw_grid_deg", 30}}},  // for speed
                             {"optimise", {{"max_iterations", 3}}}});
    ExpectSuccess(pipeline->Run("InitPT OursPT OursSTE"));  // all stages' methods
  }
  for (const char* place : {"data", "results"}) {
    const auto expected = SmallPipeline::Artefacts(one_thread.Folder() / place);
    const auto found = SmallPipeline::Artefacts(two_threads.Folder() / place);
    EXPECT_FALSE(expected.empty());
    EXPECT_THAT(Differing(found, expected), testing::IsEmpty());
  }
  const auto variant = one_thread.Results() / "OursSTE";
  EXPECT_EQ(ReadSymmetry(variant / "symmetry.h5").size(),
            ReadSequence(variant / "sequence.json").detections.size());
}

}  // namespace
}  // namespace soslam
