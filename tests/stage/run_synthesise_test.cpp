// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "stage/stages.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

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

class RunSynthesiseTest : public testing::Test {
 protected:
  void SetUp() override { WriteBytes(scene_, kScene); }

  // The detections that these options give.
  std::string Detections(const SynthesiseOptions& options) {
    RunSynthesise(options, {{"scene", scene_}, {"output", output_}}, 2);
    return FileBytes(output_ / "detections.csv");
  }

  TemporaryFolder temporary_;
  std::filesystem::path scene_ = temporary_.path() / "scene.json";
  std::filesystem::path output_ = temporary_.path() / "out" / "tiny";
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

TEST_F(RunSynthesiseTest, BadSceneWritesNothing) {
  WriteBytes(scene_, "{\"name\": \"no more than a name\"}");
  EXPECT_THROW(Detections({}), InputError);
  WriteBytes(scene_, "not JSON");
  EXPECT_THROW(Detections({}), InputError);
  std::filesystem::remove(scene_);
  EXPECT_THROW(Detections({}), InputError);
  EXPECT_FALSE(std::filesystem::exists(output_));
}

TEST_F(RunSynthesiseTest, NothingInSightIsAnError) {
  auto scene = nlohmann::json::parse(kScene);
  scene["objects"][0]["position"] = {-4.0, 0.0};
  WriteBytes(scene_, scene.dump());
  EXPECT_THROW(Detections({}), NothingUsableError);
  EXPECT_FALSE(std::filesystem::exists(output_));
}

}  // namespace
}  // namespace soslam
