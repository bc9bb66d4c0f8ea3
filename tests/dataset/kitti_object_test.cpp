// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "base/error.h"
#include "dataset/dataset_content.h"
#include "dataset/kitti_label.h"
#include "support/expect_error.h"
#include "support/kitti_fixture.h"
#include "support/labelled_boxes.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

class KittiObjectTest : public testing::Test {
 protected:
  KittiObjectTest() {
    options.format = DatasetFormat::kKittiObject;
    options.border_px = 0.0;
    options.min_observations = 1;
    for (const char* folder_name : {"label_2", "calib", "image_2"}) {
      std::filesystem::create_directories(folder / folder_name);
    }
    Write("calib/000003.txt", KittiCalibrationText());
    Write("calib/000011.txt", KittiCalibrationText());
    Write("label_2/000003.txt", KittiBox{2, 1.6, 12, 0.5}.Columns() + kKittiDontCare +
                                    KittiBox{-3, 1.6, 15, 0.1}.Columns("Car", "0.40", 1));
    Write("label_2/000011.txt", KittiBox{7, 1.6, 11, 0.5}.Columns());
    cv::imwrite((folder / "image_2/000011.png").string(),
                cv::Mat(360, 1100, CV_8UC1, cv::Scalar(90)));
  }
  void Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name, std::ios::binary) << text;
  }
  Sequence Import() const { return ImportDataset(folder, options); }

  ImportOptions options;
  std::filesystem::path folder = FreshTestFolder() / "kitti_object";
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
  ASSERT_EQ(sequence.objects.size(), 3u);
  EXPECT_EQ(sequence.objects[0].id, 3000);
  EXPECT_EQ(sequence.objects[1].id, 3001);
  EXPECT_EQ(sequence.objects[2].id, 11000);
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
  EXPECT_EQ(cut.is_bound, (std::array<bool, 4>{false, false, true, false}));
}

TEST_F(KittiObjectTest, TruncationIsAShare) {
  ImportOptions whole = options;
  whole.max_truncation = 0.39;
  const Sequence sequence = ImportDataset(folder, whole);
  EXPECT_EQ(sequence.detections.size(), 2u);
  EXPECT_EQ(sequence.rejected_detections.at("truncated"), 1);
}

TEST_F(KittiObjectTest, AFrameWithoutLabelsIsAFrame) {
  Write("label_2/000005.txt", "");
  Write("calib/000005.txt", KittiCalibrationText());
  EXPECT_EQ(Import().frames.size(), 3u);
}

TEST_F(KittiObjectTest, BadInputIsRefused) {
  Write("label_2/000011.txt", "Car\n");
  ExpectError<InputError>([&] { Import(); }, {"label_2/000011.txt:1", "1 values"});
  Write("label_2/000011.txt", KittiBox().Columns());
  std::filesystem::remove(folder / "calib/000011.txt");
  ExpectError<InputError>([&] { Import(); }, {"calib/000011.txt", "missing"});
  std::filesystem::remove_all(folder / "label_2");
  ExpectError<InputError>([&] { Import(); }, {"label_2", "no files"});
}

class KittiBoxesTest : public testing::Test {
 protected:
  KittiBoxesTest() { std::filesystem::create_directory(folder_ / "Car"); }
  std::vector<LabelledBox> Read(const std::string& text) {
    WriteBytes(folder_ / "Car/0000.txt", text);
    return ReadKittiBoxes(folder_ / "Car/0000.txt");
  }
  TemporaryFolder folder_;
};

TEST_F(KittiBoxesTest, BadLinesAreNamed) {
  const BadTexts cases = {{"1,2,3,4,5", {"has 5 fields", "frame,x1,y1,x2,y2,score"}},
                          {"1 2 3 4 5 6", {"has 1 fields"}},
                          {"1.5,1,2,3,4,1", {"frame is '1.5'"}},
                          {"-1,1,2,3,4,1", {"frame is -1"}},
                          {"1,1,2,inf,4,1", {"x2 is 'inf'"}},
                          {"1,1,2,3,4,", {"score is ''"}},
                          {"1,10,2,3,4,1", {"box is 10 2 3 4", "x1 <= x2"}}};
  ExpectBadTexts(cases, "Car/0000.txt:2",
                 [&](const std::string& line) { Read("0,1,2,3,4,1\r\n" + line + "\r\n"); });
}

using testing::ElementsAre;
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
