// SPDX-License-Identifier: BSD-3-Clause
// The usual mistakes, each in a dataset that is right but for it.
#include "dataset/dataset_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>
#include <numeric>

#include "base/error.h"
#include "dataset/import.h"
#include "geometry/angles.h"
#include "support/dataset_fixture.h"
#include "support/image_files.h"
#include "support/plausible_dataset.h"

namespace soslam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class DatasetChecksTest : public testing::Test {
 protected:
  DatasetChecksTest() { options.border_px = 0; }

  // The warnings, each as "check: in words".
  std::vector<std::string> Warnings() {
    dataset.Write(folder);
    std::vector<std::string> warnings;
    for (const Finding& finding : ImportDataset(folder, options).findings) {
      warnings.push_back(finding.check + ": " + InWords(finding));
    }
    return warnings;
  }

  // What import says when it refuses the dataset.
  std::string Refusal() {
    dataset.Write(folder);
    try {
      ImportDataset(folder, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  // Images that store width x height pixels.
  void WriteImages(int width, int height, int exif_orientation = 1) {
    std::filesystem::create_directories(folder / "rgb");
    const cv::Mat image(height, width, CV_8UC1, cv::Scalar(128));
    const std::string bytes = PngWithExif(EncodedImage(".png", image), ExifOf(exif_orientation),
                                          /*is_after_pixels=*/false);
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      std::ofstream(folder / fmt::format("rgb/{:06}.png", frame), std::ios::binary) << bytes;
    }
  }

  // Boxes in a file of COCO's results.
  void WriteCoco(const std::function<std::array<double, 4>(const Box&)>& numbers) {
    nlohmann::json results = nlohmann::json::array();
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      for (size_t ball = 0; ball < PlausibleDataset::Labels().size(); ++ball) {
        results.push_back({{"image_id", frame},
                           {"category_id", 62},
                           {"score", 0.9},
                           {"bbox", numbers(dataset.BoxOf(ball, frame))}});
      }
    }
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "boxes.json") << results.dump();
    options.detections = "boxes.json";
    options.folder.detections_format = DetectionsFormat::kCoco;
  }

  // Poses in EuRoC's format, by default those of the camera.
  void WriteEuroc(const std::function<Rigid3d(const Rigid3d&)>& written = std::identity()) {
    std::filesystem::create_directories(folder);
    std::ofstream file(folder / "data.csv");
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      const Rigid3d pose = written(dataset.WorldFromCamera(frame));
      const Eigen::Quaterniond& q = pose.rotation;
      file << fmt::format("{}00000000,{},{},{},{},{},{},{}\n", 1000 + 5 * frame,
                          pose.translation.x(), pose.translation.y(), pose.translation.z(), q.w(),
                          q.x(), q.y(), q.z());
    }
    options.folder.odometry = "data.csv";
    options.folder.trajectory_format = TrajectoryFormat::kEuroc;
  }

  void WriteColmap() {
    std::filesystem::create_directories(folder);
    std::ofstream file(folder / "images.txt");
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      const Rigid3d pose = dataset.WorldFromCamera(frame).Inverse();
      const Eigen::Quaterniond& q = pose.rotation;
      file << fmt::format("{} {} {} {} {} {} {} {} 1 {:06}.png\n\n", frame + 1, q.w(), q.x(), q.y(),
                          q.z(), pose.translation.x(), pose.translation.y(), pose.translation.z(),
                          frame);
    }
    options.folder.odometry = "images.txt";
    options.folder.trajectory_format = TrajectoryFormat::kColmap;
  }

  PlausibleDataset dataset;
  ImportOptions options;
  std::filesystem::path folder = FreshTestFolder() / "small";
};

TEST_F(DatasetChecksTest, NothingIsFoundWhereNothingIsWrong) {
  dataset.has_truth = true;
  WriteImages(640, 480);
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, NothingIsFoundWithoutObjectIds) {
  dataset.has_object_ids = false;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// Cameras.

TEST_F(DatasetChecksTest, ImagesOfAnotherSize) {
  WriteImages(320, 240);
  EXPECT_THAT(Refusal(),
              AllOf(HasSubstr("24 of 24 images are of 320 x 240"), HasSubstr("640 x 480"),
                    HasSubstr("smaller or larger"), HasSubstr("times 0.5")));
}

TEST_F(DatasetChecksTest, ImagesOfSwappedSides) {
  WriteImages(480, 640);
  EXPECT_THAT(Refusal(), HasSubstr("width and height swapped"));
}

TEST_F(DatasetChecksTest, ImagesThatAreTurnedByAQuarterAreOfTheSizeThatIsShown) {
  WriteImages(480, 640, /*exif_orientation=*/6);
  EXPECT_THAT(Warnings(), IsEmpty());
  options.image_orientation = ImageOrientation::kStored;
  EXPECT_THAT(Refusal(), HasSubstr("480 x 640"));
}

TEST_F(DatasetChecksTest, ImagesThatAreTurnedUpsideDown) {
  WriteImages(640, 480, /*exif_orientation=*/3);
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("24 of 24 images"),
                                            HasSubstr("image_orientation stored"))));
  options.image_orientation = ImageOrientation::kStored;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// A camera of the stored images.
TEST_F(DatasetChecksTest, ImagesThatAreShownWithSwappedSides) {
  WriteImages(640, 480, /*exif_orientation=*/6);
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("480 x 640"), HasSubstr("as they are stored"),
                               HasSubstr("image_orientation stored")));
  options.image_orientation = ImageOrientation::kStored;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// COLMAP does not turn them, whatever size the camera has.
TEST_F(DatasetChecksTest, TurnedImagesWithPosesOfColmap) {
  WriteColmap();
  WriteImages(640, 480);
  EXPECT_THAT(Warnings(), IsEmpty());
  WriteImages(480, 640, /*exif_orientation=*/6);
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("image_orientation: 24 of 24 images"),
                                            HasSubstr("COLMAP's poses and camera"),
                                            HasSubstr("image_orientation stored"))));
}

TEST_F(DatasetChecksTest, CameraOfSwappedSides) {
  dataset.written_camera = {480, 640, 500.0, 500.0, 319.5, 239.5};
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("swapped"), HasSubstr("width 640, height 480")));
}

TEST_F(DatasetChecksTest, IntrinsicsOfLargerImages) {
  dataset.written_camera = {640, 480, 1000.0, 1000.0, 639.5, 479.5};
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("images 2 times as large"),
                               HasSubstr("divide fx, fy, cx, cy by 1.99")));
}

TEST_F(DatasetChecksTest, IntrinsicsAsFractions) {
  dataset.written_camera = {640, 480, 0.78, 1.04, 0.5, 0.5};
  EXPECT_THAT(Refusal(), HasSubstr("fractions of the image"));
}

TEST_F(DatasetChecksTest, FocalLengthInMillimetres) {
  dataset.written_camera = {640, 480, 4.2, 4.2, 319.5, 239.5};
  EXPECT_THAT(Refusal(), HasSubstr("millimetres"));
}

TEST_F(DatasetChecksTest, ANearlySquareCameraHasNoSwappedSides) {
  dataset.camera = dataset.written_camera = {660, 620, 500.0, 500.0, 325.0, 314.0};
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, PrincipalPointOutsideOfTheImage) {
  dataset.written_camera = {640, 480, 500, 500, 319.5, 700.0};
  EXPECT_THAT(Refusal(), HasSubstr("another camera"));
}

// Without images only the boxes tell.
TEST_F(DatasetChecksTest, CameraOfLargerImagesThanTheBoxes) {
  dataset.box = [](const Box& b) {  // all over the image, and cut by it
    const auto cut = [](double x, double size) {
      return std::clamp(0.5 * size + 3.0 * (x - 0.5 * size), -0.5, size - 0.5);
    };
    return std::array{cut(b.x_min, 640), cut(b.y_min, 480), cut(b.x_max, 640), cut(b.y_max, 480)};
  };
  dataset.written_camera = {1280, 960, 1000.0, 1000.0, 639.5, 479.5};
  EXPECT_THAT(Warnings(), testing::Contains(AllOf(HasSubstr("box_extent"), HasSubstr("1280 x 960"),
                                                  HasSubstr("made smaller"))));
}

// Boxes.

TEST_F(DatasetChecksTest, SizesWhereCornersBelong) {
  dataset.box = [](const Box& b) {
    return std::array<double, 4>{b.x_min, b.y_min, b.Width(), b.Height()};
  };
  EXPECT_THAT(Refusal(), HasSubstr("meant as upper left corner and size"));
}

TEST_F(DatasetChecksTest, CornersWhereSizesBelong) {
  WriteCoco([](const Box& b) { return std::array{b.x_min, b.y_min, b.x_max, b.y_max}; });
  EXPECT_THAT(Refusal(), HasSubstr("meant as two corners"));
}

// Boxes on the right of the image reach out of it.
TEST_F(DatasetChecksTest, CentresWhereCornersBelong) {
  WriteCoco([](const Box&) { return std::array{500.0, 300.0, 200.0, 150.0}; });
  EXPECT_THAT(Refusal(), HasSubstr("meant as centre and size"));
}

TEST_F(DatasetChecksTest, AFewBoxesOutOfTheImage) {
  dataset.box = [count = 0](const Box& b) mutable {
    const double shift = ++count % 8 == 0 ? 600.0 : 0.0;
    return std::array{b.x_min + shift, b.y_min, b.x_max + shift, b.y_max};
  };
  EXPECT_THAT(Warnings(), testing::Contains(HasSubstr("box_convention: 14 of 115 boxes")));
}

TEST_F(DatasetChecksTest, BoxesAsFractions) {
  dataset.box = [](const Box& b) {
    return std::array{b.x_min / 640, b.y_min / 480, b.x_max / 640, b.y_max / 480};
  };
  EXPECT_THAT(Refusal(), HasSubstr("fractions of the image"));
}

TEST_F(DatasetChecksTest, BoxesOfLargerImages) {
  dataset.box = [](const Box& b) {
    return std::array{3 * b.x_min, 3 * b.y_min, 3 * b.x_max, 3 * b.y_max};
  };
  EXPECT_THAT(Refusal(), HasSubstr("images of another size"));
}

// A box of the whole thing, also where the image cuts it.
TEST_F(DatasetChecksTest, BoxesOfWholeThingsAreNoOtherConvention) {
  dataset.box = [](const Box& b) {
    const auto wide = [](double x, double size) { return 0.5 * size + 4.0 * (x - 0.5 * size); };
    return std::array{wide(b.x_min, 640), wide(b.y_min, 480), wide(b.x_max, 640),
                      wide(b.y_max, 480)};
  };
  EXPECT_THAT(Warnings(), testing::Contains(HasSubstr("whole objects that the image cuts")));
}

TEST_F(DatasetChecksTest, AnOrbitAroundThingsInTheMiddleIsNoSmallerImage) {
  dataset.camera.fx = dataset.camera.fy = dataset.written_camera.fx = dataset.written_camera.fy =
      200;
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, ScoresInPerCent) {
  dataset.score = "87";
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("115 of 115 scores"), HasSubstr("per cent"))));
}

TEST_F(DatasetChecksTest, BoxesThatTheBorderGateDrops) {
  options.border_px = 200;
  options.min_observations = 1;
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("rejected_near_border"), HasSubstr("border_px"))));
}

// Objects that boxes are of.

TEST_F(DatasetChecksTest, NoBoxOfATrack) {
  dataset.first_object_id = -5;
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("object_ids: detections.csv: all 115 boxes"),
                                            HasSubstr("let association be estimated"))));
}

TEST_F(DatasetChecksTest, HalfOfTheBoxesOfNoTrack) {
  dataset.first_object_id = -2;
  dataset.label = [](size_t) { return "ball"; };
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("rejected_without_object_id: 46 of 115"),
                                            HasSubstr("a tracker that finds few tracks"))));
}

// Labels.

TEST_F(DatasetChecksTest, LabelsThatFlicker) {
  const auto flicker = [](int of_seven) {
    return [of_seven, count = 0](size_t ball) mutable {
      return count++ % 7 < of_seven ? "thing" : PlausibleDataset::Labels()[ball];
    };
  };
  dataset.label = flicker(1);
  EXPECT_THAT(Warnings(), IsEmpty());
  dataset.label = flicker(3);
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("labels_of_objects: detections.csv: 51 of 115 boxes"),
                                HasSubstr("ids that are of several things"))));
}

class ClassNamesTest : public DatasetChecksTest {
 protected:
  // YOLO's labels with these classes for the five balls, and these lines of names.
  void WriteYolo(const std::array<int, 5>& classes, const std::string& names) {
    std::filesystem::create_directories(folder / "labels");
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      std::string lines;
      for (size_t ball = 0; ball < classes.size(); ++ball) {
        const Box box = dataset.BoxOf(ball, frame);
        lines += fmt::format("{} {} {} {} {}\n", classes[ball], (box.Centre().x() + 0.5) / 640,
                             (box.Centre().y() + 0.5) / 480, box.Width() / 640, box.Height() / 480);
      }
      std::ofstream(folder / fmt::format("labels/{:06}.txt", frame)) << lines;
    }
    std::ofstream(folder / "names.txt") << names;
    options.detections = "labels";
    options.folder.detections_format = DetectionsFormat::kYolo;
    options.folder.class_names = "names.txt";
    dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  }
};

TEST_F(ClassNamesTest, AreRight) {
  WriteYolo({0, 1, 2, 3, 4}, "ball\ncup\nvase\nbowl\nbottle\ntable\n\n");
  EXPECT_THAT(Warnings(), IsEmpty());
}

// The left edge is by 2 % of the width out of the image. The boxes of no track count, too.
TEST_F(ClassNamesTest, BoxesThatReachBeyondTheImage) {
  WriteYolo({0, 1, 2, 3, 4}, "ball\ncup\nvase\nbowl\nbottle\n");
  dataset.objects = "";
  for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
    std::ofstream(folder / fmt::format("labels/{:06}.txt", frame))
        << "0 0.03 0.5 0.1 0.2 0.9 -1\n1 0.5 0.5 0.1 0.2 0.9 1\n";
  }
  EXPECT_THAT(Warnings(), testing::Contains(HasSubstr("boxes_cut: labels: 24 of 48 boxes")));
}

TEST_F(ClassNamesTest, AreCountedFromOne) {
  WriteYolo({1, 3, 5, 7, 9}, "ball\na\ncup\nb\nvase\nc\nbowl\nd\nbottle\ne\n");
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("class_numbers: 0 of 120"),
                                            HasSubstr("but 120 if"), HasSubstr("one lower"))));
}

TEST_F(ClassNamesTest, HaveABlankLineBetween) {
  WriteYolo({0, 1, 2, 3, 4}, "ball\ncup\n\nvase\nbowl\nbottle\n");
  EXPECT_THAT(Warnings(), ElementsAre(HasSubstr("names.txt has 1 blank lines")));
}

// Poses.

struct WrittenPose {
  std::string name;
  Rigid3d (*write)(const Rigid3d& world_from_camera);
  std::string words;
};

void PrintTo(const WrittenPose& pose, std::ostream* stream) { *stream << pose.name; }

Eigen::Quaterniond WithScalarFirst(const Eigen::Quaterniond& q) {
  return Eigen::Quaterniond(/*w=*/q.z(), /*x=*/q.w(), /*y=*/q.x(), /*z=*/q.y());
}

Rigid3d RotatedAboutZ(const Rigid3d& pose, const Eigen::Vector3d& axis, double degrees) {
  return {pose.rotation * Eigen::AngleAxisd(degrees * kRadPerDeg, axis), pose.translation};
}

class PoseConventionTest : public DatasetChecksTest,
                           public testing::WithParamInterface<WrittenPose> {};

TEST_P(PoseConventionTest, IsNamed) {
  dataset.odometry = GetParam().write;
  EXPECT_THAT(Refusal(), HasSubstr(GetParam().words));
}

TEST_P(PoseConventionTest, IsNamedWithoutObjectIds) {
  dataset.has_object_ids = false;
  dataset.odometry = GetParam().write;
  EXPECT_THAT(Refusal(), HasSubstr(GetParam().words));
}

INSTANTIATE_TEST_SUITE_P(
    All, PoseConventionTest,
    testing::Values(
        WrittenPose{"Inverse", [](const Rigid3d& pose) { return pose.Inverse(); },
                    "the other way round"},
        WrittenPose{"ScalarFirst",
                    [](const Rigid3d& pose) {
                      return Rigid3d{WithScalarFirst(pose.rotation), pose.translation};
                    },
                    "quaternions qw qx qy qz"},
        WrittenPose{"Colmap",
                    [](const Rigid3d& pose) {
                      const Rigid3d inverse = pose.Inverse();
                      return Rigid3d{WithScalarFirst(inverse.rotation), inverse.translation};
                    },
                    "COLMAP's images.txt"},
        WrittenPose{
            "OpenGl",
            [](const Rigid3d& pose) {
              return Rigid3d{pose.rotation * Eigen::Quaterniond(0, 1, 0, 0), pose.translation};
            },
            "OpenGL"},
        WrittenPose{"OpenGlInverse",
                    [](const Rigid3d& pose) {
                      return Rigid3d{pose.rotation * Eigen::Quaterniond(0, 1, 0, 0),
                                     pose.translation}
                          .Inverse();
                    },
                    "view matrices of OpenGL"},
        WrittenPose{"OpenGlScalarFirst",
                    [](const Rigid3d& pose) {
                      return Rigid3d{
                          WithScalarFirst(pose.rotation * Eigen::Quaterniond(0, 1, 0, 0)),
                          pose.translation};
                    },
                    "OpenGL, with quaternions qw qx qy qz"},
        WrittenPose{"InverseRotation",
                    [](const Rigid3d& pose) {
                      return Rigid3d{pose.rotation.conjugate(), pose.translation};
                    },
                    "rotation matrices that were transposed"},
        WrittenPose{"InverseTranslation",
                    [](const Rigid3d& pose) {
                      return Rigid3d{pose.rotation, pose.Inverse().translation};
                    },
                    "translations of camera_from_world"},
        WrittenPose{"CentreInverted",
                    [](const Rigid3d& pose) {
                      return Rigid3d{pose.rotation, -(pose.rotation * pose.translation)};
                    },
                    "taken for the translation of camera_from_world"},
        WrittenPose{
            "QuarterTurn",
            [](const Rigid3d& pose) { return RotatedAboutZ(pose, Eigen::Vector3d::UnitZ(), -90); },
            "turn the cameras by 90 degrees"},
        WrittenPose{
            "QuarterTurnBack",
            [](const Rigid3d& pose) { return RotatedAboutZ(pose, Eigen::Vector3d::UnitZ(), 90); },
            "turn the cameras by -90 degrees"},
        WrittenPose{"RosBody",
                    [](const Rigid3d& pose) {
                      Eigen::Matrix3d camera_from_body;
                      camera_from_body << 0, -1, 0, 0, 0, -1, 1, 0, 0;
                      return Rigid3d{pose.rotation * Eigen::Quaterniond(camera_from_body),
                                     pose.translation};
                    },
                    "as ROS has them"},
        WrittenPose{"MirroredCentre",
                    [](const Rigid3d& pose) {
                      const Eigen::Vector3d& t = pose.translation;
                      return Rigid3d{pose.rotation, {-t.x(), t.y(), t.z()}};
                    },
                    "the translations' x"},
        WrittenPose{"LeftHanded",
                    [](const Rigid3d& pose) {
                      const Eigen::DiagonalMatrix<double, 3> mirror(1, -1, 1);
                      const Eigen::Matrix3d axes = pose.rotation.toRotationMatrix();
                      return Rigid3d{Eigen::Quaterniond(Eigen::Matrix3d(mirror * axes * mirror)),
                                     mirror * pose.translation};
                    },
                    "as Unity has them"},
        WrittenPose{"SwappedYAndZ",
                    [](const Rigid3d& pose) {
                      const Eigen::Vector3d& t = pose.translation;
                      return Rigid3d{pose.rotation, {t.x(), t.z(), t.y()}};
                    },
                    "y and z swapped"}),
    [](const auto& info) { return info.param.name; });

// While a camera looks at the middle of all things, a half turn hardly shows.
TEST_F(DatasetChecksTest, CamerasTurnedByHalfATurn) {
  dataset.sway = 0.3;
  EXPECT_THAT(Warnings(), IsEmpty());
  dataset.odometry = [](const Rigid3d& pose) {
    return RotatedAboutZ(pose, Eigen::Vector3d::UnitZ(), 180.0);
  };
  EXPECT_THAT(Refusal(), HasSubstr("by half a turn about the camera's z axis"));
}

TEST_F(DatasetChecksTest, MirroredBoxes) {
  dataset.box = [](const Box& b) {
    return std::array{639 - b.x_max, b.y_min, 639 - b.x_min, b.y_max};
  };
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("boxes are mirrored left to right"),
                               HasSubstr("as selfie cameras do")));
}

TEST_F(DatasetChecksTest, BoxesWithYUp) {
  dataset.box = [](const Box& b) {
    return std::array{b.x_min, 479 - b.y_max, b.x_max, 479 - b.y_min};
  };
  EXPECT_THAT(Refusal(), HasSubstr("boxes with y up"));
}

TEST_F(DatasetChecksTest, PosesInReversedOrder) {
  dataset.pose_of_frame = [](int frame) { return PlausibleDataset::kFrames - 1 - frame; };
  EXPECT_THAT(Warnings(),
              testing::Contains(AllOf(HasSubstr("frame_order: "), HasSubstr("reversed order"))));
}

class OrderOfStringsTest : public DatasetChecksTest {
 protected:
  // 0, 1, 10, 11, ..., 2, ...
  static std::vector<int> Order() {
    std::vector<int> order(PlausibleDataset::kFrames);
    std::iota(order.begin(), order.end(), 0);
    std::ranges::sort(order, {}, [](int frame) { return std::to_string(frame); });
    return order;
  }
};

TEST_F(OrderOfStringsTest, OfPoses) {
  dataset.pose_of_frame = [](int frame) { return Order()[static_cast<size_t>(frame)]; };
  EXPECT_THAT(Warnings(),
              testing::Contains(AllOf(HasSubstr("frame_order: "),
                                      HasSubstr("the poses are in the order of strings"))));
}

TEST_F(OrderOfStringsTest, OfBoxes) {
  dataset.pose_of_frame = [](int frame) {
    const std::vector<int> order = Order();
    return static_cast<int>(std::ranges::find(order, frame) - order.begin());
  };
  EXPECT_THAT(Warnings(), testing::Contains(AllOf(HasSubstr("frame_order: "),
                                                  HasSubstr("boxes are in the order of strings"))));
}

// Poses that were shuffled: no order or reading explains them.
TEST_F(DatasetChecksTest, PosesThatContradictTheBoxes) {
  dataset.pose_of_frame = [](int frame) { return frame * 7 % PlausibleDataset::kFrames; };
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("boxes_against_poses: 5 things are"),
                                HasSubstr("poses, the order of frames, or ids contradict"))));
}

TEST_F(DatasetChecksTest, PosesThatContradictTheBoxesAndTheTruth) {
  dataset.pose_of_frame = [](int frame) { return frame * 7 % PlausibleDataset::kFrames; };
  dataset.has_truth = true;
  EXPECT_THAT(Warnings(), ElementsAre(HasSubstr("trajectory_against_truth")));
}

// It turns about z while the camera goes around.
TEST_F(DatasetChecksTest, PosesThatDrift) {
  dataset.odometry = [](const Rigid3d& pose) {
    const double turn_rad = 0.1 * std::atan2(pose.translation.y(), pose.translation.x());
    const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitZ());
    return Rigid3d{Eigen::Quaterniond(turn), {0.0, 0.0, 5.0 * turn_rad}} * pose;
  };
  EXPECT_THAT(Warnings(), ElementsAre(HasSubstr("poses that drift far")));
  dataset.has_truth = true;
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, PlanesThroughPosesThatContradictTheBoxes) {
  dataset.pose_of_frame = [](int frame) { return frame * 7 % PlausibleDataset::kFrames; };
  dataset.plane = R"([{"id": 0, "normal": [0, 0, -1], "d": 0}])";
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("from below"), HasSubstr("mend poses"),
                               Not(HasSubstr("sign of the normal"))));
}

TEST_F(DatasetChecksTest, FramesFromOne) {
  dataset.first_row = 1;
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("frame_numbers"), HasSubstr("counted from 1"),
                                            HasSubstr("subtract 1"))));
}

TEST_F(DatasetChecksTest, FramesThatBeginOneImageLate) {
  dataset.first_row = -1;
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("frame_numbers"), HasSubstr("begin one image late"),
                                HasSubstr("add 1"))));
}

TEST_F(DatasetChecksTest, EurocsPosesOfTheCamera) {
  WriteEuroc();
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, EurocsPosesThatNoBoxesTellOf) {
  WriteEuroc();
  dataset.has_object_ids = false;
  dataset.label = [](size_t) { return "ball"; };
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("pose_convention: EuRoC's poses"),
                                HasSubstr("nothing where the poses are those of the camera"))));
}

// Other mistakes than those of an IMU are told as in any format.
TEST_F(DatasetChecksTest, EurocsPosesTheOtherWayRound) {
  WriteEuroc([](const Rigid3d& pose) { return pose.Inverse(); });
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("if the poses are"), Not(HasSubstr("T_BS"))));
}

// An IMU that is turned by a quarter against the camera about its optical axis.
TEST_F(DatasetChecksTest, EurocsPosesOfAnImu) {
  const double half = std::sqrt(0.5);
  const Rigid3d camera_from_imu(Eigen::Quaterniond(half, 0, 0, -half), {0.1, 0, 0});
  WriteEuroc([&](const Rigid3d& pose) { return pose * camera_from_imu; });
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("pose_convention: EuRoC's poses"),
                                            HasSubstr("sensor.yaml, with T_BS"))));
  std::ofstream(folder / "sensor.yaml")
      << "T_BS:\n  data: [0, -1, 0, 0, 1, 0, 0, -0.1, 0, 0, 1, 0, 0, 0, 0, 1]\n"
         "resolution: [640, 480]\nintrinsics: [500, 500, 319.5, 239.5]\n";
  options.folder.camera_file = "sensor.yaml";
  EXPECT_THAT(Warnings(), IsEmpty());
}

// Things that all move like the camera, but faster, look as if poses were reversed.
TEST_F(DatasetChecksTest, ThingsThatMoveAreNoOtherConvention) {
  dataset.drive = true;
  dataset.ball_moves = 2.0;
  for (const std::string& warning : Warnings()) {
    EXPECT_THAT(warning, testing::Not(HasSubstr("error")));
  }
}

TEST_F(DatasetChecksTest, TrajectoriesOfAnotherScale) {
  dataset.has_truth = true;
  dataset.odometry = [](const Rigid3d& pose) {
    return Rigid3d{pose.rotation, 0.4 * pose.translation};
  };
  EXPECT_THAT(Warnings(), testing::Contains(HasSubstr("trajectory_against_truth")));
}

TEST_F(DatasetChecksTest, OdometryInItsOwnWorld) {
  dataset.has_truth = true;
  const Rigid3d own_from_world = dataset.WorldFromCamera(0).Inverse();
  dataset.odometry = [=](const Rigid3d& pose) { return own_from_world * pose; };
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("trajectory_against_truth"),
                                            HasSubstr("align_odometry"))));
  options.folder.align_odometry = true;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// Objects.

TEST_F(DatasetChecksTest, TrueObjectsWhereTheyAreSeen) {
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, IdsFromZeroInOneFile) {
  dataset.label = [](size_t) { return "ball"; };
  dataset.objects = dataset.TrueObjects(/*first_id=*/0, /*unit_m=*/1.0);
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("objects_against_boxes"),
                                            HasSubstr("subtract 1 from the object_id"))));
}

TEST_F(DatasetChecksTest, FullSizesForHalfAxes) {
  dataset.true_radius *= 2.0;
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("object_half_axes"), HasSubstr("full sizes"))));
}

// Cameras are within such objects, which have no outline then.
TEST_F(DatasetChecksTest, HalfAxesInCentimetres) {
  dataset.true_radius *= 100.0;
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("object_half_axes"), HasSubstr("centimetres"))));
}

TEST_F(DatasetChecksTest, HalfAxesInKilometres) {
  dataset.true_radius *= 1e-3;
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("object_half_axes"), HasSubstr("another unit"))));
}

// The rotation by 40 degrees about z with qw first.
TEST_F(DatasetChecksTest, TrueQuaternionsWithScalarFirst) {
  dataset.true_quaternion = "0.94, 0, 0, 0.342";
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("object_axes"), HasSubstr("qw first"))));
}

TEST_F(DatasetChecksTest, TrueObjectsInMillimetres) {
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1e-3);
  EXPECT_THAT(Warnings(), ElementsAre(HasSubstr("another world, unit or order of axes")));
}

// Planes.

TEST_F(DatasetChecksTest, NormalThatPointsDown) {
  dataset.plane = R"([{"id": 0, "normal": [0, 0, -1], "d": 0}])";
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("from below"), HasSubstr("sign of the normal")));
}

// Boxes of one label and without ids do not tell where the balls are.
TEST_F(DatasetChecksTest, NormalThatPointsDownWhereBoxesDoNotTell) {
  dataset.has_object_ids = false;
  dataset.label = [](size_t) { return "ball"; };
  dataset.plane = R"([{"id": 0, "normal": [0, 0, -1], "d": 0}])";
  EXPECT_THAT(Warnings(),
              ElementsAre(AllOf(HasSubstr("plane_side"), HasSubstr("may be the objects"))));
}

TEST_F(DatasetChecksTest, OffsetOfTheOtherSign) {
  dataset.height_of_floor = -2.0;
  dataset.plane = R"([{"id": 0, "normal": [0, 0, 1], "d": -2}])";
  EXPECT_THAT(Refusal(), HasSubstr("d of the other sign"));
}

// A table that a low camera looks up to.
TEST_F(DatasetChecksTest, CamerasBelowATable) {
  dataset.camera_height = -0.5;
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, WallForFloor) {
  dataset.plane = R"([{"id": 0, "normal": [1, 0, 0], "d": 5}])";
  EXPECT_THAT(Warnings(), ElementsAre(AllOf(HasSubstr("plane_attitude"), HasSubstr("a wall"))));
}

TEST_F(DatasetChecksTest, AFloorSeenByARolledCameraIsNoWall) {
  dataset.roll_rad = 0.5 * std::numbers::pi;
  EXPECT_THAT(Warnings(), IsEmpty());
}

// Clocks.

TEST_F(DatasetChecksTest, PosesInNanoseconds) {
  dataset.pose_time = [](double t) { return fmt::format("{:.0f}", 1e9 * t); };
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("0 of 24 images"), HasSubstr("poses in nanoseconds"),
                               HasSubstr("ratio 1e+09"), HasSubstr("divide")));
}

TEST_F(DatasetChecksTest, ImagesInMilliseconds) {
  dataset.image_time = [](double t) { return fmt::format("{:.0f}", 1e3 * t); };
  EXPECT_THAT(Refusal(), HasSubstr("images in milliseconds"));
}

TEST_F(DatasetChecksTest, BothInNanoseconds) {
  dataset.image_time = [](double t) { return fmt::format("{:.0f}", 1e9 * (t + 1.7e9)); };
  dataset.pose_time = [](double t) { return fmt::format("{:.0f}", 1e9 * (t + 1.7e9) + 3e6); };
  EXPECT_THAT(Refusal(), HasSubstr("images and poses in nanoseconds"));
}

TEST_F(DatasetChecksTest, AnotherClock) {
  dataset.pose_time = [](double t) { return fmt::format("{:.6f}", t + 5000.0); };
  EXPECT_THAT(Refusal(), AllOf(HasSubstr("other clocks"), HasSubstr("5000.000 apart")));
}

TEST_F(DatasetChecksTest, AClockThatJumps) {
  dataset.pose_time = [](double t) { return fmt::format("{:.6f}", t < 104.0 ? t : t + 5000.0); };
  EXPECT_THAT(Warnings(), testing::Contains(AllOf(HasSubstr("timestamps: 8 of 24 images"),
                                                  HasSubstr("max_time_difference_s"))));
}

TEST_F(DatasetChecksTest, EqualTimestamps) {
  dataset.image_time = [](double t) { return fmt::format("{:.0f}", std::floor(t)); };
  options.max_time_difference_s = 0.6;
  EXPECT_THAT(Warnings(), testing::Contains(
                              AllOf(HasSubstr("equal_timestamps"), HasSubstr("12 of 24 images"))));
}

}  // namespace
}  // namespace soslam
