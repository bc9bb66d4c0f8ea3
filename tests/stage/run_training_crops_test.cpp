// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "soslam/appearance/inner_layers.h"
#include "soslam/artefact/hdf5_file.h"
#include "soslam/base/error.h"
#include "soslam/geometry/angles.h"
#include "soslam/stage/stages.h"
#include "soslam/system/hash.h"
#include "soslam/training/furniture_model.h"
#include "soslam/training/training_crops.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/onnx_network.h"
#include "support/printed.h"

namespace soslam {
namespace {

constexpr int kCrops = 24;
constexpr int kModels = 3;  // two desks, the box

// A library of one box of a single colour, and desks; a network of means over 8 x 8 pixels.
class RunTrainingCropsTest : public FolderTest {
 protected:
  RunTrainingCropsTest() {
    Write("furniture/library/PluginFurnitureCatalog.properties",
          "name#1=Box\nmodel#1=/box.obj\nwidth#1=60\ndepth#1=50\nheight#1=90\ncreator#1=Ann\n");
    Write("furniture/library/box.obj",
          "v 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nv 0 0 4\nv 2 0 4\nv 2 3 4\nv 0 3 4\n"
          "vn 1 0 0\nvn -1 0 0\nvn 0 1 0\nvn 0 -1 0\nvn 0 0 1\nvn 0 0 -1\n"
          "f 1//6 4//6 3//6 2//6\nf 1//4 2//4 6//4 5//4\nf 3//3 4//3 8//3 7//3\n"
          "f 1//2 5//2 8//2 4//2\nf 2//1 3//1 7//1 6//1\nf 5//5 6//5 7//5 8//5\n");
    Write("furniture/README.md", "no library\n");
    WriteGroups();
    Write("network.onnx", network_);
    options_.crops = kCrops;
    options_.views = 2;
    options_.layers = "AveragePool 0";
    options_.side = 8 * kPooledSide;
    options_.is_rgb = true;
  }
  void WriteGroups() const {
    Write("groups.json", nlohmann::json{{"groups", {desks_, things_}}}.dump());
  }
  void Run(int threads = 2) const {
    PrintedBy([&] { RunTrainingCrops(options_, files_, threads); });
  }
  void ExpectRefused(const std::vector<std::string>& words) const {
    ExpectError<InputError>([&] { Run(); }, words);
    EXPECT_FALSE(std::filesystem::exists(files_.at("output")));
  }

  nlohmann::json desks_ = {{"name", "desks"},
                           {"share", 0.6},
                           {"labels", {"desk"}},
                           {"models", nlohmann::json::array()},
                           {"parametric", {{"desk", 2}}}};
  nlohmann::json things_ = {
      {"name", "things"}, {"share", 0.4}, {"labels", {"thing"}}, {"models", {"bOX"}}};
  std::string network_ =
      GridNetwork{.input_width = 8 * kPooledSide, .input_height = 8 * kPooledSide}.Onnx();
  TrainingCropsOptions options_;
  StageFiles files_ = {{"groups", folder_ / "groups.json"},
                       {"furniture", folder_ / "furniture"},
                       {"network", folder_ / "network.onnx"},
                       {"output", folder_ / "crops.h5"}};
};

TEST_F(RunTrainingCropsTest, SaysWhatCropsAreOf) {
  options_.sheets = folder_ / "sheets";
  Run();
  const Hdf5File file = Hdf5File::Open(files_.at("output"));
  EXPECT_EQ(file.ReadText("/", "models"),
            "parametric\tdesk\tsoslam\tdesk 0\nparametric\tdesk\tsoslam\tdesk 1\n"
            "library\tBox\tAnn\tbox\n");
  EXPECT_EQ(file.ReadVector<int>("/group_of_model"), (std::vector<int>{0, 0, 1}));
  Random first(1), second(2);
  const std::array<Eigen::Vector3f, kModels> sizes = {ParametricModel("desk", &first)->size,
                                                      ParametricModel("desk", &second)->size,
                                                      {0.5F, 0.6F, 0.9F}};
  const auto models = file.ReadVector<int>("/model_of_crop", kCrops);
  const auto looks = file.ReadVector<int>("/look_of_crop", kCrops);
  const cv::Mat facts = file.ReadMatrix("/facts", CV_32F, kCrops, 6);
  for (int i = 0; i < kCrops; ++i) {
    EXPECT_EQ(looks[i], i / 2);
    const float* fact = facts.ptr<float>(i);
    EXPECT_LE(std::abs(fact[0]), std::numbers::pi_v<float>);
    for (int axis = 0; axis < 2; ++axis) {  // but for how it is stretched
      EXPECT_NEAR(fact[1 + axis], std::log(sizes.at(models[i])[axis] / sizes[models[i]].z()), 0.4F);
    }
    EXPECT_GE(fact[5], 0.4F);
    EXPECT_LE(fact[5], 1.0F);
    if (i % 2 == 0) continue;
    const float* before = facts.ptr<float>(i - 1);  // of the same look
    EXPECT_EQ(models[i], models[i - 1]);
    EXPECT_EQ(fact[1], before[1]);
    EXPECT_EQ(fact[2], before[2]);
    const double turn = std::remainder(fact[0] - before[0], 2.0 * std::numbers::pi);
    EXPECT_NE(turn, 0.0);
    EXPECT_LT(std::abs(turn), 75.0 * kRadPerDeg);
  }
  for (int model = 0; model < kModels; ++model) EXPECT_GT(std::ranges::count(models, model), 0);
  EXPECT_EQ(cv::imread(folder_ / "sheets/desks.png").cols, 8 * 140);
}

TEST_F(RunTrainingCropsTest, SaysWhatTheNetworkSaysOfCropsAndTheirMirrorImages) {
  Run();
  const Hdf5File file = Hdf5File::Open(files_.at("output"));
  EXPECT_EQ(file.ReadText("/", "layers"), options_.layers);
  EXPECT_EQ(file.ReadText("/", "network_sha256"), Sha256OfText(network_));
  constexpr int kCells = kPooledSide * kPooledSide;
  InnerLayers layers(network_, "network.onnx", {options_.layers}, options_.is_rgb);
  const cv::Mat probe = file.ReadMatrix("/probe", CV_32F, 3, kCells);
  EXPECT_EQ(cv::norm(probe, layers.Features(ProbeImage(options_.side)), cv::NORM_INF), 0.0);
  const cv::Mat features = file.ReadMatrix("/features/000000", CV_16S, 2 * kCrops, 3 * kCells);
  const double one = 1.0 / file.ReadNumber("/features", "quantum");
  for (int i = 0; i < 2 * kCrops; i += 2) {
    cv::Mat mirrored;  // each row of cells
    cv::flip(features.row(i).reshape(1, 3 * kPooledSide), mirrored, 1);
    EXPECT_LE(cv::norm(features.row(i + 1), mirrored.reshape(1, 1), cv::NORM_INF), 1.0);
    double lowest, highest;
    cv::minMaxLoc(features.row(i), &lowest, &highest);
    EXPECT_GE(lowest, 0.0);
    EXPECT_LE(highest, one);
    EXPECT_GT(highest, lowest + 0.1 * one);
    if (i == 0) continue;
    EXPECT_GT(cv::norm(features.row(i), features.row(i - 2), cv::NORM_INF), 0.0);
  }
}

TEST_F(RunTrainingCropsTest, ABoxDiffersFromItselfUnlessTurnedByHalfACircle) {
  options_.crops = 1;
  Run();
  const cv::Mat differences = Hdf5File::Open(files_.at("output"))
                                  .ReadMatrix("/difference_from_turned", CV_32F, kModels, 36);
  for (int model = 0; model < kModels; ++model) {
    const float* by_turn = differences.ptr<float>(model);
    EXPECT_EQ(by_turn[0], 0.0F);
    for (int turn = 1; turn < 36; ++turn) {
      EXPECT_NEAR(by_turn[turn], by_turn[36 - turn], 1e-3F);
      EXPECT_EQ(by_turn[turn] < 1.0F, model == 2 && turn == 18) << model << " " << by_turn[turn];
    }
  }
}

TEST_F(RunTrainingCropsTest, GivesTheSameBytesForAnyNumberOfThreads) {
  options_.crops = 7;
  ExpectSameBytesForThreads([&](int threads) { Run(threads); }, {files_.at("output")});
  const std::string bytes = FileBytes(files_.at("output"));
  ++options_.seed;
  Run();
  EXPECT_NE(FileBytes(files_.at("output")), bytes);
}

TEST_F(RunTrainingCropsTest, GroupsAndFoldersWithoutModelsAreRefused) {
  things_["models"] = {"box of another name"};
  WriteGroups();
  ExpectRefused({"group 'things'", "no model"});
  things_["models"] = {"Box"};
  desks_["parametric"]["spaceship"] = 1;
  WriteGroups();
  ExpectRefused({"group 'desks'", "spaceship"});
  for (const char* const folder : {"furniture/library", "none"}) {
    files_["furniture"] = folder_ / folder;
    ExpectRefused({files_.at("furniture").string(), "PluginFurnitureCatalog.properties"});
  }
}

TEST_F(RunTrainingCropsTest, FeaturesThatAreTooLargeToBeStoredAreRefused) {
  options_.is_rgb = false;
  ExpectRefused({"AveragePool 0", "expected at most"});
}

TEST_F(RunTrainingCropsTest, AListOfNoGroupsIsRefused) {
  Write("groups.json", R"({"groups": []})");
  ExpectRefused({"groups.json", "groups"});
}

TEST_F(RunTrainingCropsTest, AModelThatCannotBeSeenIsRefused) {
  Write("furniture/library/box.obj", "v 0 0 0\nv 1 1 1\nv 2 2 2\nf 1 2 3\n");
  ExpectRefused({"box.obj", "cannot be seen"});
}

}  // namespace
}  // namespace soslam
