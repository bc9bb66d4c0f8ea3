// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "artefact/model_json.h"
#include "exchange/world.h"
#include "support/exported_world.h"

namespace soslam {
namespace {

using nlohmann::json;

json Quality(double scale, const Rigid3d& truth_from_scaled) {
  return {{"alignments",
           {{{"segment", 4}, {"scale", scale}, {"truth_from_scaled", truth_from_scaled}}}},
          {"landmarks",
           {{{"object", 2},
             {"fate", "found"},
             {"true_object", 7},
             {"errors", {{"iou", 0.5}}},
             {"reason", nullptr}},
            {{"object", 3},
             {"fate", "false"},
             {"true_object", nullptr},
             {"errors", nullptr},
             {"reason", "background"}}}}};
}

TEST(AddVerdicts, LandmarksHaveTheirVerdicts) {
  std::vector<World> worlds = {ExportedWorld()};
  AddVerdicts(Quality(1.0, {}), &worlds);
  const auto& objects = worlds[0].objects;
  EXPECT_EQ(objects[0].verdict->fate, "found");
  EXPECT_EQ(objects[0].verdict->true_object, 7);
  EXPECT_EQ(objects[0].verdict->iou, 0.5);
  EXPECT_EQ(objects[1].verdict->fate, "false");
  EXPECT_EQ(objects[1].verdict->reason, "background");
  EXPECT_FALSE(objects[1].verdict->iou);
  EXPECT_FALSE(objects[2].verdict);
}

// Cameras see landmarks where they saw them; standard deviations turn and grow with the world.
TEST(AlignWorlds, WorldsAreMovedAsAWhole) {
  const World before = ExportedWorld();
  const double scale = 2.5;
  const Rigid3d motion = RandomRigid();
  std::vector<World> worlds = {before};
  AlignWorlds(Quality(scale, motion), &worlds);
  for (size_t i = 0; i < 3; ++i) {
    const Landmark& old = *before.objects[i].estimate.landmark_in_world;
    const Landmark& moved = *worlds[0].objects[i].estimate.landmark_in_world;
    EXPECT_TRUE(moved.half_axes.isApprox(scale * old.half_axes, 1e-12));
    const Eigen::Vector3d seen = before.frames[1].world_from_camera.Inverse() * old.Centre();
    const Eigen::Vector3d seen_now =
        worlds[0].frames[1].world_from_camera.Inverse() * moved.Centre();
    EXPECT_TRUE(seen_now.isApprox(scale * seen, 1e-9));
  }
  const Covariance9& old = *before.objects[0].estimate.covariance;
  const Covariance9& moved = *worlds[0].objects[0].estimate.covariance;
  const Eigen::Vector3d along = RandomVector(-1.0, 1.0);
  const Eigen::Vector3d moved_along = motion.rotation * along;
  EXPECT_NEAR(moved_along.dot(moved.block<3, 3>(3, 3) * moved_along),
              scale * scale * along.dot(old.block<3, 3>(3, 3) * along), 1e-9);
  EXPECT_NEAR(moved_along.dot(moved.block<3, 3>(0, 0) * moved_along),
              along.dot(old.block<3, 3>(0, 0) * along), 1e-9);
  EXPECT_TRUE((moved.block<3, 3>(6, 6).isApprox(old.block<3, 3>(6, 6), 1e-12)));
}

}  // namespace
}  // namespace soslam
