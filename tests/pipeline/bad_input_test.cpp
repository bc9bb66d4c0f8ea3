// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "artefact/hdf5_file.h"
#include "support/refused_input.h"
#include "support/small_pipeline.h"
#include "support/stage_chain.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;

// A semantic table that knows these labels only and has no default.
Spoil TableOf(const std::vector<std::string>& labels) {
  return [=](const StageChain& chain) {
    json table = {{"labels", json::object()}};
    for (const std::string& label : labels) {
      table["labels"][label] = {{"a_by_c", 1.0}, {"b_by_c", 0.5}, {"source", "the test"}};
    }
    WriteBytes(chain.pipeline().SemanticTable(), table.dump());
  };
}

// Puts object 2 on a plane above the camera: rays through the lower edges of its boxes meet that
// plane behind the camera.
void PutObject2OnACeiling(const StageChain& chain) {
  json planes = json::parse(FileBytes(chain.Dataset("planes.json")));
  planes.push_back({{"id", 1}, {"label", "ceiling"}, {"normal", {0, 0, 1}}, {"d", -5}});
  WriteBytes(chain.Dataset("planes.json"), planes.dump());
  json objects = json::parse(FileBytes(chain.Dataset("objects.json")));
  objects[1]["support_plane"] = 1;
  WriteBytes(chain.Dataset("objects.json"), objects.dump());
}

class RefusedInputTest : public testing::TestWithParam<RefusedInput> {};

TEST_P(RefusedInputTest, EndsWithItsExitCodeAndOneLineThatNamesIt) { ExpectRefused(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Dataset, RefusedInputTest,
    testing::Values(Refused("ImageTruncated", "edges", ToDataset("rgb/000002.png", Truncate),
                            {"rgb/000002.png"}),
                    Refused("DetectionsMalformed", "import",
                            Line("detections.csv", 3, "0,2,stool,1.0,wide,100,200,200"),
                            {"detections.csv:3", "x1", "'wide'"}),
                    Refused("NoDetectionLeft", "import",
                            Content("detections.csv", "frame,object_id,label,score,x1,y1,x2,y2\n"),
                            {"no usable detection"}, 4)),
    CaseName<RefusedInput>);

INSTANTIATE_TEST_SUITE_P(
    Artefact, RefusedInputTest,
    testing::Values(Refused("EdgesTruncated", "refine", ToArtefact("edges.h5", Truncate),
                            {"edges.h5"}),
                    Refused("SequenceNewer", "initialise",
                            ArtefactText("sequence.json", "\"schema_version\": [\n   1,",
                                         "\"schema_version\": [\n   2,"),
                            {"sequence.json", "schema version [2, 7]", "[1, 7]"}),
                    Refused("ArtefactOfAnotherKind", "optimise",
                            [](const StageChain& chain) {
                              fs::copy_file(chain.Artefact("sequence.json"),
                                            chain.Artefact("refined.json"),
                                            fs::copy_options::overwrite_existing);
                            },
                            {"refined.json", "kind", "landmarks"})),
    CaseName<RefusedInput>);

struct GatedInput {
  std::string name;
  std::string stage;
  Spoil spoil;          // of the dataset, before any stage
  std::string counter;  // JSON pointer into what the stage writes
  int count;
};

void PrintTo(const GatedInput& input, std::ostream* stream) { *stream << input.name; }

class GatedInputTest : public testing::TestWithParam<GatedInput> {};

TEST_P(GatedInputTest, IsCountedWithItsReason) {
  const GatedInput& bad = GetParam();
  const StageChain& chain = StageChain::Finished();
  ASSERT_NO_FATAL_FAILURE(bad.spoil(chain));
  ASSERT_NO_FATAL_FAILURE(chain.RunUpTo(bad.stage));
  const CommandResult result = chain.Run(bad.stage);
  ASSERT_EQ(result.exit_code, 0) << result.errors;
  EXPECT_LE(std::ranges::count(result.errors, '\n'), 1) << result.errors;
  const json artefact = json::parse(FileBytes(chain.Artefact(StageChain::OutputOf(bad.stage))));
  EXPECT_EQ(artefact.value(json::json_pointer(bad.counter), 0), bad.count);
}

INSTANTIATE_TEST_SUITE_P(
    Dataset, GatedInputTest,
    testing::Values(GatedInput{"LabelNotInTheTable", "initialise", TableOf({"chest", "armchair"}),
                               "/failures/no_ratio_for_label", SmallPipeline::kFrames},
                    GatedInput{"PlaneBehindTheCamera", "initialise", PutObject2OnACeiling,
                               "/failures/support_plane_not_in_view", SmallPipeline::kFrames}),
    CaseName<GatedInput>);

TEST(UnusableInputTest, NoLabelInTheTable) {
  const StageChain& chain = StageChain::Finished();
  TableOf({"sofa"})(chain);
  const CommandResult result = chain.Run("initialise");
  EXPECT_EQ(result.exit_code, 4);
  EXPECT_THAT(result.errors, HasSubstr("no_ratio_for_label 12"));
}

TEST(UnknownSettingTest, IsRefusedByEveryStage) {
  const StageChain& chain = StageChain::Finished();
  WriteBytes(chain.Artefact("settings.json"), R"({"colour": "red"})");
  for (const std::string& stage : StageChain::kStages) {
    const CommandResult refused = chain.Run(stage);
    EXPECT_EQ(refused.exit_code, 2) << stage;
    EXPECT_THAT(refused.errors, HasSubstr("settings.json"));
    EXPECT_THAT(refused.errors, HasSubstr("colour"));
    EXPECT_EQ(std::ranges::count(refused.errors, '\n'), 1) << refused.errors;
  }
}

}  // namespace
}  // namespace soslam
