// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "artefact/json_file.h"
#include "artefact/points_file.h"
#include "artefact/sequence_file.h"
#include "base/error.h"
#include "base/hash.h"
#include "stage/data_stages.h"
#include "support/dataset_fixture.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

using testing::HasSubstr;

class RunImportTest : public testing::Test {
 protected:
  void Run(const ImportOptions& options = {}) {
    dataset.Write(files.at("dataset"));
    RunImport(options, files, 1);
  }

  DatasetFixture dataset;
  std::filesystem::path folder = FreshTestFolder();
  StageFiles files = {{"dataset", folder / "small"}, {"output", folder / "sequence.json"}};
};

TEST_F(RunImportTest, WritesTheSequenceAndSaysHowMuchIsUsed) {
  testing::internal::CaptureStdout();
  ImportOptions options;
  options.min_observations = 4;
  Run(options);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::EndsWith("small: 4 frames, 2 objects, 4 detections used, 3 detections "
                                "rejected: too_few_observations 3\n"));
  const Sequence sequence = ReadSequence(files.at("output"));
  EXPECT_EQ(sequence.detections.size(), 4u);
  EXPECT_EQ(sequence.rejected_detections.at("too_few_observations"), 3);
}

TEST_F(RunImportTest, WritesThePointsOfTheModelThatHasThePoses) {
  dataset.files["cameras.txt"] = "1 PINHOLE 640 480 500 510 320 240\n";
  dataset.files["images.txt"] =
      "1 1 0 0 0 0 0 0 1 rgb/0.jpg\n9 9 1\n2 1 0 0 0 -0.1 0 0 1 rgb/1.jpg\n8 9 1\n"
      "3 1 0 0 0 -0.2 0 0 1 rgb/2.jpg\n\n4 1 0 0 0 -0.3 0 0 1 rgb/3.jpg\n\n";
  dataset.files["points3D.txt"] = "1 0 0 5 0 0 0 0.5 2 0 1 0\n";
  files["points"] = folder / "points.h5";
  ExpectError<SettingsError>([&] { Run(); }, {"points", "trajectory_format", "colmap"});
  ImportOptions options;
  options.folder.odometry = "images.txt";
  options.folder.trajectory_format = TrajectoryFormat::kColmap;
  options.folder.groundtruth_format = TrajectoryFormat::kTum;
  Run(options);
  const auto points = ReadPoints(files.at("points"));
  ASSERT_EQ(points.size(), 1u);
  EXPECT_EQ(points[0].position_in_world, Eigen::Vector3d(0, 0, 5));
  ASSERT_EQ(points[0].observations.size(), 2u);
  EXPECT_EQ(points[0].observations[1].frame_id, 1);
  EXPECT_EQ(points[0].observations[1].pixel, Eigen::Vector2d(7.5, 8.5));
}

TEST_F(RunImportTest, ArtefactNamesSettingsAndTheFilesThatWereRead) {
  ImportOptions options;
  options.border_px = 12.5;
  Run(options);
  const auto header = ReadArtefact(files.at("output"), "sequence").at("artefact");
  EXPECT_EQ(header.at("settings").at("border_px"), 12.5);
  EXPECT_EQ(header.at("settings").at("camera_planes"), "groundtruth");
  std::vector<std::string> names;
  for (const auto& input : header.at("inputs")) {
    names.push_back(input.at("file"));
    EXPECT_EQ(input.at("sha256"), Sha256OfFile(files.at("dataset") / names.back()));
  }
  EXPECT_THAT(names,
              testing::ElementsAre("camera.json", "detections.csv", "groundtruth.txt",
                                   "objects.json", "odometry.txt", "planes.json", "rgb.txt"));
}

TEST_F(RunImportTest, ATrajectoryThatIsNotReadIsNotAnInput) {
  ImportOptions options;
  options.trajectory = TrajectorySource::kGroundTruth;
  Run(options);
  for (const auto& input : ParseJsonFile(files.at("output")).at("artefact").at("inputs")) {
    EXPECT_NE(input.at("file"), "odometry.txt");
  }
}

TEST_F(RunImportTest, FailureLeavesTheEarlierResult) {
  Run();
  const std::string before = ReadText(files.at("output"));
  dataset.files["camera.json"] = "{}";
  EXPECT_THROW(Run(), InputError);
  EXPECT_EQ(ReadText(files.at("output")), before);
}

TEST_F(RunImportTest, SameInputsGiveTheSameBytes) {
  Run();
  const std::string first = ReadText(files.at("output"));
  std::filesystem::remove(files.at("output"));
  Run();
  EXPECT_EQ(ReadText(files.at("output")), first);
}

}  // namespace
}  // namespace soslam
