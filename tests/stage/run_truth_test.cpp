// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/image/frame_choice.h"
#include "soslam/stage/stages.h"
#include "support/drawn_photos.h"
#include "support/expect_error.h"
#include "support/folder_test.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Five photos with a dataset of their own, of which the first four are annotated under other times.
class RunTruthTest : public FolderTest {
 protected:
  void SetUp() override {
    fs::create_directory(folder_ / "photos");
    for (int i = 0; i < 5; ++i) {
      WritePhoto(folder_ / "photos" / ("view " + std::to_string(i) + ".jpg"), DrawnView(20 * i));
    }
    RunFrames({}, {{"images", folder_ / "photos"}, {"output", folder_ / "room"}}, 2);
    Annotate({"view 3", "view 1", "view 2", "view 0"});
    Write("truth/objects.json", kObjects);
  }

  // Images at 10 s, 20 s, ... and poses as many metres along x.
  void Annotate(const std::vector<std::string>& names) {
    std::string list, poses;
    for (size_t i = 1; i <= names.size(); ++i) {
      const std::string time = std::to_string(10 * i);
      list += time + " rgb/" + names[i - 1] + ".jpg\n";
      poses += time + ".01 " + time + " 0 0 0 0 0 1\n";
    }
    Write("truth/rgb.txt", list);
    Write("truth/groundtruth.txt", poses);
  }

  void Run() { RunTruth({}, files_, 1); }

  static constexpr const char* kObjects = R"([{"id": 1, "label": "cup"}])";
  StageFiles files_ = {
      {"dataset", folder_ / "room"}, {"truth", folder_ / "truth"}, {"output", folder_ / "found"}};
};

TEST_F(RunTruthTest, PosesTakeTheTimesOfThePhotosOfTheirNames) {
  Run();
  const auto trajectory = ReadTrajectory(folder_ / "found/groundtruth.txt");
  ASSERT_EQ(trajectory.size(), 4u);
  const std::vector<double> along_x = {40.0, 20.0, 30.0, 10.0};
  for (size_t i = 0; i < along_x.size(); ++i) {
    EXPECT_EQ(trajectory[i].timestamp, static_cast<double>(i));
    EXPECT_EQ(trajectory[i].world_from_camera.translation.x(), along_x[i]);
  }
  EXPECT_EQ(FileBytes(folder_ / "found/objects.json"), kObjects);
}

TEST_F(RunTruthTest, ImagesWithoutPoseTellNothing) {
  Write("truth/groundtruth.txt", "10 1 0 0 0 0 0 1\n20 2 0 0 0 0 0 1\n30.5 3 0 0 0 0 0 1\n");
  ExpectError<InputError>(
      [&] { Run(); },
      {"2 of 5 photos have the name of an image with a true pose", "expected at least 3"});
  EXPECT_FALSE(fs::exists(folder_ / "found"));
}

TEST_F(RunTruthTest, OtherPhotosAreNamed) {
  Annotate({"a", "b", "c"});
  ExpectError<InputError>([&] { Run(); }, {"rgb/a.jpg", "view 0.jpg"});
}

TEST_F(RunTruthTest, BadObjectsAreRefusedAndNothingIsWritten) {
  Write("truth/objects.json", "[{}]");
  ExpectError<InputError>([&] { Run(); }, {"objects.json"});
  EXPECT_FALSE(fs::exists(folder_ / "found"));
}

}  // namespace
}  // namespace soslam
