// SPDX-License-Identifier: BSD-3-Clause
// Poses written in other conventions than the expected one.

#include "support/dataset_checks_fixture.h"

namespace soslam {
namespace {

using testing::HasSubstr;

struct WrittenPose {
  std::string name;
  Rigid3d (*write)(const Rigid3d& world_from_camera);
  std::string words;
};

void PrintTo(const WrittenPose& pose, std::ostream* stream) { *stream << pose.name; }

Eigen::Quaterniond WithScalarFirst(const Eigen::Quaterniond& q) {
  return Eigen::Quaterniond(/*w=*/q.z(), /*x=*/q.w(), /*y=*/q.x(), /*z=*/q.y());
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
        WrittenPose{"QuarterTurn",
                    [](const Rigid3d& pose) { return TurnedAboutOpticalAxis(pose, -90); },
                    "turn the cameras by 90 degrees"},
        WrittenPose{"QuarterTurnBack",
                    [](const Rigid3d& pose) { return TurnedAboutOpticalAxis(pose, 90); },
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

}  // namespace
}  // namespace soslam
