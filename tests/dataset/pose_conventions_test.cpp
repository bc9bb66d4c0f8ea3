// SPDX-License-Identifier: BSD-3-Clause
// Poses written in other conventions than the expected one.

#include "dataset/trajectories.h"
#include "support/dataset_checks_fixture.h"

namespace soslam {
namespace {

using testing::HasSubstr;

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
const Rigid3d kCameraFromOpenGl(Eigen::Quaterniond(0, 1, 0, 0), Eigen::Vector3d::Zero());
const Rigid3d kCameraFromBody(Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), Eigen::Vector3d::Zero());

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
    EXPECT_THAT(Refusal(), HasSubstr(GetParam().words));
  }
}

INSTANTIATE_TEST_SUITE_P(All, PoseConventionTest, testing::ValuesIn(kWrittenPoses),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace soslam
