// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/kitti_label.h"
#include "support/image_files.h"
#include "support/imported_folder.h"
#include "support/kitti_fixture.h"
#include "support/lists.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::Pair;

class KittiTrackingTest : public ImportedFolderTest {
 protected:
  KittiTrackingTest() {
    options_.format = DatasetFormat::kKittiTracking;
    options_.border_px = 0.0;
    options_.min_observations = 1;
    options_.kitti.translation_scale = "0.5";
    options_.kitti.static_min_views = KittiTrackingFixture::kFrames;
    options_.kitti.static_radius_m = 0.1;
  }

  Sequence Import() override {
    for (const auto& [name, text] : fixture.files) Write(name, text);
    return ImportedFolderTest::Import();
  }
  void ExpectRefusedWith(const std::string& file, const std::string& text,
                         const std::vector<std::string>& words) {
    const std::string before = fixture.files[file];
    fixture.files[file] = text;
    ExpectRefused(words);
    fixture.files[file] = before;
  }

  KittiTrackingFixture fixture;
};

TEST_F(KittiTrackingTest, EachRecordingIsASegment) {
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.name, folder_.path().filename());
  EXPECT_EQ(sequence.camera.width, 1242);
  EXPECT_EQ(sequence.camera.height, 375);
  EXPECT_EQ(sequence.camera.fx, kKittiFocal);
  ASSERT_EQ(sequence.frames.size(), 8u);
  EXPECT_EQ(sequence.frames[2].id, 30002);
  EXPECT_EQ(sequence.frames[2].segment, 3);
  EXPECT_EQ(sequence.frames[2].timestamp, 0.2);
  EXPECT_EQ(sequence.frames[2].world_from_camera.translation, Eigen::Vector3d(0, 0, 2));
  EXPECT_FALSE(sequence.frames[2].true_world_from_camera);
  EXPECT_TRUE(sequence.frames[2].image.empty());
  EXPECT_EQ(sequence.frames[4].id, 70000);
  EXPECT_EQ(sequence.frames[4].segment, 7);
  EXPECT_FALSE(sequence.frames[4].camera);
}

TEST_F(KittiTrackingTest, ObjectsKnowWhetherTheyStand) {
  const Sequence sequence = Import();
  const auto plane_id = [&](const Object& object) {
    return sequence.planes[object.plane_index].id;
  };
  ASSERT_THAT(Fields(sequence.objects, &Object::id), ElementsAre(30000, 30001, 30002, 70000));
  EXPECT_EQ(Fields(sequence.objects, plane_id), Fields(sequence.objects, &Object::id));
  EXPECT_THAT(Fields(sequence.objects, &Object::label),
              ElementsAre("car", "car", "pedestrian", "van"));
  EXPECT_THAT(Fields(sequence.objects, &Object::is_static), ElementsAre(true, false, false, true));
  // The parked car's bottom face: 1.6 m below camera 0, which is 0.02 m above camera 2.
  const Landmark& truth = sequence.objects[0].ground_truth->landmark_in_world;
  EXPECT_LT((truth.Centre() - Eigen::Vector3d(3.1, 1.6 - 0.02 - 0.75, 14.01)).norm(), 1e-9);
  const Plane& plane = sequence.planes[0].plane_in_world;
  EXPECT_NEAR(plane.SignedDistance(Eigen::Vector3d(5, 1.58, 5)), 0.0, 1e-9);
  EXPECT_GT(plane.SignedDistance(truth.Centre()), 0.0);
}

TEST_F(KittiTrackingTest, DetectionsAreTheLabelsWithTheTruthOfTheirFrame) {
  const Sequence sequence = Import();
  ASSERT_EQ(sequence.detections.size(), 13u);
  EXPECT_TRUE(sequence.rejected_detections.empty());
  const Detection& driving = sequence.detections[4];  // after three objects of frame 0
  EXPECT_EQ(sequence.FrameOf(driving).id, 30001);
  EXPECT_EQ(sequence.ObjectOf(driving).id, 30001);
  const KittiBox box = KittiTrackingFixture::Driving(1);
  EXPECT_NEAR(driving.box.x_min, box.Image().x_min, 1e-3);
  EXPECT_LT((driving.true_landmark_in_camera->Centre() -
             (Eigen::Vector3d(box.x, box.y - 0.75, box.z) + kCamera2FromCamera0))
                .norm(),
            1e-9);
  EXPECT_NEAR(driving.plane_in_camera.offset, 1.7 - 0.02, 1e-9);
}

TEST_F(KittiTrackingTest, WhatIsTrueDoesNotDependOnWhatIsDetected) {
  const Sequence all = Import();
  EXPECT_EQ(all.true_objects.size(), all.objects.size());
  EXPECT_EQ(all.true_objects.back().segment, 7);
  EXPECT_EQ(all.truth_in_frames.size(), all.detections.size());  // a label each
  for (const Detection& detection : all.detections) {
    EXPECT_EQ(detection.true_object_id, all.ObjectOf(detection).id);
  }
  options_.max_occlusion = 0;
  options_.labels = "car, van";
  const Sequence some = Import();
  EXPECT_EQ(some.truth_in_frames.size(), all.truth_in_frames.size());
  const RejectedDetection rejected = Only(some.rejected);
  EXPECT_EQ(rejected.reason, "other_label");
  EXPECT_TRUE(rejected.true_object_id);
  for (const TrueObject& object : some.true_objects) {
    EXPECT_EQ(object.is_ignored, object.label != "car" && object.label != "van");
  }
  EXPECT_TRUE(std::ranges::any_of(some.true_objects, &TrueObject::is_ignored));
  EXPECT_FALSE(std::ranges::any_of(all.true_objects, &TrueObject::is_ignored));
}

TEST_F(KittiTrackingTest, SomeRecordingsOnly) {
  options_.kitti.sequences = "0005-0009";
  EXPECT_EQ(Import().frames.size(), 4u);
  options_.kitti.sequences = " 0003-0007";
  EXPECT_EQ(Import().frames.size(), 8u);
  options_.kitti.sequences = "0003  0003-0006 ";
  EXPECT_EQ(Import().frames.size(), 4u);
  options_.kitti.sequences = "0004";
  ExpectRefused<SettingsError>({"sequences", "0004"});
}

TEST_F(KittiTrackingTest, FiltersAreCountedByReason) {
  options_.max_occlusion = 0;
  EXPECT_THAT(Import().rejected_detections, ElementsAre(Pair("occluded", 1)));
  // What is parked comes nearer: 84, 91, 100 and 111 px high.
  options_.min_box_height_px = 95.0;
  EXPECT_EQ(Import().rejected_detections.at("low_box"), 4);
}

TEST_F(KittiTrackingTest, ADetectorsBoxesTakeTheObjectsOfTheLabels) {
  const Box parked = KittiTrackingFixture::Parked(2).Image();
  const auto row = [](int frame, double x1, double y1, double x2, double y2, double score) {
    return fmt::format("{},{},{},{},{},{}\r\n", frame, x1, y1, x2, y2, score);
  };
  fixture.files["rrc/Car/0003.txt"] =
      row(2, parked.x_min + 1, parked.y_min, parked.x_max, parked.y_max + 2, 0.75) +
      row(2, parked.x_min - 9, parked.y_min, parked.x_max, parked.y_max, 0.5) +  // the same again
      row(1, 10, 10, 60, 60, 0.9);                                               // nothing there
  // Where the van is, and no car.
  fixture.files["rrc/Car/0007.txt"] =
      row(2, parked.x_min, parked.y_min, parked.x_max, parked.y_max, 1);
  options_.detections = "rrc";
  const Sequence sequence = Import();
  const Detection detection = Only(sequence.detections);
  EXPECT_EQ(sequence.FrameOf(detection).id, 30002);
  EXPECT_EQ(sequence.ObjectOf(detection).id, 30000);
  EXPECT_EQ(detection.score, 0.75);
  EXPECT_NEAR(detection.box.y_max, parked.y_max + 2, 1e-3);
  EXPECT_NEAR(detection.true_landmark_in_camera->Centre().z(), 12.01, 1e-9);
  EXPECT_THAT(sequence.rejected_detections, ElementsAre(Pair("matches_no_label", 3)));
  ASSERT_EQ(sequence.rejected.size(), 3u);
  EXPECT_EQ(sequence.rejected[0].label, "car");
  EXPECT_EQ(sequence.frames[sequence.rejected[0].frame_index].id, 30001);

  fixture.files["rrc/Car/0007.txt"] = "0,1,2,3\n";
  ExpectRefused({"Car/0007.txt:1", "4 fields"});
  std::filesystem::remove_all(folder_ / "rrc/Car");
  fixture.files.erase("rrc/Car/0007.txt");
  ExpectRefused({"Car/0007.txt", "missing"});
  options_.detections = "yolo";
  ExpectRefused({"yolo", "folder"});
}

TEST_F(KittiTrackingTest, ImagesAreNamedWhereTheyAre) {
  const std::string image = EncodedImage(".png", cv::Mat(360, 1200, CV_8UC1, cv::Scalar(90)));
  Write("image_02/0007/000001.png", image);
  Write("image_02/0007/000003.png", image);
  const Sequence all = Import();
  EXPECT_EQ(all.frames.size(), 8u);
  EXPECT_EQ(all.frames[5].image, "image_02/0007/000001.png");
  EXPECT_EQ(all.frames[6].image, "");
  EXPECT_EQ(all.camera.width, 1242);
  EXPECT_EQ(all.CameraOf(all.frames[5]).width, 1200);
  EXPECT_EQ(all.CameraOf(all.frames[6]).height, 360);
  EXPECT_EQ(all.CameraOf(all.frames[6]).fx, kKittiFocal);
  options_.images_only = true;
  const Sequence some = Import();
  EXPECT_EQ(some.frames.size(), 2u);
  EXPECT_EQ(some.detections.size(), 2u);
  EXPECT_EQ(some.rejected_detections.at("frame_without_image"), 11);
}

TEST_F(KittiTrackingTest, BadInputIsRefused) {
  ExpectRefusedWith("label_02/0003.txt", "4 0 " + KittiBox().Columns(),
                    {"label_02/0003.txt:1", "frame is 4", "0 to 3"});
  ExpectRefusedWith("label_02/0003.txt", "0 -1 " + KittiBox().Columns(), {"track is -1"});
  ExpectRefusedWith("label_02/0003.txt", "0 10000 " + KittiBox().Columns(), {"track is 10000"});
  ExpectRefusedWith("label_02/0003.txt",
                    "0 5 " + KittiBox().Columns() + "1 5 " + KittiBox().Columns("Van"),
                    {"label_02/0003.txt:2", "track 5", "Van", "Car"});
  ExpectRefusedWith(
      "label_02/0003.txt",
      "1 5 " + KittiBox().Columns() + "0 5 " + KittiBox().Columns() + "1 5 " + KittiBox().Columns(),
      {"label_02/0003.txt:3", "track 5 again in frame 1"});
  ExpectRefusedWith("label_02/0003.txt", KittiBox().Columns(), {"15 values", "frame track"});
  ExpectRefusedWith("poses/0007.txt", "", {"poses/0007.txt", "no pose"});
  ExpectRefusedWith("calib/0007.txt", "", {"calib/0007.txt", "P2"});
  options_.kitti.translation_scale = "0003:1";
  ExpectRefused<SettingsError>({"translation_scale", "0007"});
  options_.kitti.translation_scale = "1";
  options_.kitti.poses = "no_poses";
  ExpectRefused({"no_poses/0003.txt", "missing"});
  ExpectError<InputError>([&] { ImportDataset(folder_ / "calib", options_); }, {"label_02"});
}

class KittiObjectTest : public ImportedFolderTest {
 protected:
  KittiObjectTest() {
    options_.format = DatasetFormat::kKittiObject;
    options_.border_px = 0.0;
    options_.min_observations = 1;
    Write("calib/000003.txt", KittiCalibrationText());
    Write("calib/000011.txt", KittiCalibrationText());
    Write("label_2/000003.txt", KittiBox{2, 1.6, 12, 0.5}.Columns() + kKittiDontCare +
                                    KittiBox{-3, 1.6, 15, 0.1}.Columns("Car", "0.40", 1));
    Write("label_2/000011.txt", KittiBox{7, 1.6, 11, 0.5}.Columns());
    Write("image_2/000011.png", EncodedImage(".png", cv::Mat(360, 1100, CV_8UC1, cv::Scalar(90))));
  }
};

TEST_F(KittiObjectTest, EachFrameIsASegment) {
  const Sequence sequence = Import();
  ASSERT_EQ(sequence.frames.size(), 2u);
  EXPECT_EQ(sequence.frames[1].id, 11);
  EXPECT_EQ(sequence.frames[1].segment, 11);
  EXPECT_EQ(sequence.frames[1].image, "image_2/000011.png");
  EXPECT_EQ(sequence.frames[0].image, "");
  EXPECT_EQ(sequence.frames[0].world_from_camera.Matrix(), Eigen::Matrix4d::Identity());
  EXPECT_EQ(sequence.CameraOf(sequence.frames[0]).width, 1242);  // option image_size
  EXPECT_EQ(sequence.CameraOf(sequence.frames[1]).width, 1100);
}

TEST_F(KittiObjectTest, EachLabelIsAnObjectOfItsOwn) {
  const Sequence sequence = Import();
  EXPECT_THAT(Fields(sequence.objects, &Object::id), ElementsAre(3000, 3001, 11000));
  ASSERT_EQ(sequence.detections.size(), 3u);
  for (const Detection& detection : sequence.detections) {
    const Landmark& truth = sequence.ObjectOf(detection).ground_truth->landmark_in_world;
    EXPECT_EQ(detection.true_landmark_in_camera->Centre(), truth.Centre());
    EXPECT_NEAR(detection.plane_in_camera.SignedDistance(truth.Centre()), 0.75, 1e-9);
  }
}

TEST_F(KittiObjectTest, BoxesEndWhereACroppedImageDoes) {
  const Sequence sequence = Import();
  const Detection& cut = sequence.detections[2];
  ASSERT_GT((KittiBox{7, 1.6, 11, 0.5}.Image().x_max), 1100.0);
  EXPECT_EQ(cut.box.x_max, 1099.5);
  EXPECT_EQ(cut.is_one_sided, (std::array<bool, 4>{false, false, true, false}));
}

TEST_F(KittiObjectTest, TruncationIsAShare) {
  options_.max_truncation = 0.39;
  const Sequence sequence = Import();
  EXPECT_EQ(sequence.detections.size(), 2u);
  EXPECT_EQ(sequence.rejected_detections.at("truncated"), 1);
}

TEST_F(KittiObjectTest, AFrameWithoutLabelsIsAFrame) {
  Write("label_2/000005.txt", "");
  Write("calib/000005.txt", KittiCalibrationText());
  EXPECT_EQ(Import().frames.size(), 3u);
}

TEST(KittiBoxesTest, BadLinesAreNamed) {
  const TemporaryFolder folder_;
  const BadTexts cases = {{"1,2,3,4,5", {"has 5 fields", "frame,x1,y1,x2,y2,score"}},
                          {"1 2 3 4 5 6", {"has 1 fields"}},
                          {"1.5,1,2,3,4,1", {"frame is '1.5'"}},
                          {"-1,1,2,3,4,1", {"frame is -1"}},
                          {"1,1,2,inf,4,1", {"x2 is 'inf'"}},
                          {"1,1,2,3,4,", {"score is ''"}},
                          {"1,10,2,3,4,1", {"box is 10 2 3 4", "x1 <= x2"}}};
  ExpectBadTexts(cases, "0000.txt:2", [&](const std::string& line) {
    ReadKittiBoxes(WriteBytes(folder_ / "0000.txt", "0,1,2,3,4,1\r\n" + line + "\r\n"));
  });
}

using testing::Optional;

constexpr Box kUnit{0, 0, 10, 10};

Box Shifted(double x) { return {x, 0, 10 + x, 10}; }

LabelledBox Found(const Box& box, double score) { return {"", 0, "car", score, box}; }

TEST(MatchBoxes, TakesTheLargestOverlap) {
  EXPECT_THAT(MatchBoxes({Found(kUnit, 0.5)}, {Shifted(4), Shifted(1), Shifted(2)}, 0.1),
              ElementsAre(Optional(1)));
}

TEST(MatchBoxes, TheHighestScoreChoosesFirst) {
  EXPECT_THAT(
      MatchBoxes({Found(Shifted(2), 0.4), Found(Shifted(1), 0.9)}, {kUnit, Shifted(6)}, 0.1),
      ElementsAre(Optional(1), Optional(0)));
}

TEST(MatchBoxes, IsOneToOneWithAMinimum) {
  EXPECT_THAT(MatchBoxes({Found(kUnit, 0.9), Found(kUnit, 0.8)}, {kUnit}, 0.5),
              ElementsAre(Optional(0), std::nullopt));
  EXPECT_THAT(MatchBoxes({Found(Shifted(5), 0.9)}, {kUnit}, 0.34), ElementsAre(std::nullopt));
  EXPECT_THAT(MatchBoxes({Found(Shifted(5), 0.9)}, {kUnit}, 0.33), ElementsAre(Optional(0)));
  EXPECT_THAT(MatchBoxes({Found(kUnit, 0.9)}, {}, 0.5), ElementsAre(std::nullopt));
}

}  // namespace
}  // namespace soslam
