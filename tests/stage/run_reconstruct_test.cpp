// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/dataset/dataset_json.h"
#include "soslam/dataset/reconstruct_options.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/stage/stages.h"
#include "support/drawn_photos.h"
#include "support/expect_error.h"
#include "support/fake_colmap.h"
#include "support/folder_test.h"
#include "support/image_files.h"
#include "support/lists.h"
#include "support/printed.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// Three images, of cameras side by side that look along z.
class RunReconstructTest : public FolderTest {
 protected:
  RunReconstructTest() : path_(std::getenv("PATH")) {
    for (const char* name : {"bin", "nothing"}) fs::create_directories(folder_ / name);
    for (int i = 0; i < 3; ++i) {
      Write(fmt::format("data/rgb/{}.png", i),
            EncodedImage(".png", cv::Mat(48, 64, CV_8UC3, cv::Scalar(0, 0, 51 * i))));
    }
    Write("data/rgb.txt", "0 rgb/0.png\n0.5 rgb/1.png\n1 rgb/2.png\n");
    WriteFakeColmap(folder_ / "bin");
    WriteModel("0", 3);
    setenv("PATH", ((folder_ / "bin").string() + ":" + path_).c_str(), 1);
  }
  ~RunReconstructTest() override { setenv("PATH", path_.c_str(), 1); }

  fs::path Dataset() const { return folder_ / "data"; }
  fs::path Output(const std::string& file) const { return folder_ / "out" / file; }
  void Prints(const std::string& line) const { Write("bin/printed", line + "\n"); }

  std::string camera_ = "SIMPLE_RADIAL 64 48 50 32 24 0.01";  // of the models
  // A model of so many images with one point (1, 0, 5).
  void WriteModel(const std::string& name, int images, const char* models = "models") const {
    const std::string model = fmt::format("bin/{}/{}", models, name);
    std::string lines, track;
    for (int i = 0; i < images; ++i) {
      lines += fmt::format("{} 1 0 0 0 {} 0 0 1 rgb/{}.png\n{} 24.5 1\n", i + 1, -i, i, 10 + i);
      track += fmt::format(" {} 0", i + 1);
    }
    Write(model + "/cameras.txt", "1 " + camera_ + "\n");
    Write(model + "/images.txt", lines);
    Write(model + "/points3D.txt", "1 1 0 5 0 0 0 0.25" + track + "\n");
  }
  // A model in the output folder itself: COLMAP writes so what it triangulates.
  void WriteModelWithoutNumber() const {
    WriteModel("", 3);
    fs::remove_all(folder_ / "bin/models/0");
  }

  void Run(const std::string& output = "out", const std::string& model = "") {
    StageFiles files = {{"dataset", Dataset()}, {"output", folder_ / output}};
    if (!model.empty()) files["model"] = folder_ / model;
    printed_ = PrintedBy([&] { RunReconstruct(options_, files, 2); });
  }
  // Returns the calls of COLMAP since the last time.
  std::string Calls() const {
    if (!fs::exists(folder_ / "bin/calls")) return "";
    const std::string calls = FileBytes(folder_ / "bin/calls");
    fs::remove(folder_ / "bin/calls");
    return calls;
  }
  template <typename ErrorType>
  void ExpectFailure(const std::vector<std::string>& words) {
    ExpectError<ErrorType>([&] { Run(); }, words);
    EXPECT_FALSE(fs::exists(Output("reconstruction.json")));
  }

  std::string path_;
  ReconstructOptions options_;
  Printed printed_;
};

TEST_F(RunReconstructTest, WritesADatasetFolder) {
  Run();
  EXPECT_THAT(printed_.output,
              HasSubstr("registered 3 of 3 images, 1 points, median reprojection error "
                        "0.25 px, median triangulation angle 22.62 degrees\n"));
  EXPECT_EQ(printed_.errors, "");
  const LensCamera camera = ReadCamera(Output("camera.json"));
  EXPECT_EQ(camera.camera, (Camera{64, 48, 50, 50, 31.5, 23.5}));
  EXPECT_EQ(camera.distortion, Distortion{0.01});
  const auto poses = ReadTrajectory(Output("odometry.txt"));
  ASSERT_EQ(poses.size(), 3u);
  EXPECT_EQ(poses[1].timestamp, 0.5);
  EXPECT_EQ(poses[2].world_from_camera.translation, Eigen::Vector3d(2, 0, 0));
  const MapPoint point = Only(ReadPoints(Output("points.h5")));
  EXPECT_EQ(point.position_in_world, Eigen::Vector3d(1, 0, 5));
  ASSERT_EQ(point.observations.size(), 3u);
  EXPECT_EQ(point.observations[2].frame_id, 2);
  EXPECT_EQ(point.observations[2].pixel, Eigen::Vector2d(11.5, 24.0));
  const auto summary = ReadReconstruction(Output("reconstruction.json")).body;
  EXPECT_EQ(summary.registered, 3);
  EXPECT_EQ(summary.colmap, "3.8");
  EXPECT_EQ(summary.camera, DataSource::kEstimated);
}

TEST_F(RunReconstructTest, ColmapIsCalledForTheProcessorAndOneCamera) {
  Run();
  const std::string calls = Calls();
  for (const char* words :
       {"--SiftExtraction.use_gpu 0", "--SiftMatching.use_gpu 0", "--ImageReader.single_camera 1",
        "camera_model SIMPLE_RADIAL", "exhaustive_matcher"}) {
    EXPECT_THAT(calls, HasSubstr(words));
  }
  EXPECT_THAT(calls, Not(HasSubstr("ba_refine")));
  Prints("--FeatureExtraction.use_gpu arg (=1)\nFeatures: 3");
  options_.exhaustive_max_images = 2;
  Run("other");
  const std::string newer = Calls();
  EXPECT_THAT(newer, HasSubstr("--FeatureExtraction.use_gpu 0"));
  EXPECT_THAT(newer, HasSubstr("sequential_matcher"));
  EXPECT_THAT(newer, HasSubstr("--FeatureMatching.use_gpu 0"));
}

TEST_F(RunReconstructTest, ColmapFindsNoFeaturesInBoxesOfThingsThatMove) {
  Write("data/detections.csv",
        "frame,label,score,x1,y1,x2,y2\n"
        "0,person,0.9,10,5,20,40\n"
        "1,person,0.1,10,5,20,40\n"
        "1,chair,0.9,10,5,20,40\n"
        "2,cat,0.9,0,0,50,47\n");
  Run();
  EXPECT_THAT(printed_.output, HasSubstr("a box of cat in 1 image, a box of person in 1 image"));
  EXPECT_THAT(printed_.output, HasSubstr("cover more than half of 1 image"));
  const fs::path masks = Output("colmap/masks");
  EXPECT_THAT(Calls(), HasSubstr("--ImageReader.mask_path " + masks.string()));
  const cv::Mat mask = cv::imread((masks / "rgb/0.png.png").string(), cv::IMREAD_GRAYSCALE);
  ASSERT_EQ(mask.size(), cv::Size(64, 48));
  EXPECT_EQ(cv::countNonZero(mask(cv::Rect(10, 5, 11, 36))), 0);
  EXPECT_EQ(cv::countNonZero(mask), 64 * 48 - 11 * 36);
  EXPECT_FALSE(fs::exists(masks / "rgb/1.png.png"));
  // Other boxes are another job; without any the images are as they were.
  Run();
  EXPECT_THAT(Calls(), Not(HasSubstr("mapper")));
  options_.moving_labels = "dog";
  Run();
  EXPECT_THAT(Calls(), Not(HasSubstr("mask_path")));
}

TEST_F(RunReconstructTest, AGivenModelGivesTheSameBytes) {
  Run();
  Calls();
  Run("again", "out/colmap/sparse");
  EXPECT_EQ(Calls(), "");
  for (const char* file : {"camera.json", "odometry.txt", "points.h5"}) {
    EXPECT_EQ(FileBytes(folder_ / "again" / file), FileBytes(Output(file))) << file;
  }
  EXPECT_EQ(ReadReconstruction(folder_ / "again/reconstruction.json").body.colmap, "");
  ExpectError<InputError>([&] { Run("again", "nothing"); }, {"nothing", "no model of COLMAP"});
}

// Poses of a camera that moves along a picture 3 m in front of it, as networks give them.
TEST_F(RunReconstructTest, AModelWithoutTracksGetsPointsOfItsPoses) {
  constexpr double kFocalPx = 300.0, kDepthM = 3.0;
  constexpr int kShiftPx = 6;
  std::string list, images;
  for (int i = 0; i < 6; ++i) {
    cv::Mat soft;
    cv::GaussianBlur(DrawnView(i * kShiftPx), soft, {}, 1.0);
    Write(fmt::format("data/rgb/{}.png", i), EncodedImage(".png", soft));
    list += fmt::format("{} rgb/{}.png\n", i, i);
    images += fmt::format("{} 1 0 0 0 {} 0 0 1 rgb/{}.png\n\n", i + 1,
                          -i * kShiftPx * kDepthM / kFocalPx, i);
  }
  Write("data/rgb.txt", list);
  Write("model/cameras.txt", "1 PINHOLE 320 240 300 300 160 120\n");
  Write("model/images.txt", images);
  Write("model/points3D.txt", "1 0 0 3 128 128 128 1\n2 1 0 3 128 128 128 1\n");
  Run("out", "model");
  EXPECT_THAT(printed_.errors, HasSubstr("model: the model has 2 points without tracks"));
  EXPECT_EQ(ReadTrajectory(Output("odometry.txt")).size(), 6u);
  const std::vector<MapPoint> points = ReadPoints(Output("points.h5"));
  EXPECT_GT(points.size(), 100u);
  EXPECT_EQ(ReadReconstruction(Output("reconstruction.json")).body.points, std::ssize(points));
  const auto is_right = [](const MapPoint& point) {
    return std::abs(point.position_in_world.z() - kDepthM) < 0.1;
  };
  EXPECT_GT(2 * std::ranges::count_if(points, is_right), std::ssize(points));
  fs::remove(folder_ / "model/points3D.txt");
  Run("out", "model");
  EXPECT_THAT(printed_.errors, HasSubstr("model: the model has no points"));
  EXPECT_EQ(ReadPoints(Output("points.h5")).size(), points.size());
}

TEST_F(RunReconstructTest, AGivenModelOfOtherNamesIsRefusedOrNamed) {
  Run();
  const std::string list = "0 rgb/IMG_1.png\n0.5 rgb/IMG_2.png\n1 rgb/IMG_3.png\n";
  for (int i = 0; i < 3; ++i) {
    fs::copy_file(Dataset() / fmt::format("rgb/{}.png", i),
                  Dataset() / fmt::format("rgb/IMG_{}.png", i + 1));
  }
  Write("data/rgb.txt", list);
  ExpectError<InputError>([&] { Run("again", "out/colmap/sparse"); },
                          {"images.txt", "rgb/0.png, rgb/1.png and 1 more",
                           "rgb/IMG_1.png, rgb/IMG_2.png and 1 more", "renamed"});
  Write("data/rgb.txt", "0 rgb/0.png\n0.5 rgb/1.png\n1 rgb/IMG_3.png\n");
  Run("again", "out/colmap/sparse");
  EXPECT_THAT(printed_.output, HasSubstr("1 image in the model, but not in rgb.txt: rgb/2.png\n"));
  EXPECT_THAT(printed_.errors,
              HasSubstr("or other names than in the model, which has images that are not "
                        "listed: rgb/2.png"));
  // Fewer images that are not listed than such without a pose do not explain them.
  Write("data/rgb.txt", "0 rgb/0.png\n0.5 rgb/IMG_1.png\n1 rgb/IMG_2.png\n2 rgb/IMG_3.png\n");
  Run("again", "out/colmap/sparse");
  EXPECT_THAT(printed_.errors, testing::AllOf(HasSubstr("a model of a part of the images"),
                                              Not(HasSubstr("other names"))));
}

TEST_F(RunReconstructTest, AFinishedJobIsNotRunAgain) {
  Run();
  Calls();
  Run();
  EXPECT_THAT(Calls(), Not(HasSubstr("mapper")));
  cv::imwrite((Dataset() / "rgb/1.png").string(), cv::Mat::zeros(48, 64, CV_8UC3));
  Run();
  EXPECT_THAT(Calls(), HasSubstr("mapper"));
}

TEST_F(RunReconstructTest, AGivenCameraIsKept) {
  const std::string camera =
      R"({"width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 31.5, "cy": 23.5})";
  Write("data/camera.json", camera);
  camera_ = "PINHOLE 64 48 50 50 32 24";
  WriteModel("0", 3);
  Run();
  const std::string calls = Calls();
  EXPECT_THAT(calls, HasSubstr("camera_model PINHOLE --ImageReader.camera_params 50,50,32,24"));
  EXPECT_THAT(calls, HasSubstr("--Mapper.ba_refine_focal_length 0"));
  EXPECT_THAT(calls, HasSubstr("--Mapper.max_extra_param 1e6")) << "any distortion is taken";
  EXPECT_EQ(FileBytes(Output("camera.json")), camera);
  EXPECT_EQ(ReadReconstruction(Output("reconstruction.json")).body.camera, DataSource::kGiven);
  options_.calibration = CalibrationChoice::kInitial;
  camera_ = "SIMPLE_RADIAL 64 48 50 32 24 0.01";
  WriteModel("0", 3);
  Run("refined");
  EXPECT_THAT(Calls(), Not(HasSubstr("ba_refine")));
  EXPECT_THAT(FileBytes(folder_ / "refined/camera.json"), HasSubstr("0.01"));
  options_ = {};
  Write("data/camera.json",
        R"({"width": 64, "height": 48, "fx": 60, "fy": 50, "cx": 31.5, "cy": 23.5})");
  ExpectError<InputError>([&] { Run("other", "bin/models"); },
                          {"camera.json", "from those of the model's camera", "fx 50.00", "1 px"});
  Write("data/camera.json",
        R"({"width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 31.5, "cy": 23.5,
                 "distortion": [0.2, 0, 0, 0, 0]})");
  ExpectError<InputError>([&] { Run("other", "bin/models"); }, {"image points are 1."});
}

TEST_F(RunReconstructTest, AGivenCameraThatDiffersLessThanBoxesShowIsKept) {
  const std::string camera =
      R"({"width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 31.53, "cy": 23.5})";
  Write("data/camera.json", camera);
  camera_ = "PINHOLE 64 48 50 50 32 24";
  WriteModel("0", 3);
  Run();
  EXPECT_THAT(printed_.output,
              HasSubstr("image points are 0.03 px (root mean square) from those of the model's"));
  EXPECT_EQ(FileBytes(Output("camera.json")), camera);
}

TEST_F(RunReconstructTest, FilesInTheDatasetThatAreOfThisStageAreNotGiven) {
  Run("data");
  Run("data");
  EXPECT_EQ(ReadReconstruction(Dataset() / "reconstruction.json").body.camera,
            DataSource::kEstimated);
  Write("data/odometry.txt", "0 0 0 0 0 0 0 1\n");
  ExpectError<SettingsError>([&] { Run("data"); }, {"odometry.txt", "would be replaced"});
}

TEST_F(RunReconstructTest, GivenPosesAreTriangulated) {
  Write("data/camera.json",
        R"({"width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 31.5, "cy": 23.5})");
  const std::string odometry = "0 0 0 0 0 0 0 1\n0.5 1 0 0 0 0 0 1\n1.01 2 0 0 0 0 0 1\n";
  Write("data/odometry.txt", odometry);
  camera_ = "PINHOLE 64 48 50 50 32 24";
  WriteModelWithoutNumber();
  options_.poses = PoseChoice::kGiven;
  Run("data");
  EXPECT_THAT(Calls(), HasSubstr("point_triangulator"));
  EXPECT_EQ(FileBytes(Dataset() / "odometry.txt"), odometry);
  EXPECT_EQ(ReadPoints(Dataset() / "points.h5").size(), 1u);
  EXPECT_THAT(FileBytes(Dataset() / "colmap/given/images.txt"),
              HasSubstr("2 1 -0 -0 -0 -1 -0 -0 1 rgb/1.png\n\n"));
  Write("data/odometry.txt", "0 0 0 0 0 0 0 1\n0.5 1.1 0 0 0 0 0 1\n");
  ExpectError<InputError>([&] { Run("data"); }, {"rgb/1.png", "another pose than odometry.txt"});
  Write("bin/crash", "");
  fs::remove_all(Dataset() / "colmap");
  ExpectError<NothingUsableError>([&] { Run("data"); }, {"point_triangulator", "139", "fit"});
  Write("data/odometry.txt", "0 0 0 0 0 0 0 1\n");
  ExpectError<InputError>([&] { Run("data"); }, {"odometry.txt", "1 of 3 images"});
  options_.calibration = CalibrationChoice::kEstimated;
  ExpectError<SettingsError>([&] { Run("data"); }, {"given camera"});
}

TEST_F(RunReconstructTest, FaintFeaturesAreSoughtWhereImagesFindNoPlace) {
  Run();
  EXPECT_THAT(Calls(), Not(HasSubstr("peak_threshold")));
  fs::remove_all(Output(""));
  WriteModel("0", 2);
  WriteModel("0", 3, "models_of_faint");
  Run();
  EXPECT_THAT(Calls(), AllOf(HasSubstr("peak_threshold"), HasSubstr("guided_matching 1")));
  EXPECT_THAT(printed_.output, HasSubstr("registered 3 of 3 images"));
  // Those that place no more images are not used.
  fs::remove_all(Output(""));
  WriteModel("1", 2, "models_of_faint");
  WriteModel("0", 1, "models_of_faint");
  Run();
  EXPECT_THAT(printed_.output, HasSubstr("registered 2 of 3 images"));
  EXPECT_EQ(ReadReconstruction(Output("reconstruction.json")).body.components.size(), 1u);
  EXPECT_FALSE(fs::exists(Output("colmap/sparse.faint")));
}

TEST_F(RunReconstructTest, FindingsAreReported) {
  WriteModel("1", 2);
  Write("bin/models/0/points3D.txt", "1 1 0 500 0 0 0 0.25 1 0 3 0\n");
  Write("data/rgb.txt", "0 rgb/0.png\n1 rgb/1.png\n2 rgb/2.png\n3 rgb/more.png\n");
  fs::copy_file(Dataset() / "rgb/0.png", Dataset() / "rgb/more.png");
  Run();
  for (const char* words : {"3 of 4 images are registered", "2 parts",
                            "the second one has 2 images", "no baseline: poses needed"}) {
    EXPECT_THAT(printed_.errors, HasSubstr(words));
  }
  EXPECT_THAT(printed_.output, HasSubstr("; 2 images in a second component"));
  EXPECT_EQ(ReadReconstruction(Output("reconstruction.json")).body.components[1].folder, "1");
  EXPECT_THAT(printed_.output, HasSubstr("without a pose, and not used: rgb/more.png\n"));
  EXPECT_THAT(ReadReconstruction(Output("reconstruction.json")).body.images_without_pose,
              testing::ElementsAre("rgb/more.png"));
  EXPECT_EQ(ReadFindings(ParseJsonFile(Output("reconstruction.json"))).size(), 3u);
}

TEST_F(RunReconstructTest, AFinishedModelOfAPartOfTheImages) {
  WriteModel("0", 2);
  Run("out", "bin/models");
  EXPECT_THAT(printed_.errors, HasSubstr("2 of 3 images are registered"));
  EXPECT_THAT(printed_.errors, HasSubstr("likely cause: a model of a part of the images; remedy: "
                                         "give a model of all images"));
}

TEST_F(RunReconstructTest, FailuresOfColmapAreNamed) {
  Write("bin/crash", "");
  ExpectFailure<NothingUsableError>({"colmap mapper", "exit code 139", "Registering", "log.txt"});
  fs::remove(folder_ / "bin/crash");
  fs::remove_all(folder_ / "bin/models");
  ExpectFailure<NumericalError>({"no two images", "log.txt"});
  Prints("  Features:        0");
  ExpectFailure<NothingUsableError>({"none of 3 images has features"});
  setenv("PATH", (folder_ / "nothing").string().c_str(), 1);
  ExpectFailure<SettingsError>({"package colmap", "--model"});
  Write("data/rgb.txt", "0 rgb/0.png\n");
  ExpectFailure<InputError>({"rgb.txt", "single image"});
}

// Images that EXIF turns by half a turn, with a model of which the colours of points tell whether
// it is of the stored ones.
TEST_F(RunReconstructTest, AModelOfStoredImagesThatExifTurnsIsTurnedUpright) {
  cv::Mat image(48, 64, CV_8UC3);
  cv::randu(image, 0, 255);
  cv::resize(image(cv::Rect(0, 0, 16, 12)).clone(), image, image.size(), 0, 0, cv::INTER_NEAREST);
  for (int i = 0; i < 3; ++i) {
    Write(fmt::format("data/rgb/{}.png", i),
          JpegWithExif(EncodedImage(".jpg", image), ExifOf(i == 1 ? 1 : 3)));
  }
  const auto run_with = [&](const std::function<cv::Vec3b(int x, int y)>& bgr_at) {
    std::string points, pixels;
    for (int i = 0; i < 30; ++i) {
      const int x = 2 + 4 * (i % 15), y = 6 + 16 * (i / 15);
      const cv::Vec3b bgr = bgr_at(x, y);
      pixels += fmt::format("{} {} {} ", x + 0.5, y + 0.5, i + 1);
      points += fmt::format("{} {} {} 5 {} {} {} 0.25 1 {} 2 {} 3 {}\n", i + 1, 0.1 * x, 0.1 * y,
                            bgr[2], bgr[1], bgr[0], i, i, i);
    }
    std::string images;
    for (int i = 0; i < 3; ++i) {
      images += fmt::format("{} 1 0 0 0 {} 0 0 1 rgb/{}.png\n{}\n", i + 1, -i, i, pixels);
    }
    Write("model/cameras.txt", "1 PINHOLE 64 48 50 50 32 24\n");
    Write("model/images.txt", images);
    Write("model/points3D.txt", points);
    Run("out", "model");
  };
  const auto turns = [&] {
    std::vector<double> degrees;
    for (const TimedPose& pose : ReadTrajectory(Output("odometry.txt"))) {
      degrees.push_back(kDegPerRad * LogRotation(pose.world_from_camera.rotation).norm());
    }
    return degrees;
  };
  using testing::DoubleNear;
  const auto are_turned =
      testing::ElementsAre(DoubleNear(180, 1e-6), DoubleNear(0, 1e-6), DoubleNear(180, 1e-6));
  run_with([&](int x, int y) { return image.at<cv::Vec3b>(y, x); });
  EXPECT_EQ(printed_.errors, "");
  EXPECT_THAT(printed_.output, HasSubstr("EXIF turns 2 of 3 images; the model is of"));
  EXPECT_THAT(turns(), are_turned);
  run_with([](int, int) { return cv::Vec3b(128, 128, 128); });
  EXPECT_THAT(printed_.errors, HasSubstr("2 images are turned by EXIF within their size"));
  EXPECT_THAT(turns(), are_turned);
  run_with([&](int x, int y) { return image.at<cv::Vec3b>(47 - y, 63 - x); });
  EXPECT_EQ(printed_.errors, "") << "a model of upright images";
  EXPECT_THAT(turns(), testing::Each(DoubleNear(0, 1e-6)));
  Write("model/cameras.txt", "1 PINHOLE 48 64 50 50 24 32\n");
  ExpectError<InputError>([&] { Run("out", "model"); },
                          {"rgb/0.png: is 64 x 48 pixels, the model's camera 48 x 64"});
}

TEST_F(RunReconstructTest, ImagesThatColmapWouldMistakeAreRefused) {
  cv::imwrite((Dataset() / "rgb/1.png").string(), cv::Mat::zeros(64, 48, CV_8UC3));
  ExpectFailure<InputError>({"1.png", "48 x 64", "64 x 48", "first image"});
  Write("data/rgb/1.png",
        JpegWithExif(EncodedImage(".jpg", cv::Mat::zeros(48, 64, CV_8UC3)), ExifOf(6)));
  ExpectFailure<InputError>({"1.png", "EXIF turns", "exiftran -ai"});
  options_.image_orientation = ImageOrientation::kStored;
  EXPECT_NO_THROW(Run());
  fs::remove_all(folder_ / "out");
  Write("data/rgb/1.png", "no image");
  ExpectFailure<InputError>({"1.png", "expected a JPEG"});
  const cv::Mat thumbnail(12, 16, CV_8UC1, cv::Scalar(9)), photo(48, 64, CV_8UC1, cv::Scalar(9));
  Write("data/rgb/1.png", TiffWithImageBelow(thumbnail, photo));
  ExpectFailure<InputError>({"1.png", "RAW"});
}

}  // namespace
}  // namespace soslam
