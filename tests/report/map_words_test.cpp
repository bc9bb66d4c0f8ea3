// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/association/association.h"
#include "soslam/report/page_parts.h"
#include "support/expect_error.h"
#include "support/scene.h"
#include "support/true_map.h"

namespace soslam {
namespace {

using nlohmann::json;
using testing::HasSubstr;

Artefact<WorldReport> World(const WorldScale& scale) {
  Artefact<WorldReport> world;
  world.body.scale = scale;
  world.body.up.sigma_deg = 0.44;
  return world;
}

WorldScale Scale(const std::vector<std::string>& found_by) {
  return {.metres_per_unit = 0.3,
          .log_sigma = 0.05,
          .low = 0.25,
          .high = 0.36,
          .found_by = found_by,
          .objects = 7};
}

TEST(ScaleFromWorld, SaysHowGoodScaleAndUpAreAndWhatTheyRestOn) {
  const ScaleOfMap scale = ScaleFromWorld(World(Scale({"objects"})), {});
  EXPECT_TRUE(scale.in_metres);
  EXPECT_EQ(scale.log_sigma, 0.05);
  // 0.30 is the middle: from 0.25 to 0.36 is a factor of 1.2 to both sides.
  EXPECT_EQ(
      scale.sentence,
      "Scale ± 20 % (95 %), from the usual heights of 7 detected things. Up ± 0.4° (one standard "
      "deviation).");
  EXPECT_THAT(ScaleFromWorld(World(Scale({"objects", "camera_height_m"})), {}).sentence,
              HasSubstr("of 7 detected things and the camera's height given. Up"));
  EXPECT_EQ(scale.warning, "");
}

TEST(ScaleFromWorld, SaysWhatContradictsScaleAndUp) {
  WorldScale scale = Scale({"objects", "camera_height_m"});
  scale.contradicted_by = {"scale_of_objects_differs"};
  EXPECT_EQ(ScaleFromWorld(World(scale), {}).warning,
            "The scale may be wrong by more than that: the heights of objects contradict the "
            "camera's height given.");
  scale = Scale({"objects"});
  scale.contradicted_by = {"scale_contradicted"};
  Artefact<WorldReport> world = World(scale);
  const auto warning_of = [&](const char* check) {
    world.findings = {{check, Severity::kWarning, "", "", "", ""}};
    return ScaleFromWorld(world, {}).warning;
  };
  EXPECT_THAT(warning_of("up_direction"), HasSubstr("objects look alike in other ways to hold"));
  EXPECT_EQ(warning_of("cameras_turned"),
            "The scale may be wrong by more than that: the heights of objects contradict one "
            "another. Up may be wrong by more than that: the photos are turned in many ways.");
}

TEST(ScaleFromWorld, WithoutTheFileIsThatOfTheSequence) {
  Sequence sequence;
  EXPECT_TRUE(ScaleFromWorld({}, sequence).in_metres);
  EXPECT_EQ(ScaleFromWorld({}, sequence).sentence, "");
  sequence.odometry_world = OdometryWorld::kOwnWithScale;
  EXPECT_FALSE(ScaleFromWorld({}, sequence).in_metres);
  EXPECT_NE(ScaleFromWorld({}, sequence).sentence, "");
}

// Half axes 0.25, 0.5, 0.03 m, whose logarithms have standard deviations of 0.03, 0.12, 0.04.
ObjectEstimate Estimate() {
  ObjectEstimate estimate;
  estimate.landmark_in_world = Landmark{{}, {0.25, 0.5, 0.03}, kCuboidExponent};
  Covariance9 covariance = Covariance9::Zero();
  covariance.diagonal().tail<3>() = Eigen::Vector3d(0.03, 0.12, 0.04).cwiseAbs2();
  estimate.covariance = covariance;
  return estimate;
}

// Without the blanks at which no line may break.
std::string Plain(std::string text) {
  for (size_t at = text.find("\u00a0"); at != text.npos; at = text.find("\u00a0")) {
    text.replace(at, 2, " ");
  }
  return text;
}

TEST(SizeInWords, IsWidthDepthHeightWithTheirIntervals) {
  // exp(1.96 * 0.12) - 1 = 0.2652, of 0.03: 0.0606, of 0.04: 0.0816.
  EXPECT_EQ(Plain(SizeInWords(Estimate(), {})), "100 × 50 × 6.0 cm (± 27 × 3 × 0.5)");
  // With the variance of the scale: sqrt(0.12^2 + 0.05^2) = 0.13: 0.2902;
  // sqrt(0.03^2 + 0.05^2) = 0.0583: 0.1211; sqrt(0.04^2 + 0.05^2) = 0.0640: 0.1337.
  EXPECT_EQ(Plain(SizeInWords(Estimate(), {true, 0.05, ""})), "100 × 50 × 6.0 cm (± 29 × 6 × 0.8)");
  EXPECT_EQ(Plain(SizeInWords(Estimate(), {false, 0.0, ""})),
            "1.00 × 0.50 × 0.06 (± 0.27 × 0.03 × 0.00)");
  ObjectEstimate without = Estimate();
  without.covariance.reset();
  EXPECT_EQ(Plain(SizeInWords(without, {true, 0.05, ""})), "100 × 50 × 6.0 cm");
}

TEST(LabelsInWords, HasAlternativesOfATenthAndMore) {
  Object object;
  object.label = "chair";
  EXPECT_EQ(LabelsInWords(object), "");
  object.labels = {{"chair", 1.0}};
  EXPECT_EQ(LabelsInWords(object), "");
  object.labels = {{"chair", 0.93}, {"stool", 0.07}};
  EXPECT_EQ(LabelsInWords(object), "chair 93\u00a0%");
  object.labels = {{"sofa", 0.5}, {"chair", 0.38}, {"bench", 0.12}};
  EXPECT_EQ(LabelsInWords(object),
            "chair 38\u00a0%, or sofa 50\u00a0%, or bench 12\u00a0%; detected as chair, but its "
            "size is rather that of sofa");
  object.labels = {{"sofa", 0.8}, {"bench", 0.2}};  // its own has hardly any
  EXPECT_EQ(LabelsInWords(object),
            "sofa 80\u00a0%, or bench 20\u00a0%; detected as chair, but its size is rather that of "
            "sofa");
}

// Three objects, the first on the floor, the second on a shelf, the third on a wall.
class SupportInWordsTest : public testing::Test {
 protected:
  SupportInWordsTest() {
    const Plane floor = sequence_.planes[0].plane_in_world;
    sequence_.planes.push_back({7, {floor.normal, floor.offset - 0.724}});
    sequence_.planes.push_back({8, {floor.normal.unitOrthogonal(), 3.0}});
    map_ = TrueMap(sequence_);
    for (int i = 0; i < 3; ++i) {
      sequence_.objects[i].plane_index = i;
      map_.objects[i].landmark_in_world->half_axes.z() = 0.2;
    }
  }

  std::string Words(size_t object, const ScaleOfMap& scale = {}) const {
    return SupportInWords(map_.objects[object], sequence_, map_, scale);
  }

  Sequence sequence_ = CuboidSequence(3, 6);
  MapEstimate map_;
};

TEST_F(SupportInWordsTest, IsThePlaneAndItsHeight) {
  EXPECT_EQ(Words(0), "on the lowest plane");
  EXPECT_EQ(Words(1), "on plane 7, 72 cm above the lowest plane");
  EXPECT_EQ(Words(1, {false, 0.0, ""}), "on plane 7, 0.724 above the lowest plane");
  EXPECT_EQ(Words(2), "on a wall or ceiling");
  sequence_.objects[0].plane_index = kNoPlane;
  EXPECT_EQ(Words(0), "support unknown");
  EXPECT_EQ(Words(1), "on the support plane");  // there is no other level one
}

TEST_F(SupportInWordsTest, SaysThatAnObjectLies) {
  map_.objects[1].landmark_in_world->rests_on = RestingFace::kSide;
  EXPECT_EQ(Words(1), "on its side, on plane 7, 72 cm above the lowest plane");
}

TEST_F(SupportInWordsTest, IsTheFloorWhereSomethingTallIsOnIt) {
  map_.objects[0].landmark_in_world->half_axes.z() = 0.4;
  EXPECT_EQ(Words(0), "on the floor");
  EXPECT_EQ(Words(1), "on plane 7, 72 cm above the floor");
  EXPECT_EQ(Words(0, {false, 0.0, ""}), "on the lowest plane");
  EXPECT_EQ(Words(0, {.up_is_in_doubt = true}), "on the lowest plane");
}

Associations::TrackRow Track(TrackFate fate) {
  return {.fate = fate, .detections = 3, .frames_in_sight = 58};
}

// Associations of seven detections.
class TracksLeftOutTest : public testing::Test {
 protected:
  TracksLeftOutTest() {
    associations_.tracks = {Track(TrackFate::kObject), Track(TrackFate::kUndetermined),
                            Track(TrackFate::kMoves)};
    Add(0, 1, "chair");  // used
    Add(1, {}, "cup");   // of a track that was left out
    Add(1, {}, "mug");
    Add({}, {}, "cup");  // a duplicate
    Add(1, {}, "mug");
    Add(0, {}, "chair");  // a worse box of the object
    Add(2, {}, "cat");
  }
  void Add(std::optional<int> track, std::optional<int> object, const std::string& label) {
    const int frame = static_cast<int>(associations_.detections.size());
    const Box box = {10.0 * frame, 10.0, 10.0 * frame + 20.0, 40.0};
    associations_.detections.push_back({.name = {sequence_.frames[frame].id, frame, box},
                                        .label = label,
                                        .track = track,
                                        .object = object});
  }

  Sequence sequence_ = CuboidSequence(3, 8);
  Associations associations_;
};

TEST_F(TracksLeftOutTest, HaveAllTheirBoxes) {
  const std::vector<NotPlaced> things = TracksLeftOut(associations_, sequence_);
  ASSERT_EQ(things.size(), 2u);
  EXPECT_EQ(things[0].label, "mug");  // two of three boxes
  EXPECT_EQ(things[0].reason, "seen too little of to tell its size and place");
  ASSERT_EQ(things[0].boxes.size(), 3u);
  EXPECT_EQ(things[0].boxes[1].frame_index, 2);
  EXPECT_EQ(things[0].boxes[1].box, (Box{20.0, 10.0, 40.0, 40.0}));
  EXPECT_TRUE(things[0].boxes[1].is_whole);
  EXPECT_EQ(things[1].label, "cat");
  EXPECT_EQ(things[1].boxes.size(), 1u);
}

TEST_F(TracksLeftOutTest, AreRefusedWhereTheSequenceIsAnother) {
  sequence_.frames.erase(sequence_.frames.begin() + 2);
  ExpectError<InputError>([&] { TracksLeftOut(associations_, sequence_); },
                          {"associations.json", "frame 2", "sequence.json"});
}

}  // namespace
}  // namespace soslam
