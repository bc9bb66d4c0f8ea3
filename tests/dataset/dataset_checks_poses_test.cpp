// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <numeric>

#include "soslam/dataset/trajectories.h"
#include "support/dataset_checks_fixture.h"
#include "support/drawn_photos.h"

namespace soslam {
// The usual mistakes in poses and in the order of frames.
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

// While a camera looks at the middle of all things, a half turn hardly shows.
TEST_F(DatasetChecksTest, CamerasTurnedByHalfATurn) {
  dataset.sway = 0.3;
  EXPECT_THAT(Warnings(), IsEmpty());
  dataset.odometry = [](const Rigid3d& pose) { return TurnedAboutOpticalAxis(pose, 180.0); };
  ExpectRefused({"by half a turn about the camera's z axis"});
}

TEST_F(DatasetChecksTest, PosesInReversedOrder) {
  dataset.pose_of_frame = [](int frame) { return PlausibleDataset::kFrames - 1 - frame; };
  ExpectAmongWarnings({"frame_order: ", "reversed order"});
}

// 0, 1, 10, 11, ..., 2, ...
TEST_F(DatasetChecksTest, PosesOrBoxesInTheOrderOfStrings) {
  std::vector<int> order(PlausibleDataset::kFrames);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [](int frame) { return std::to_string(frame); });
  dataset.pose_of_frame = [&](int frame) { return order[frame]; };
  ExpectAmongWarnings({"frame_order: ", "the poses are in the order of strings"});
  dataset.pose_of_frame = [&](int frame) {
    return static_cast<int>(std::ranges::find(order, frame) - order.begin());
  };
  ExpectAmongWarnings({"frame_order: ", "boxes are in the order of strings"});
}

// Poses that were shuffled: no order or reading explains them.
TEST_F(DatasetChecksTest, PosesThatContradictTheBoxes) {
  dataset.pose_of_frame = [](int frame) { return frame * 7 % PlausibleDataset::kFrames; };
  dataset.objects = dataset.TrueObjects(/*first_id=*/1, /*unit_m=*/1.0);
  ExpectWarning(
      {"boxes_against_poses: 5 things are", "poses, the order of frames, or ids contradict"});
}

// It turns about z while the camera goes around.
TEST_F(DatasetChecksTest, PosesThatDrift) {
  dataset.odometry = [](const Rigid3d& pose) {
    const double turn_rad = 0.1 * std::atan2(pose.translation.y(), pose.translation.x());
    const Eigen::AngleAxisd turn(turn_rad, Eigen::Vector3d::UnitZ());
    return Rigid3d{Eigen::Quaterniond(turn), {0.0, 0.0, 5.0 * turn_rad}} * pose;
  };
  ExpectWarning({"poses that drift far"});
  dataset.has_truth = true;
  EXPECT_THAT(Warnings(), IsEmpty());
}

TEST_F(DatasetChecksTest, PlanesThroughPosesThatContradictTheBoxes) {
  dataset.pose_of_frame = [](int frame) { return frame * 7 % PlausibleDataset::kFrames; };
  dataset.plane = R"([{"id": 0, "normal": [0, 0, -1], "d": 0}])";
  EXPECT_THAT(Refusal(), testing::AllOf(HasSubstr("from below"), HasSubstr("mend poses"),
                                        Not(HasSubstr("sign of the normal"))));
}

TEST_F(DatasetChecksTest, FramesFromOneAndFramesThatBeginOneImageLate) {
  dataset.first_row = 1;
  ExpectWarning({"frame_numbers", "counted from 1", "subtract 1"});
  dataset.first_row = -1;
  ExpectWarning({"frame_numbers", "begin one image late", "add 1"});
}

// Poses of images 0.5 s apart, on a trajectory that is not uniform, with time stamps of another
// clock.
TEST_F(DatasetChecksTest, PosesThatLagAreMeasured) {
  dataset.sway = 0.5;
  options_.max_time_difference_s = 0.25;
  const auto expect_lag = [&](double late_s, const std::vector<std::string>& words) {
    SCOPED_TRACE(late_s);
    dataset.pose_time = [=](double t) { return fmt::format("{:.6f}", t + late_s); };
    ExpectAmongWarnings(words);
  };
  EXPECT_THAT(Warnings(), IsEmpty());
  expect_lag(1.0, {"pose_lag", "pose of 1 s later (2 images)", "lower the time stamps", "by 1 s"});
  expect_lag(-1.5, {"pose_lag", "pose of 1.5 s earlier (3 images)", "raise the time stamps"});
  expect_lag(0.7, {"pose_lag", "pose of 0.7", " later (1.4"});
  options_.max_time_difference_s = 5.0;
  expect_lag(1.0, {"pose_lag", "pose of 1 s later (2 images)"});
  ExpectAmongWarnings({"shared_poses", "frames 0 to 2", "a smaller max_time_difference_s"});
}

// Without images, boxes that move tell it.
TEST_F(DatasetChecksTest, PosesThatATrackerRepeats) {
  dataset.pose_of_frame = [](int frame) { return frame < 10 || frame > 15 ? frame : 10; };
  const std::vector<std::string> words = {"repeated_poses: 5 frames with exactly the pose",
                                          "frames 10 to 15", "lost"};
  ExpectAmongWarnings(words);
  WriteViews([](int frame) { return DrawnView(5 * frame, {640, 480}); });
  ExpectAmongWarnings(words);
  // From one image to the next but one, features are lost.
  WriteViews([](int frame) { return DrawnView(40 * frame, {640, 480}); });
  ExpectAmongWarnings(words);
  dataset.has_object_ids = false;
  dataset.label = [](size_t) { return "ball"; };
  ExpectAmongWarnings(words);
}

// Boxes move by 0.13 of half their diagonals.
TEST_F(DatasetChecksTest, ASlowCameraWhosePosesRepeat) {
  dataset.pose_of_frame = [](int frame) { return frame == 11 ? 10 : frame; };
  WriteViews([](int frame) { return DrawnView(5 * frame, {640, 480}); });
  ExpectAmongWarnings({"repeated_poses: 1 frame with", "frames 10 to 11"});
}

// Boxes of the arc, or of things that move before the camera, which images alone show to rest.
TEST_F(DatasetChecksTest, ImagesThatChangeBeforeACameraAtRest) {
  dataset.pose_of_frame = [](int frame) { return frame < 10 || frame > 15 ? frame : 10; };
  const cv::Mat view = DrawnView(0, {640, 480});
  cv::RNG random(3);
  const auto noisy = [&](cv::Mat image, double sigma) {
    cv::Mat noise(image.size(), CV_16SC3), sum;
    random.fill(noise, cv::RNG::NORMAL, 0.0, sigma);
    cv::add(image, noise, sum, cv::noArray(), CV_8U);
    return sum;
  };
  const auto expect_nothing = [&](const char* what, const std::function<cv::Mat(int)>& image) {
    SCOPED_TRACE(what);
    WriteViews([&](int frame) { return frame < 10 || frame > 15 ? view : image(frame); });
    EXPECT_THAT(Warnings(), Not(Contains(HasSubstr("repeated_poses"))));
  };
  const auto expect_no_motion = [&] {
    expect_nothing("nothing changes", [&](int) { return view; });
    expect_nothing("noise", [&](int) { return noisy(view, 12.0); });
    expect_nothing("light that is dimmed", [&](int frame) {
      return noisy(view * std::pow(0.75, std::max(0, frame - 10)), 2.0);
    });
    expect_nothing("soft images in light that is dimmed", [&](int frame) {
      return noisy(Blurred(view) * (frame > 10 ? 0.88 : 1.0), 2.0);
    });
    expect_nothing("a lamp that comes on at one side", [&](int frame) {
      cv::Mat lit = view.clone();
      for (int x = 0; frame > 10 && x < view.cols; ++x) {
        lit.col(x) = view.col(x) * (2.5 - 2.0 * x / view.cols);
      }
      return noisy(lit, 4.0);
    });
    expect_nothing("a picture that passes", [&](int frame) {
      cv::Mat passed = view.clone();
      const int x = 40 * (frame - 10);
      if (x < 0 || x > 400) return passed;
      DrawnView(900, {640, 480})(cv::Rect(0, 0, 240, 480)).copyTo(passed(cv::Rect(x, 0, 240, 480)));
      return passed;
    });
  };
  expect_no_motion();
  dataset.has_object_ids = false;
  dataset.label = [](size_t) { return "ball"; };
  expect_no_motion();
  expect_nothing("darkness", [&](int frame) { return noisy(frame > 10 ? 0.0 * view : view, 2.0); });
}

// A slow camera, whose boxes move by less than their noise.
TEST_F(DatasetChecksTest, ImagesThatMoveDecideAgainstBoxes) {
  dataset.pose_of_frame = [](int frame) { return frame < 10 || frame > 15 ? frame : 10; };
  dataset.view_of_boxes = dataset.pose_of_frame;
  WriteViews([](int frame) { return DrawnView(5 * frame, {640, 480}); });
  EXPECT_THAT(Warnings(), Contains(HasSubstr("repeated_poses: 5 frames")));
}

// The lag that repeated poses have is not reported as another mistake.
TEST_F(DatasetChecksTest, EverySecondPoseIsThatBefore) {
  dataset.sway = 0.5;
  dataset.pose_of_frame = [](int frame) { return frame / 2 * 2; };
  EXPECT_THAT(Warnings(), testing::Not(Contains(HasSubstr("pose_lag"))));
}

TEST_F(DatasetChecksTest, PosesThatLagBesideRepeatedOnes) {
  dataset.sway = 0.5;
  dataset.pose_of_frame = [](int frame) { return frame < 10 || frame > 15 ? frame : 10; };
  dataset.pose_time = [](double t) { return fmt::format("{:.6f}", t + 1.0); };
  options_.max_time_difference_s = 0.25;
  const auto warnings = Warnings();
  EXPECT_THAT(warnings, Contains(testing::StartsWith("repeated_poses: 5 frames")));
  EXPECT_THAT(warnings, Contains(testing::AllOf(testing::StartsWith("pose_lag"),
                                                HasSubstr("pose of 1 s later (2 images)"))));
}

TEST_F(DatasetChecksTest, EurocsPosesOfTheCameraWithAndWithoutBoxesThatTell) {
  WriteEuroc();
  EXPECT_THAT(Warnings(), IsEmpty());
  dataset.has_object_ids = false;
  dataset.label = [](size_t) { return "ball"; };
  ExpectWarning(
      {"pose_convention: EuRoC's poses", "nothing where the poses are those of the camera"});
}

// Other mistakes than those of an IMU are told as in any format.
TEST_F(DatasetChecksTest, EurocsPosesTheOtherWayRound) {
  WriteEuroc([](const Rigid3d& pose) { return pose.Inverse(); });
  EXPECT_THAT(Refusal(), testing::AllOf(HasSubstr("if the poses are"), Not(HasSubstr("T_BS"))));
}

// An IMU that is turned by a quarter against the camera about its optical axis.
TEST_F(DatasetChecksTest, EurocsPosesOfAnImu) {
  const double half = std::sqrt(0.5);
  const Rigid3d camera_from_imu{Eigen::Quaterniond(half, 0, 0, -half), {0.1, 0, 0}};
  WriteEuroc([&](const Rigid3d& pose) { return pose * camera_from_imu; });
  ExpectWarning({"pose_convention: EuRoC's poses", "sensor.yaml, with T_BS"});
  Write("sensor.yaml",
        "T_BS:\n  data: [0, -1, 0, 0, 1, 0, 0, -0.1, 0, 0, 1, 0, 0, 0, 0, 1]\n"
        "resolution: [640, 480]\nintrinsics: [500, 500, 319.5, 239.5]\n");
  options_.folder.camera_file = "sensor.yaml";
  EXPECT_THAT(Warnings(), IsEmpty());
}

// Things that all move like the camera, but faster, look as if poses were reversed.
TEST_F(DatasetChecksTest, ThingsThatMoveAreNoOtherConvention) {
  dataset.drive = true;
  dataset.ball_moves = 2.0;
  for (const std::string& warning : Warnings()) {
    EXPECT_THAT(warning, Not(HasSubstr("error")));
  }
}

TEST_F(DatasetChecksTest, TrajectoriesOfAnotherScale) {
  dataset.has_truth = true;
  dataset.odometry = [](const Rigid3d& pose) {
    return Rigid3d{pose.rotation, 0.4 * pose.translation};
  };
  ExpectAmongWarnings({"trajectory_against_truth"});
}

TEST_F(DatasetChecksTest, OdometryInItsOwnWorld) {
  dataset.has_truth = true;
  const Rigid3d own_from_world = dataset.WorldFromCamera(0).Inverse();
  dataset.odometry = [=](const Rigid3d& pose) { return own_from_world * pose; };
  ExpectWarning({"trajectory_against_truth", "align_odometry"});
  options_.folder.align_odometry = true;
  EXPECT_THAT(Warnings(), IsEmpty());
}

}  // namespace

// Poses written in other conventions than the expected one.
namespace {

struct WrittenPose {
  std::string name;
  std::string words;
  Rigid3d (*write)(const Rigid3d& world_from_camera);
};

void PrintTo(const WrittenPose& pose, std::ostream* stream) { *stream << pose.name; }

Eigen::Quaterniond WithScalarFirst(const Eigen::Quaterniond& q) {
  return Eigen::Quaterniond(/*w=*/q.z(), /*x=*/q.w(), /*y=*/q.x(), /*z=*/q.y());
}

// A camera with y up and z backward; a body with x forward, y left and z up.
const Rigid3d kCameraFromOpenGl{Eigen::Quaterniond(0, 1, 0, 0), Eigen::Vector3d::Zero()};
const Rigid3d kCameraFromBody{Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), Eigen::Vector3d::Zero()};

const std::vector<WrittenPose> kWrittenPoses = {
    {"Inverse", "the other way round", [](const Rigid3d& p) { return p.Inverse(); }},
    {"ScalarFirst", "quaternions qw qx qy qz",
     [](const Rigid3d& p) {
       return Rigid3d{WithScalarFirst(p.rotation), p.translation};
     }},
    {"Colmap", "COLMAP's images.txt",
     [](const Rigid3d& p) {
       return Rigid3d{WithScalarFirst(p.Inverse().rotation), p.Inverse().translation};
     }},
    {"OpenGl", "OpenGL", [](const Rigid3d& p) { return p * kCameraFromOpenGl; }},
    {"OpenGlInverse", "view matrices of OpenGL",
     [](const Rigid3d& p) { return (p * kCameraFromOpenGl).Inverse(); }},
    {"OpenGlScalarFirst", "OpenGL, with quaternions qw qx qy qz",
     [](const Rigid3d& p) {
       return Rigid3d{WithScalarFirst((p * kCameraFromOpenGl).rotation), p.translation};
     }},
    {"InverseRotation", "rotation matrices that were transposed",
     [](const Rigid3d& p) {
       return Rigid3d{p.rotation.conjugate(), p.translation};
     }},
    {"InverseTranslation", "translations of camera_from_world",
     [](const Rigid3d& p) {
       return Rigid3d{p.rotation, p.Inverse().translation};
     }},
    {"CentreInverted", "taken for the translation of camera_from_world",
     [](const Rigid3d& p) {
       return Rigid3d{p.rotation, -(p.rotation * p.translation)};
     }},
    {"QuarterTurn", "turn the cameras by 90 degrees",
     [](const Rigid3d& p) { return TurnedAboutOpticalAxis(p, -90); }},
    {"QuarterTurnBack", "turn the cameras by -90 degrees",
     [](const Rigid3d& p) { return TurnedAboutOpticalAxis(p, 90); }},
    {"RosBody", "as ROS has them", [](const Rigid3d& p) { return p * kCameraFromBody; }},
    {"MirroredCentre", "the translations' x",
     [](const Rigid3d& p) {
       return Rigid3d{p.rotation, p.translation.cwiseProduct(Eigen::Vector3d(-1, 1, 1))};
     }},
    {"LeftHanded", "as Unity has them", &MirroredInY},
    {"SwappedYAndZ", "y and z swapped", [](const Rigid3d& p) {
       const Eigen::Vector3d& t = p.translation;
       return Rigid3d{p.rotation, {t.x(), t.z(), t.y()}};
     }}};

class PoseConventionTest : public DatasetChecksTest,
                           public testing::WithParamInterface<WrittenPose> {};

TEST_P(PoseConventionTest, IsNamedWithAndWithoutObjectIds) {
  dataset.odometry = GetParam().write;
  for (const bool has_object_ids : {true, false}) {
    dataset.has_object_ids = has_object_ids;
    ExpectRefused({GetParam().words});
  }
}

INSTANTIATE_TEST_SUITE_P(All, PoseConventionTest, testing::ValuesIn(kWrittenPoses),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace soslam
