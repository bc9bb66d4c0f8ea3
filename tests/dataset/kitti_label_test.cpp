// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/kitti_label.h"

#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/kitti_fixture.h"
#include "support/random.h"

namespace soslam {
namespace {

TEST(ParseRecordings, RefusesAnythingElse) {
  for (const char* text : {"one", "1-", "-1", "5-3", "1,2", "99999999999"}) {
    ExpectError<SettingsError>([&] { ParseRecordings("sequences", text); }, {"sequences"});
  }
}

TEST(RecordingValues, AreThoseOfTheirRecordings) {
  const RecordingValues values("scale", "0000-0013:0.969 0020:0.988");
  EXPECT_EQ(values.PositiveOf(0), 0.969);
  EXPECT_EQ(values.PositiveOf(13), 0.969);
  EXPECT_EQ(values.Of(20), "0.988");
  ExpectError<SettingsError>([&] { values.Of(14); }, {"scale", "0014"});
}

TEST(RecordingValues, RefusesWhatIsNoValue) {
  EXPECT_EQ(RecordingValues("scale", "0.5").PositiveOf(77), 0.5);  // one for all
  for (const char* text : {"0.5 0.6", "a:0.6", "0", "-1", "much", "0001:"}) {
    ExpectError<SettingsError>([&] { RecordingValues("scale", text).PositiveOf(1); }, {"scale"});
  }
}

class KittiLabelTest : public FolderTest {
 protected:
  KittiLabel Read(const std::string& columns) {
    return ReadKittiLabels(Write("000000.txt", columns), false).at(0);
  }
  KittiCalibration ReadCalibration(const std::string& text = KittiCalibrationText()) {
    return ReadKittiCalibration(Write("calib.txt", text));
  }
  void ExpectRefused(const std::string& columns, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { Read(columns); }, words);
  }
};

TEST_F(KittiLabelTest, BadCalibrationsAreRefused) {
  ExpectBadTexts({{"P0: 1 0 0 0 0 1 0 0 0 0 1 0\n", {"no line P2"}},
                  {"P2: 1 0 0 0 0 1 0 0 0 0 1\n", {":1", "11 numbers", "12"}},
                  {"P2: 1 0 0 0 0 1 0 0 0 0 x 0\n", {":1", "number 11", "x"}},
                  {"P2: 1 0.1 0 0 0 1 0 0 0 0 1 0\n", {":1", "rectified"}},
                  {"P2: -1 0 0 0 0 1 0 0 0 0 1 0\n", {":1", "rectified"}}},
                 "calib.txt", [&](const std::string& text) { ReadCalibration(text); });
}

TEST_F(KittiLabelTest, ResultsHaveAScore) {
  std::string columns = KittiBox{1, 1.5, 12, 0.3, 1.5, 1.6, 3.9}.Columns();
  EXPECT_EQ(Read(columns).score, 1.0);
  columns.pop_back();  // the end of the line
  EXPECT_EQ(Read(columns + " 0.25").score, 0.25);
  ExpectRefused(columns + " high", {"000000.txt:1", "score is 'high'"});
  ExpectRefused(columns + " 0.25 1", {"17 values", "[score]"});
  Write("0001.txt", "4 7 " + columns + " 0.5\n");
  EXPECT_EQ(ReadKittiLabels(folder_ / "0001.txt", true).at(0).score, 0.5);
}

// The corners of the landmark, projected with the camera, are those of KITTI's own formulas with
// P2.
TEST_F(KittiLabelTest, LandmarksProjectAsKittiSays) {
  const KittiCalibration calibration = ReadCalibration();
  for (int trial = 0; trial < 50; ++trial) {
    const KittiBox box{RandomUniform(-8, 8),     RandomUniform(1, 2), RandomUniform(8, 40),
                       RandomUniform(-3.1, 3.1), RandomUniform(1, 2), RandomUniform(1, 2),
                       RandomUniform(2, 5)};
    const Landmark landmark = LandmarkInCamera(Read(box.Columns()), calibration);
    for (const Eigen::Vector3d& corner : box.Corners()) {
      const Eigen::Vector2d expected = (KittiP2() * corner.homogeneous()).hnormalized();
      double nearest = 1e9;
      for (int i = 0; i < 8; ++i) {
        const Eigen::Vector3d in_object(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        const auto pixel = calibration.camera.Project(landmark.frame_from_object *
                                                      in_object.cwiseProduct(landmark.half_axes));
        nearest = std::min(nearest, (*pixel - expected).norm());
      }
      EXPECT_LT(nearest, 1e-2);  // what six digits of a label leave
    }
    EXPECT_EQ(landmark.half_axes, 0.5 * Eigen::Vector3d(box.length, box.width, box.height));
    const Eigen::Vector3d up = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
    EXPECT_LT((up + Eigen::Vector3d::UnitY()).norm(), 1e-12);
  }
}

TEST_F(KittiLabelTest, BadLabelsAreRefused) {
  ExpectRefused("Car 0 0\n", {"000000.txt:1", "3 values", "rotation_y"});
  ExpectRefused("Car 0 0.5 0 1 2 3 4 1 1 1 1 1 1 0\n", {"occluded", "0.5", "integer"});
  ExpectRefused("Car 0 0 0 1 2 nan 4 1 1 1 1 1 1 0\n", {"right", "nan"});
  ExpectRefused("Car 0 0 0 1 2 3 4 1 0 1 1 1 1 0\n", {"size is 1 0 1", "above 0"});
  ExpectRefused("0 0 Car 0 0 0 1 2 3 4 1 1 1 1 1 1 0\n", {"17 values"});
}

TEST_F(KittiLabelTest, FilesAreNumbered) {
  Write("0010.txt", "");
  Write("0002.txt", "");
  Write("notes.md", "");
  const auto files = NumberedFiles(folder_.path(), ".txt");
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].number, 2);
  EXPECT_EQ(files[1].path.filename(), "0010.txt");
  Write("readme.txt", "");
  ExpectError<InputError>([&] { NumberedFiles(folder_.path(), ".txt"); }, {"readme"});
  ExpectError<InputError>([&] { NumberedFiles(folder_ / "absent", ".txt"); }, {"absent", ".txt"});
}

TEST_F(KittiLabelTest, BadImageSizesAreRefused) {
  for (const char* size : {"1242", "1242x", "x375", "0x375", "1242x-5", "widexhigh"}) {
    ExpectError<SettingsError>(
        [&] {
          WithImageSize({}, std::nullopt, ImageOrientation::kUpright,
                        RecordingValues("image_size", size), 0);
        },
        {"image_size", size});
  }
}

}  // namespace
}  // namespace soslam
