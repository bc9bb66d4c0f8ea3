// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "soslam/base/error.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/dataset_files.h"
#include "soslam/dataset/gate.h"
#include "soslam/model/occlusion.h"
#include "support/dataset_fixture.h"
#include "support/imported_folder.h"
#include "support/level_sequence.h"
#include "support/lists.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::Pair;

class ImportTest : public ImportedFolderTest {
 protected:
  Sequence Import() override {
    dataset.Write(folder_.path());
    return ImportedFolderTest::Import();
  }

  DatasetFixture dataset;
};

TEST_F(ImportTest, ReadsEverything) {
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.name, folder_.path().filename());
  EXPECT_EQ(sequence.camera.width, 640);
  EXPECT_EQ(sequence.camera.fy, 510.0);
  ASSERT_EQ(sequence.frames.size(), 4u);
  EXPECT_EQ(sequence.frames[2].id, 2);
  EXPECT_EQ(sequence.frames[2].image, "rgb/2.jpg");
  EXPECT_EQ(sequence.frames[2].timestamp, 3.0);
  EXPECT_EQ(sequence.frames[2].world_from_camera.translation, Eigen::Vector3d(0.22, 0, 1.5));
  EXPECT_EQ(sequence.frames[2].true_world_from_camera->translation, Eigen::Vector3d(0.2, 0, 1));
  ASSERT_EQ(sequence.objects.size(), 2u);
  EXPECT_EQ(sequence.objects[0].label, "cup");
  EXPECT_EQ(sequence.objects[0].ground_truth->landmark_in_world.half_axes,
            Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_FALSE(sequence.objects[1].ground_truth.has_value());
  EXPECT_EQ(sequence.detections.size(), 7u);
  EXPECT_EQ(sequence.detections[1].object_index, 1);
  EXPECT_EQ(sequence.detections[1].box.x_max, 400.0);
  EXPECT_TRUE(sequence.rejected_detections.empty());
}

TEST_F(ImportTest, EveryOtherFrameIsHeldOutWithoutItsRejectedDetections) {
  dataset.files["detections.csv"] += "1,1,cup,0.7,10,100,200,200\n2,1,cup,0.7,10,100,200,200\n";
  options_.held_out = HeldOutFrames::kOdd;
  options_.min_observations = 1;
  const Sequence sequence = Import();
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.frames[1].id, 2);
  ASSERT_EQ(sequence.detections.size(), 4u);
  EXPECT_EQ(sequence.detections[2].frame_index, 1);
  EXPECT_EQ(sequence.detections[2].box.x_min, 102.0);
  ASSERT_EQ(sequence.held_out.size(), 2u);
  EXPECT_EQ(sequence.held_out[0].frame.id, 1);
  ASSERT_EQ(sequence.held_out[0].boxes.size(), 2u);
  EXPECT_EQ(sequence.held_out[0].boxes[1].label, "box");
  EXPECT_EQ(sequence.held_out[0].boxes[1].box.x_min, 301.0);
  EXPECT_EQ(sequence.held_out[1].frame.id, 3);
  EXPECT_EQ(sequence.held_out[1].boxes.size(), 1u);
  EXPECT_EQ(sequence.frames.at(Only(sequence.rejected).frame_index).id, 2);
}

// The camera's z axis is the world's: at height 1 it has the plane z = 0.5 half a metre behind it.
TEST_F(ImportTest, CarriesPlanesIntoFramesWithTruePoses) {
  EXPECT_DOUBLE_EQ(Import().detections[0].plane_in_camera.offset, 0.5);
  options_.camera_planes = PlanePoses::kTrajectory;  // at height 1.5
  EXPECT_DOUBLE_EQ(Import().detections[0].plane_in_camera.offset, 1.0);
  options_.camera_planes = PlanePoses::kGroundTruth;
  dataset.files.erase("groundtruth.txt");
  std::filesystem::remove(folder_ / "groundtruth.txt");
  EXPECT_DOUBLE_EQ(Import().detections[0].plane_in_camera.offset, 1.0);
}

TEST_F(ImportTest, TrajectoryIsChosenAndFallsBackAsItSays) {
  options_.trajectory = TrajectorySource::kGroundTruth;
  EXPECT_EQ(Import().frames[0].world_from_camera.translation.z(), 1.0);
  options_.trajectory = TrajectorySource::kOdometry;
  std::filesystem::remove(folder_ / "odometry.txt");
  dataset.files.erase("odometry.txt");
  testing::internal::CaptureStdout();
  EXPECT_EQ(Import().frames[0].world_from_camera.translation.z(), 1.0);
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::AllOf(testing::HasSubstr("no odometry.txt"),
                             testing::HasSubstr("using groundtruth.txt")));
}

TEST_F(ImportTest, LineEndsByteOrderMarkAndCommentsOfAllTextFilesAreRead) {
  const Sequence plain = Import();
  const auto files = dataset.files;
  for (const std::string end : {"\r\n", "\r"}) {
    for (const char* name : {"rgb.txt", "odometry.txt", "groundtruth.txt", "detections.csv"}) {
      std::string text = "\xEF\xBB\xBF# comment" + end + end;
      for (const char c : files.at(name)) text += c == '\n' ? end : std::string(1, c);
      dataset.files[name] = text;
    }
    const Sequence sequence = Import();
    EXPECT_EQ(sequence.frames.back().image, plain.frames.back().image);
    EXPECT_EQ(sequence.frames.size(), plain.frames.size());
    EXPECT_EQ(sequence.detections.size(), plain.detections.size());
  }
}

TEST_F(ImportTest, LabelsThatFlickerAreThoseOfMostBoxes) {
  dataset.Replace("detections.csv", "1,2,box", "1,2,crate");
  options_.labels = "box";
  testing::internal::CaptureStdout();
  const Sequence sequence = Import();
  EXPECT_THAT(testing::internal::GetCapturedStdout(),
              testing::HasSubstr("detections.csv: 1 of 7 boxes have another label"));
  EXPECT_EQ(sequence.objects.at(1).label, "box");
  EXPECT_EQ(sequence.detections.size(), 3u);
}

TEST_F(ImportTest, UndetectedObjectsStayAndObjectsAreSortedById) {
  dataset.files["objects.json"] =
      R"([{"id": 9, "label": "lamp", "center": [1, 2, 3], "quaternion_xyzw": [0, 0, 0, 1],
           "half_axes": [1, 1, 1], "rotationally_symmetric": true},
          {"id": 1, "label": "cup"}])";
  const Sequence sequence = Import();
  ASSERT_THAT(Fields(sequence.objects, &Object::id), ElementsAre(1, 2, 9));
  EXPECT_FALSE(sequence.objects[0].ground_truth.has_value());
  EXPECT_TRUE(sequence.objects[2].ground_truth->rotationally_symmetric);
}

TEST_F(ImportTest, ObjectsMayRestOnOtherFaces) {
  dataset.files["objects.json"] =
      R"([{"id": 9, "label": "lamp", "center": [1, 2, 3], "quaternion_xyzw": [0, 0, 0, 1],
           "half_axes": [1, 1, 1], "rests_on": "side", "rotationally_symmetric": false}])";
  EXPECT_EQ(Import().objects.back().ground_truth->landmark_in_world.rests_on, RestingFace::kSide);
  dataset.Replace("objects.json", "false", "true");
  ExpectRefused({"objects.json", "rotationally_symmetric", "does not rest on its bottom"});
  dataset.Replace("objects.json", "\"side\"", "\"left\"");
  ExpectRefused({"objects.json", "rests_on", "left", "bottom, back or side"});
}

TEST_F(ImportTest, ImageTakesTheNearestPoseWithinTheLimit) {
  dataset.Replace("odometry.txt", "1.001 0 0 1.5", "1.02 0 0 1.7");
  dataset.files["odometry.txt"] += "0.99 0 0 1.6 0 0 0 1\n2.04 0 0 9 0 0 0 1\n";
  EXPECT_EQ(Import().frames[0].world_from_camera.translation.z(), 1.6);
  EXPECT_EQ(Import().frames[1].world_from_camera.translation.z(), 1.5);
  options_.max_time_difference_s = 0.005;
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.frames.size(), 3u);
  EXPECT_EQ(sequence.frames[0].id, 1);
  EXPECT_EQ(sequence.rejected_detections.at("frame_without_pose"), 2);
}

TEST_F(ImportTest, FrameWithoutTruePoseHasNoTruePlane) {
  dataset.Replace("groundtruth.txt", "1.0 0 0 1 0 0 0 1\n", "");
  options_.min_observations = 1;
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.frames.size(), 4u);
  EXPECT_FALSE(sequence.frames[0].true_world_from_camera.has_value());
  EXPECT_THAT(sequence.rejected_detections, ElementsAre(Pair("frame_without_pose", 2)));
}

// Rows that are put in place of object 1's in frame 0, and why they are left out.
constexpr std::pair<const char*, const char*> kGatedRows[] = {
    {"0,1,cup,0.9,29.49,100,200,200", "near_border"},
    {"0,1,cup,0.9,100,29.49,200,200", "near_border"},
    {"0,1,cup,0.9,100,100,609.51,200", "near_border"},
    {"0,1,cup,0.9,100,100,200,449.51", "near_border"},
    {"0,1,cup,0.9,-50,100,200,200", "near_border"},
    {"0,1,cup,0.9,-50,100,-1,200", "outside_image"},
    {"0,1,cup,0.9,640,100,700,200", "outside_image"},
    {"0,1,cup,0.9,100,480,200,500", "outside_image"},
    {"0,1,cup,0.9,200,100,100,200", "empty_box"},
    {"0,1,cup,0.9,100,100,100,200", "empty_box"},
    {"0,1,cup,0.9,100,200,200,200", "empty_box"},
    {"0,1,cup,0.29,100,100,200,200", "low_score"},
};

TEST_F(ImportTest, TheReasonOfEachRejectionIsCounted) {
  const DatasetFixture plain = dataset;
  const std::string first_row = "0,1,cup,0.9,100,100,200,200";
  options_.min_score = 0.3;
  for (const auto& [row, reason] : kGatedRows) {
    SCOPED_TRACE(row);
    dataset = plain;
    dataset.Replace("detections.csv", first_row, row);
    const Sequence sequence = Import();
    EXPECT_THAT(sequence.rejected_detections, ElementsAre(Pair(reason, 1)));
    EXPECT_EQ(sequence.detections.size(), 6u);
  }
  dataset = plain;
  dataset.Replace("detections.csv", first_row,
                  "0,1,cup,0.3,29.5,29.5,609.5,449.5");  // exactly 30 px
  const Sequence sequence = Import();
  EXPECT_TRUE(sequence.rejected_detections.empty());
  EXPECT_EQ(sequence.detections.size(), 7u);
}

TEST_F(ImportTest, DuplicateWithTheHigherScoreIsKeptAndTheFirstOfEquals) {
  dataset.files["detections.csv"] +=
      "0,1,cup,0.95,110,100,200,200\n1,1,cup,0.9,120,100,200,200\n2,1,cup,0.1,130,100,200,200\n";
  const Sequence sequence = Import();
  EXPECT_THAT(sequence.rejected_detections, ElementsAre(Pair("duplicate", 3)));
  EXPECT_EQ(sequence.detections[0].box.x_min, 110.0);
  EXPECT_EQ(sequence.detections[2].box.x_min, 101.0);
  EXPECT_EQ(sequence.detections[4].box.x_min, 102.0);
}

// The cameras look level over a floor 1 m below. The box in front of the cup is too close to the
// border in frame 0, too uncertain in frame 1, seen too rarely in frame 2.
TEST_F(ImportTest, BoxesThatAreNotUsedHideLowerEdgesUnlessTheyMayNotBeReal) {
  dataset.files["planes.json"] = R"([{"id": 0, "normal": [0, -1, 0], "d": 1}])";
  dataset.files["detections.csv"] =
      "frame,object_id,label,score,x1,y1,x2,y2\n"
      "0,1,cup,0.9,100,100,200,300\n0,2,box,0.8,90,200,210,470\n"
      "1,1,cup,0.9,100,100,200,300\n1,2,box,0.1,90,200,210,440\n"
      "2,1,cup,0.9,100,100,200,300\n2,2,box,0.8,90,200,210,440\n";
  options_.min_score = 0.3;
  const Sequence sequence = Import();
  EXPECT_THAT(
      sequence.rejected_detections,
      ElementsAre(Pair("low_score", 1), Pair("near_border", 1), Pair("too_few_observations", 1)));
  ASSERT_EQ(sequence.detections.size(), 3u);
  const std::array<bool, 4> lower_edge = {false, false, false, true};
  EXPECT_EQ(sequence.detections[0].is_one_sided, lower_edge);
  EXPECT_EQ(sequence.detections[1].is_one_sided, (std::array<bool, 4>{}));
  EXPECT_EQ(sequence.detections[2].is_one_sided, lower_edge);
  EXPECT_EQ(BoxesInFront(sequence, sequence.detections[0]),
            (std::vector<Box>{{90, 200, 210, 470}}));
  EXPECT_TRUE(BoxesInFront(sequence, sequence.detections[1]).empty());
  EXPECT_EQ(BoxesInFront(sequence, sequence.detections[2]),
            (std::vector<Box>{{90, 200, 210, 440}}));
  options_.hidden_edge_fraction = 0.0;
  EXPECT_EQ(Import().detections[1].is_one_sided, lower_edge);
}

TEST_F(ImportTest, WhatIsTrueStaysWithoutIds) {
  const Sequence with_ids = Import();
  EXPECT_EQ(with_ids.true_objects.size(), 1u);
  EXPECT_EQ(with_ids.detections[0].true_object_id, 1);
  EXPECT_FALSE(with_ids.detections[1].true_object_id);  // box 2 is not in objects.json
  dataset.files["detections.csv"] =
      "frame,label,score,x1,y1,x2,y2\n0,cup,0.9,100,100,200,200\n1,cup,0.9,100,100,200,200\n";
  const Sequence sequence = Import();
  const TrueObject object = Only(sequence.true_objects);
  EXPECT_EQ(object.id, 1);
  EXPECT_EQ(object.label, "cup");
  EXPECT_EQ(object.truth.landmark_in_world.Centre(), Eigen::Vector3d(1, 2, 3));
  EXPECT_FALSE(sequence.objects.at(0).ground_truth);
  EXPECT_FALSE(sequence.detections.at(0).true_object_id);
}

TEST_F(ImportTest, RejectedDetectionsOfUsedFramesStay) {
  dataset.files["detections.csv"] +=
      "0,1,cup,0.95,110,100,200,200\n2,1,cup,0.7,10,100,200,200\n3,,sofa,0.2,50,100,200,200\n";
  options_.first_frame = 1;
  const Sequence sequence = Import();
  EXPECT_THAT(sequence.rejected_detections,
              ElementsAre(Pair("frame_not_used", 3), Pair("near_border", 1),
                          Pair("too_few_observations", 2), Pair("without_object_id", 1)));
  ASSERT_EQ(sequence.rejected.size(), 4u);
  const auto of_reason = [&](const std::string& reason) {
    return *std::ranges::find(sequence.rejected, reason, &RejectedDetection::reason);
  };
  const RejectedDetection border = of_reason("near_border");
  EXPECT_EQ(border.frame_index, 1);
  EXPECT_EQ(border.score, 0.7);
  EXPECT_EQ(border.box.x_min, 10.0);
  EXPECT_EQ(border.true_object_id, 1);
  EXPECT_EQ(border.stage, RejectingStage::kImport);
  const RejectedDetection of_no_track = of_reason("without_object_id");
  EXPECT_EQ(of_no_track.label, "sofa");
  EXPECT_FALSE(of_no_track.true_object_id);
}

TEST_F(ImportTest, WhatNobodyMeasuredIsIgnored) {
  std::string& objects = dataset.files["objects.json"];
  objects = R"({"objects": )" + objects + R"(, "ignored": [{"label": "mouse"},
      {"label": "cup", "center": [1, 0, 0], "quaternion_xyzw": [0, 0, 0, 1],
       "half_axes": [1, 2, 3]}]})";
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.true_objects.size(), 1u);
  ASSERT_EQ(sequence.ignored.size(), 2u);
  EXPECT_EQ(sequence.ignored[0].label, "mouse");
  EXPECT_FALSE(sequence.ignored[0].volume_in_world);
  EXPECT_EQ(sequence.ignored[1].volume_in_world->half_axes, Eigen::Vector3d(1, 2, 3));
}

TEST_F(ImportTest, TheWorldOfTheOdometryIsWhatTheSettingsSay) {
  EXPECT_EQ(Import().odometry_world, OdometryWorld::kOfTruth);
  options_.folder.align_odometry = true;
  EXPECT_EQ(Import().odometry_world, OdometryWorld::kOwn);
  options_.folder.odometry_has_own_scale = true;
  EXPECT_EQ(Import().odometry_world, OdometryWorld::kOwnWithScale);
}

TEST_F(ImportTest, NothingUsableSaysWhy) {
  options_.border_px = 150.0;
  ExpectRefused<NothingUsableError>(
      {"no usable detection left; 7 detections rejected: 7 too near the image border"});
  EXPECT_EQ(DescribeRejections({}), "0 detections rejected");
}

TEST(FolderEntriesTest, WhatCannotBeListedIsNamed) {
  const TemporaryFolder folder;
  WriteBytes(folder / "file", "");
  ExpectError<InputError>([&] { FolderEntries(folder / "file"); }, {"file: cannot be listed"});
  ExpectError<InputError>([&] { FolderEntries(folder / "none"); }, {"none: cannot be listed"});
}

bool IsText(const std::filesystem::path& name) { return name.extension() == ".txt"; }

const std::filesystem::path kArchives = SOSLAM_SOURCE_DIR "/tests/fuzz/corpus/box_archives";

TEST(TextArchiveTest, WhatUnpacksToTooMuchIsRefused) {
  for (const char* archive : {"unpacks_to_70_mb.tar.bz2", "unpacks_to_300_mb.tar.gz.gz"}) {
    ExpectError<InputError>([&] { ReadTextArchive(kArchives / archive, &IsText); },
                            {archive, "unpacks to", "expected at most"});
  }
}

using Bounds = std::array<bool, 4>;  // left, top, right, bottom
constexpr Bounds kNone = {false, false, false, false};
constexpr Bounds kBottom = {false, false, false, true};

// Bound edges of the first box, given the others in the same frame.
Bounds BoundsOfFirst(const std::vector<Box>& boxes, double hidden_edge_fraction = 0.7) {
  Sequence sequence = LevelSequence(boxes);
  Detection& first = sequence.detections.front();
  first.is_one_sided = EdgesCutByBorder(first.box, sequence.CameraOf(first));
  ListBoxesInView(sequence, &sequence);
  MarkHiddenEdges(hidden_edge_fraction, &sequence);
  return first.is_one_sided;
}

const Box kBox = {200, 150, 300, 300};

// The image covers [-0.5, 639.5] x [-0.5, 479.5].
TEST(BoundEdgesTest, EdgesAtTheImageBorderAreBounds) {
  EXPECT_EQ(BoundsOfFirst({{4.29, 150, 300, 300}}), (Bounds{true, false, false, false}));
  EXPECT_EQ(BoundsOfFirst({{200, 4.29, 300, 300}}), (Bounds{false, true, false, false}));
  EXPECT_EQ(BoundsOfFirst({{200, 150, 634.71, 300}}), (Bounds{false, false, true, false}));
  EXPECT_EQ(BoundsOfFirst({{200, 150, 300, 474.71}}), kBottom);
  EXPECT_EQ(BoundsOfFirst({{-20, 0, 700, 480}}), (Bounds{true, true, true, true}));
  EXPECT_EQ(BoundsOfFirst({{4.31, 4.31, 100, 100}}), kNone);
  EXPECT_EQ(BoundsOfFirst({{535, 375, 634.69, 474.69}}), kNone);
  // Large boxes err more: 2 % of their width, here 12 px.
  EXPECT_EQ(BoundsOfFirst({{11.4, 150, 620, 300}}), (Bounds{true, false, false, false}));
}

TEST(BoundEdgesTest, ALowerEdgeHiddenByExactlyTheFractionIsABound) {
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 270, 400}}), kBottom);
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 269.99, 400}}), kNone);
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 269.99, 400}}, 0.699), kBottom);
  EXPECT_EQ(BoundsOfFirst({{0.1 + 99.9, 150, 100.3, 300}, {50, 200, 100.21, 400}}), kBottom);
}

TEST(BoundEdgesTest, SeveralBoxesHideTogetherAndOverlapsCountOnce) {
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 240, 400}, {270, 200, 350, 400}}), kBottom);  // 40 + 30
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 200, 240, 400}, {220, 200, 269, 400}}), kNone);    // 69
  EXPECT_EQ(BoundsOfFirst({kBox, {220, 200, 270, 400}, {180, 200, 240, 400}}), kBottom);  // 70
  EXPECT_EQ(BoundsOfFirst({kBox, {210, 200, 275, 400}, {230, 200, 240, 410}}), kNone);    // 65
}

TEST(BoundEdgesTest, ANearerBoxHidesOnlyWhatIsInsideIt) {
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 300, 320, 400}}), kBottom);    // begins at the edge
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 307.5, 320, 400}}), kBottom);  // up to 5 % of the height
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 307.6, 320, 400}}), kNone);    // below
  EXPECT_EQ(BoundsOfFirst({kBox, {300, 200, 400, 400}}), kNone);      // beside
  EXPECT_EQ(BoundsOfFirst({kBox, {180, 100, 320, 300}}), kNone);      // as far
}

TEST(BoundEdgesTest, SidesAndTopInsideNearerBoxesStayMeasured) {
  EXPECT_EQ(BoundsOfFirst({kBox, {280, 100, 400, 400}}), kNone);    // all of the right side
  EXPECT_EQ(BoundsOfFirst({kBox, {150, 100, 400, 400}}), kBottom);  // the whole box
}

}  // namespace
}  // namespace soslam
