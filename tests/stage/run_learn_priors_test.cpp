// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/priors/learn_priors.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/lists.h"
#include "support/printed.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using testing::HasSubstr;

class RunLearnPriorsTest : public FolderTest {
 protected:
  RunLearnPriorsTest() {
    WriteBytes(folder_ / "models.csv",
               "name,category,depth_m,width_m,height_m\nPot,Hall,0.2,0.2,0.1\n"
               "Pot,Hall,0.4,0.4,0.1\n");
    Write("names.json", R"({"labels": {"pot": ["pot"]}})");
    files_["output"] = folder_ / "table.json";
  }
  // A sequence whose only object is a pot.
  std::filesystem::path WritePot(const std::string& name, const Eigen::Vector3d& half_axes) const {
    Sequence sequence;
    sequence.name = name;
    sequence.camera = {640, 480, 500.0, 500.0, 320.0, 240.0};
    sequence.frames.resize(1);
    sequence.frames[0].image = "0.png";
    sequence.planes = {{0, {Eigen::Vector3d::UnitZ(), 0.0}}};
    GroundTruth truth;
    truth.landmark_in_world.half_axes = half_axes;
    sequence.objects = {{0, "pot", 0, truth}};
    WriteSequence(folder_ / (name + ".json"), sequence, {});
    return folder_ / (name + ".json");
  }
  void UseFurniture() {
    files_["furniture"] = folder_ / "models.csv";
    files_["furniture_labels"] = folder_ / "names.json";
  }
  std::string Run() const {
    return PrintedBy([&] { RunLearnPriors({}, files_, 1); }).output;
  }
  ShapePrior Pot() const { return ReadSemanticTable(files_.at("output")).Find("pot").value(); }

  StageFiles files_;
};

TEST_F(RunLearnPriorsTest, LearnsFromCatalogueAndSequences) {
  UseFurniture();
  files_["sequence"] = WritePot("one", {0.3, 0.3, 0.1});
  files_[RepeatedName("sequence", 1)] = WritePot("two", {0.3, 0.3, 0.1});
  EXPECT_THAT(Run(), HasSubstr("1 labels"));
  const SemanticRow row = Only(ReadSemanticRows(files_.at("output")).rows);
  EXPECT_EQ(row.samples, 4);
  EXPECT_NEAR(Pot().ratio.x(), 3.0, 1e-3);  // of 2, 4, 3, 3
  for (const char* source : {"2 of models.csv", "1 of one", "1 of two"}) {
    EXPECT_THAT(row.source, HasSubstr(source));
  }
}

TEST_F(RunLearnPriorsTest, WhatIsHeldOutIsPredictedAndNotLearned) {
  UseFurniture();
  files_["held_out"] = WritePot("answer", {0.2, 0.2, 0.05});  // the second model
  const std::string printed = Run();
  EXPECT_THAT(printed, HasSubstr("2 models, 1 left out"));
  EXPECT_THAT(printed, HasSubstr("answer: pot: log error 0.69 0.69"));  // log(4 / 2)
  EXPECT_NEAR(Pot().ratio.x(), 2.0, 1e-3);
}

TEST_F(RunLearnPriorsTest, TheTableItWritesIsABaseThatStaysAsItIs) {
  UseFurniture();
  Run();
  const std::string first = FileBytes(files_.at("output"));
  files_["base"] = folder_ / "base.json";
  std::filesystem::rename(files_.at("output"), files_.at("base"));
  files_.erase("furniture");
  files_.erase("furniture_labels");
  RunLearnPriors({.base_rows = BaseRows::kKeep}, files_, 1);
  const auto labels = [](const std::string& text) {
    return nlohmann::json::parse(text).at("labels");
  };
  EXPECT_EQ(labels(FileBytes(files_.at("output"))), labels(first));
}

TEST_F(RunLearnPriorsTest, WhatCannotBeIsRefused) {
  ExpectError<NothingUsableError>([&] { RunLearnPriors({}, files_, 1); }, {"no label"});
  files_["furniture"] = folder_ / "models.csv";
  ExpectError<SettingsError>([&] { RunLearnPriors({}, files_, 1); }, {"--furniture_labels"});
  UseFurniture();
  files_["sequence"] = files_["held_out"] = WritePot("one", {0.3, 0.3, 0.1});
  ExpectError<SettingsError>([&] { RunLearnPriors({}, files_, 1); }, {"one", "--held_out"});
  files_["held_out"] = folder_ / "models.csv";
  ExpectError<InputError>([&] { RunLearnPriors({}, files_, 1); }, {"models.csv"});
  EXPECT_FALSE(std::filesystem::exists(files_.at("output")));
}

}  // namespace
}  // namespace soslam
