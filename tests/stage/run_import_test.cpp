// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/dataset/import_options.h"
#include "soslam/stage/stages.h"
#include "soslam/system/hash.h"
#include "support/dataset_fixture.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/lists.h"
#include "support/printed.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class RunImportTest : public FolderTest {
 protected:
  void Run() {
    dataset.Write(files.at("dataset"));
    RunImport(options, files, 1);
  }

  ImportOptions options;
  DatasetFixture dataset;
  StageFiles files = {{"dataset", folder_ / "small"}, {"output", folder_ / "sequence.json"}};
};

TEST_F(RunImportTest, WritesTheSequenceAndSaysHowMuchIsUsed) {
  options.min_observations = 4;
  EXPECT_THAT(PrintedBy([&] { Run(); }).output,
              testing::EndsWith("small: 4 of 4 image files are not there\n"
                                "small: 4 frames, 2 objects, 4 detections used, 3 detections "
                                "rejected: 3 of an object with too few boxes\n"));
  const Sequence sequence = ReadSequence(files.at("output"));
  EXPECT_EQ(sequence.detections.size(), 4u);
  EXPECT_EQ(sequence.rejected_detections.at("too_few_observations"), 3);
}

TEST_F(RunImportTest, PassesOnWhatTheReconstructionOfItsPosesFound) {
  dataset.Write(files.at("dataset"));
  ArtefactInfo info;
  info.findings = {{"no_baseline", Severity::kWarning, "found", "expected", "cause", "remedy"}};
  ReconstructionSummary summary;
  summary.components = {{4, 100}};
  summary.images_without_pose = {"rgb/blurred.png"};
  WriteReconstruction(files.at("dataset") / "reconstruction.json", summary, info);
  RunImport({}, files, 1);
  const Sequence sequence = ReadSequence(files.at("output"));
  EXPECT_EQ(std::ranges::count(sequence.findings, "no_baseline", &Finding::check), 1);
  EXPECT_THAT(sequence.images_without_pose, testing::ElementsAre("rgb/blurred.png"));
}

// Other programs have files of that name as well.
TEST_F(RunImportTest, AReconstructionOfOthersIsLeftAndADamagedOneNamed) {
  dataset.files["reconstruction.json"] = R"([{"cameras": {}, "shots": {}}])";
  EXPECT_NO_THROW(Run());
  ReconstructionSummary summary;
  summary.components = {{4, 100}};
  const std::filesystem::path path = files.at("dataset") / "reconstruction.json";
  WriteReconstruction(path, summary, {});
  const nlohmann::json written = ParseJsonFile(path);
  for (const auto& [place, value] : {std::pair("/artefact", nlohmann::json(3)),
                                     {"/artefact/schema_version", {99, 0}},
                                     {"/registered", nullptr}}) {
    nlohmann::json changed = written;
    changed[nlohmann::json::json_pointer(place)] = value;
    WriteBytes(path, changed.dump());
    ExpectError<InputError>([&] { RunImport({}, files, 1); }, {"reconstruction.json"});
  }
}

TEST_F(RunImportTest, ArtefactNamesSettingsAndTheFilesThatWereRead) {
  options.border_px = 12.5;
  Run();
  const auto header = ReadArtefact(files.at("output"), "sequence").at("artefact");
  EXPECT_EQ(header.at("settings").at("border_px"), 12.5);
  EXPECT_EQ(header.at("settings").at("camera_planes"), "groundtruth");
  const auto name_of = [](const nlohmann::json& input) {
    return input.at("file").get<std::string>();
  };
  for (const auto& input : header.at("inputs")) {
    EXPECT_EQ(input.at("sha256"), Sha256OfFile(files.at("dataset") / name_of(input)));
  }
  EXPECT_THAT(Fields(header.at("inputs"), name_of),
              testing::ElementsAre("camera.json", "detections.csv", "groundtruth.txt",
                                   "objects.json", "odometry.txt", "planes.json", "rgb.txt"));
}

constexpr const char* kScene = R"({
  "name": "tiny",
  "camera": {"width": 80, "height": 60, "fx": 60, "fy": 60, "cx": 39.5, "cy": 29.5},
  "planes": [{"id": 0, "label": "floor", "normal": [0, 0, 1], "d": 0}],
  "objects": [{"id": 1, "label": "ball", "shape": "ellipsoid", "half_axes": [0.3, 0.2, 0.25],
               "plane": 0, "position": [2.5, 0.1]}],
  "trajectory": {"frames": 3, "frame_interval": 0.1, "waypoints": [
    {"position": [0, 0, 0.8], "look_at": [2.5, 0, 0.2]},
    {"position": [0.3, 0, 0.8], "look_at": [2.5, 0, 0.2]}]},
  "noise": {"box_sigma_px": 1.0, "odometry_translation_sigma": 0.1, "image_sigma": 3.0},
  "seed": 1
})";

class RunSynthesiseTest : public FolderTest {
 protected:
  // The detections that these options give.
  std::string Detections(const SynthesiseOptions& options) {
    RunSynthesise(options, {{"scene", scene_}, {"output", output_}}, 2);
    return FileBytes(output_ / "detections.csv");
  }

  std::filesystem::path scene_ = Write("scene.json", kScene);
  std::filesystem::path output_ = folder_ / "out" / "tiny";
};

TEST_F(RunSynthesiseTest, NoiseAndSeedAreOptions) {
  const std::string own_seed = Detections({});
  EXPECT_EQ(own_seed, Detections({.noise = true, .seed = 1}));
  EXPECT_NE(own_seed, Detections({.noise = true, .seed = 2}));
  const std::string exact = Detections({.noise = false});
  EXPECT_NE(exact, own_seed);
  EXPECT_EQ(exact, Detections({.noise = false, .seed = 2}));
  EXPECT_EQ(FileBytes(output_ / "odometry.txt"), FileBytes(output_ / "groundtruth.txt"));
}

TEST_F(RunSynthesiseTest, ABadSceneOrNothingInSightWritesNothing) {
  WriteBytes(scene_, "not JSON");
  EXPECT_THROW(Detections({}), InputError);
  auto scene = nlohmann::json::parse(kScene);
  scene["objects"][0]["position"] = {-4.0, 0.0};
  WriteBytes(scene_, scene.dump());
  EXPECT_THROW(Detections({}), NothingUsableError);
  EXPECT_FALSE(std::filesystem::exists(output_));
}

}  // namespace
}  // namespace soslam
