// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/exchange/world.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/json_file.h"
#include "soslam/image/distort_pixels.h"
#include "support/exported_world.h"
#include "support/lists.h"
#include "support/random_estimates.h"

namespace soslam {
namespace {

using testing::ElementsAre;

std::vector<int> FrameIds(const World& world) { return Fields(world.frames, &WorldFrame::id); }

std::vector<int> ObjectIds(const World& world) { return Fields(world.objects, &WorldObject::id); }

// Frames 10, 15, 20 are of segment 0, frames 25, 30 of segment 1; every second frame sees objects
// -3 and 11, the others 4 and 18.
class WorldTest : public testing::Test {
 protected:
  Sequence sequence_ = RandomSequence();
  MapEstimate map_ = RandomMap();
};

TEST_F(WorldTest, EachSegmentHasItsFramesAndObjects) {
  std::erase_if(sequence_.detections, [](const Detection& detection) {
    return detection.frame_index < 3 && detection.object_index != 2;
  });
  const std::vector<World> worlds = WorldsOfMap(sequence_, map_);
  ASSERT_EQ(worlds.size(), 2u);
  EXPECT_EQ(worlds[0].segment, 0);
  EXPECT_THAT(FrameIds(worlds[0]), ElementsAre(10, 15, 20));
  EXPECT_THAT(ObjectIds(worlds[0]), ElementsAre(11));
  EXPECT_EQ(worlds[1].segment, 1);
  EXPECT_THAT(FrameIds(worlds[1]), ElementsAre(25, 30));
  EXPECT_THAT(ObjectIds(worlds[1]), ElementsAre(-3, 18));
  EXPECT_EQ(worlds[1].objects[0].segment, 1);
  EXPECT_EQ(worlds[1].frames[0].camera, *sequence_.frames[3].camera);
  EXPECT_EQ(worlds[1].frames[1].camera, sequence_.camera);
  EXPECT_EQ(worlds[1].frames[0].world_from_camera.translation,
            map_.world_from_camera[3].translation);
}

TEST_F(WorldTest, ObjectsWithoutDetectionsBelongToTheOnlySegment) {
  sequence_.detections.clear();
  const World first = WorldsOfMap(sequence_, map_)[0];
  EXPECT_THAT(ObjectIds(first), ElementsAre(-3, 11, 18));
  EXPECT_FALSE(first.objects[0].segment);
  EXPECT_FALSE(first.objects[0].estimate.landmark_in_world);
  EXPECT_EQ(first.objects[0].estimate.failure, "unknown_segment");
  EXPECT_EQ(first.objects[2].estimate.failure, "too_few_views");
  for (Frame& frame : sequence_.frames) frame.segment = 7;
  const World world = Only(WorldsOfMap(sequence_, map_));
  EXPECT_THAT(ObjectIds(world), ElementsAre(-3, 11, 18));
  EXPECT_EQ(world.objects[0].segment, 7);
  EXPECT_TRUE(world.objects[0].estimate.landmark_in_world);
  EXPECT_EQ(world.objects[0].score, 1.0);
}

TEST_F(WorldTest, ScoreIsTheMeanOfTheDetections) {
  double sum = 0.0;
  int count = 0;
  for (Detection& detection : sequence_.detections) {
    if (detection.object_index != 0) continue;
    detection.score = 0.1 * ++count;
    sum += detection.score;
  }
  EXPECT_NEAR(WorldsOfMap(sequence_, map_)[0].objects[0].score, sum / count, 1e-12);
}

TEST_F(WorldTest, PlanesOfTheMapAreItsSupports) {
  const World world = WorldsOfMap(sequence_, map_)[0];
  EXPECT_EQ(world.objects[0].support_normal, map_.planes_in_world[0].normal);
}

TEST_F(WorldTest, TruthHasWhatIsKnown) {
  const World world = WorldsOfTruth(sequence_)[0];
  EXPECT_THAT(FrameIds(world), ElementsAre(10, 20));
  EXPECT_EQ(world.frames[1].world_from_camera.translation,
            sequence_.frames[2].true_world_from_camera->translation);
  const Landmark truth = RandomLandmark();
  sequence_.true_objects = {
      {5, "cup", {truth}, 0}, {6, "car", {truth}, 0, false}, {7, "tv", {truth}, 1}};
  const World known = WorldsOfTruth(sequence_)[0];
  ASSERT_THAT(ObjectIds(known), ElementsAre(5, 6));
  EXPECT_EQ(known.objects[0].estimate.landmark_in_world->half_axes, truth.half_axes);
  EXPECT_EQ(known.objects[0].estimate.landmark_in_world->shape_exponents, kCuboidExponent);
  EXPECT_NEAR(known.objects[0].support_normal.dot(truth.frame_from_object.rotation *
                                                  Eigen::Vector3d::UnitZ()),
              1.0, 1e-12);
  EXPECT_EQ(known.objects[1].estimate.failure, "moving");
  EXPECT_FALSE(known.objects[1].estimate.landmark_in_world);
  EXPECT_THAT(ObjectIds(WorldsOfTruth(sequence_)[1]), ElementsAre(7));
}

TEST_F(WorldTest, UpIsTheNormalThatMostShare) {
  World world;
  EXPECT_EQ(EstimateCommonUp(world), Eigen::Vector3d::UnitZ());
  const auto add = [&](const Eigen::Vector3d& normal, bool has_landmark) {
    world.objects.push_back({0, "", {}, normal, 1.0, {}});
    if (has_landmark) world.objects.back().estimate.landmark_in_world = RandomLandmark();
  };
  const Eigen::Vector3d floor(0.0, -1.0, 0.0);
  for (int i = 0; i < 4; ++i) add(Eigen::Vector3d::UnitX(), false);
  add(Eigen::Vector3d::UnitZ(), true);
  add(floor, true);
  add(-floor, true);
  add(Eigen::Vector3d(0.1, -1.0, 0.0).normalized(), true);
  EXPECT_EQ(EstimateCommonUp(world), floor);
}

using nlohmann::json;

json Quality(double scale, const Rigid3d& truth_from_scaled) {
  return {{"alignments",
           {{{"segment", 4},
             {"scale", scale},
             {"truth_from_scaled", DescribedToJson(truth_from_scaled)}}}},
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

// Three cameras side by side; the file of points is of another world than the map.
TEST(WorldPointsTest, AreWhereThePosesPlaceTheirImagePoints) {
  Sequence sequence;
  sequence.camera = TestCamera();
  sequence.image_distortion = Distortion{.k1 = -0.1};
  for (int i = 0; i < 3; ++i) {
    sequence.frames.push_back(
        {10 * i, 0.1 * i, "", {Eigen::Quaterniond::Identity(), {0.3 * i, 0.0, 0.0}}, {}});
  }
  const std::vector<Eigen::Vector3d> positions = {{0.1, -0.2, 3.0}, {0.4, 0.3, 4.0}};
  std::vector<MapPoint> points(3);
  for (size_t k = 0; k < 2; ++k) {
    for (const Frame& frame : sequence.frames) {
      const auto pixel = sequence.camera.Project(frame.world_from_camera.Inverse() * positions[k]);
      points[k].observations.push_back(
          {frame.id, DistortPixels(sequence.camera, *sequence.image_distortion, {*pixel}).front()});
    }
    points[k].observations.push_back({7, {1.0, 1.0}});  // no frame of the sequence
  }
  points[2].observations = {points[0].observations[0]};
  const Rigid3d map_from_sequence = RandomRigid();
  MapEstimate map;
  for (const Frame& frame : sequence.frames) {
    map.world_from_camera.push_back(map_from_sequence * frame.world_from_camera);
  }
  std::vector<World> worlds = WorldsOfMap(sequence, map);
  AddPoints(sequence, points, &worlds);
  const std::vector<WorldPoint>& placed = Only(worlds).points;
  ASSERT_EQ(placed.size(), 2u);
  for (size_t k = 0; k < 2; ++k) {
    EXPECT_LT((placed[k].position_in_world - map_from_sequence * positions[k]).norm(), 1e-6);
    EXPECT_LT(placed[k].reprojection_error_px, 1e-4);
    EXPECT_EQ(placed[k].observations.size(), 3u);
  }

  // With a frame of another segment, each world has what two of its frames see.
  for (size_t i = 1; i < 3; ++i) sequence.frames[i].segment = 1;
  worlds = WorldsOfMap(sequence, map);
  AddPoints(sequence, points, &worlds);
  EXPECT_EQ(worlds[0].points.size(), 0u);
  EXPECT_EQ(worlds[1].points.size(), 2u);
}

}  // namespace
}  // namespace soslam
