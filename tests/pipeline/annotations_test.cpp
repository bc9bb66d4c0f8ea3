// SPDX-License-Identifier: BSD-3-Clause
// What the project has to say of datasets of others: the table of downloads, and what is made of
// them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "soslam/system/hash.h"
#include "support/folder_test.h"
#include "support/run_command.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::Contains;

const fs::path kAnnotations = SOSLAM_SOURCE_DIR "/data/annotations";

std::vector<std::string> Lines(const fs::path& path) {
  std::vector<std::string> lines;
  std::istringstream text(FileBytes(path));
  for (std::string line; std::getline(text, line);) {
    if (!line.empty() && line[0] != '#') lines.push_back(line);
  }
  return lines;
}

// Files that two datasets share are listed with their present bytes.
TEST(AnnotationsTest, AllOfFr2DeskHasTheFilesOfItsImages) {
  const std::vector<std::string> sums = Lines(kAnnotations / "fr2_desk_all/SHA256SUMS");
  for (const char* file : {"camera.json", "objects.json", "planes.json"}) {
    EXPECT_THAT(sums, Contains(Sha256OfFile(kAnnotations / "fr2_desk_11" / file) + "  " + file));
  }
}

// prepare.sh of a dataset on downloads that the test makes.
class PrepareTest : public FolderTest {
 protected:
  void Prepare(const std::string& name, const fs::path& own) const {
    ExpectSuccess(RunCommand({"env", "-C", folder_.path().string(), "bash", "-euo", "pipefail",
                              (kAnnotations / name / "prepare.sh").string(), own.string()}));
  }
};

// OpenCV's encoder is an independent witness.
TEST_F(PrepareTest, ImagesAreJpegOfQuality92) {
  cv::Mat image(48, 64, CV_8UC3);
  cv::theRNG().state = 1;
  cv::randu(image, 0, 256);
  fs::create_directory(folder_ / "png");
  cv::imwrite((folder_ / "png/1.5.png").string(), image);
  cv::imwrite((folder_ / "expected.jpg").string(), image, {cv::IMWRITE_JPEG_QUALITY, 92});
  Write("own/rgb.txt", "# timestamp filename\n1.5 rgb/1.5.jpg\n");
  Prepare("fr1_rpy", folder_ / "own");
  EXPECT_TRUE(FileBytes(folder_ / "rgb/1.5.jpg") == FileBytes(folder_ / "expected.jpg"));
}

TEST_F(PrepareTest, BoxesOfImagesBecomeATable) {
  Write("rgb.txt", "1.5 rgb/1.5.jpg\n2.5 rgb/2.5.jpg\n3.5 rgb/3.5.jpg\n");
  Write("bbox/1.5.txt", "0 10 20 30 40 28 0.42 0\n");
  Write("bbox/3.5.txt", "0 11 21 31 41 28 0.9 0\n");
  Prepare("fr3_cabinet", folder_.path());
  EXPECT_EQ(FileBytes(folder_ / "detections.csv"),
            "frame,object_id,label,score,x1,y1,x2,y2\n"
            "0,0,cabinet,0.42,10,20,30,40\n"
            "2,0,cabinet,0.9,11,21,31,41\n");
}

TEST_F(PrepareTest, BoxesGetTheIdsOfTheirObjectsAndPosesTheirDifferences) {
  Write("detections_yolov5.json",
        R"([{"file_name": "1.5.png", "detections": [)"
        R"({"category_id": 7, "detection_score": 0.34721, "bbox": [1.0, 2.0, 3.5, 4.0]}, )"
        R"({"category_id": 8, "detection_score": 0.5, "bbox": [5.0, 6.0, 7.0, 8.0]}]}, )"
        R"({"file_name": "9.5.png", "detections": [)"
        R"({"category_id": 7, "detection_score": 0.6, "bbox": [0.0, 0.0, 1.0, 1.0]}]}, )"
        R"({"file_name": "2.5.png", "detections": []}, {"file_name": "3.5.png", "detections": [)"
        R"({"category_id": 7, "detection_score": 0.7, "bbox": [9.0, 10.0, 11.0, 12.0]}]}])");
  Write("own/rgb.txt", "# timestamp filename\n1.5 rgb/1.5.png\n2.5 rgb/2.5.png\n3.5 rgb/3.5.png\n");
  Write("own/ids.csv", "frame,detection,object_id,label\n0,1,12,tape roll\n2,0,3,cup\n");
  Write("odometry.txt", "1.5 1 2 3 0 0 0 1\n1.7 9 9 9 0 0 0 1\n3.5 1.25 -2 3 0 0 0 1\n");
  Write("own/groundtruth_from_odometry.txt",
        "# differences\n1.5 0.5 0 -1 0 0.125 0 0\n3.5 0 0 0 0 0 0 -0.5\n");
  Prepare("fr2_desk_11", folder_ / "own");
  EXPECT_EQ(FileBytes(folder_ / "groundtruth.txt"),
            "# timestamp tx ty tz qx qy qz qw   (T_world_camera, metres; see README)\n"
            "1.5 1.500000 2.000000 2.000000 0.000000 0.125000 0.000000 1.000000\n"
            "3.5 1.250000 -2.000000 3.000000 0.000000 0.000000 0.000000 0.500000\n");
  EXPECT_EQ(FileBytes(folder_ / "detections.csv"),
            "frame,object_id,label,score,x1,y1,x2,y2\n"
            "0,12,tape roll,0.500,5.0,6.0,7.0,8.0\n"
            "2,3,cup,0.700,9.0,10.0,11.0,12.0\n");
}

TEST_F(PrepareTest, ATrajectoryAndACameraForEachSequence) {
  Write("poses_orbslam3_stereo/0003/CameraTrajectory.txt", "1 0 0\n");
  Write("calib/0003.txt", "P0: 1 2 \nP2: 3  4 \nR_rect 5 \n");
  Prepare("kitti_tracking", folder_.path());
  EXPECT_EQ(FileBytes(folder_ / "poses_orbslam3_stereo/0003.txt"), "1 0 0\n");
  EXPECT_EQ(FileBytes(folder_ / "calib/0003.txt"), "P2: 3 4\n");
}

}  // namespace
}  // namespace soslam
