// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "model/segments.h"
#include "report/page_parts.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

constexpr size_t kFloor = 0;

TEST(CameraAbovePlane, SeesEstimatedPlanesWhereTheDetectionDoes) {
  Sequence sequence = CuboidSequence(3, 5);
  sequence.planes[kFloor].attitude_information = Eigen::Matrix3d::Identity();
  for (Detection& detection : sequence.detections) {
    // The boxes of one frame differ from odometry by some degrees and centimetres.
    const Rigid3d off = {ExpRotation(RandomVector(-0.1, 0.1)), RandomVector(-0.1, 0.1)};
    detection.plane_in_camera = Transform(off, detection.plane_in_camera);
    const Rigid3d camera_from_world = CameraAbovePlane(sequence, detection);
    const Plane seen = Transform(camera_from_world, sequence.planes[kFloor].plane_in_world);
    EXPECT_LT((seen.Homogeneous() - detection.plane_in_camera.Homogeneous()).norm(), 1e-9);
  }
}

TEST(CameraAbovePlane, SeesGivenPlanesFromTheTruePose) {
  Sequence sequence = CuboidSequence(3, 5);
  for (Frame& frame : sequence.frames) {
    frame.true_world_from_camera = frame.world_from_camera;
    frame.world_from_camera.translation += Eigen::Vector3d(0.5, 0.2, 0.1);
  }
  const Detection& detection = sequence.detections.front();
  const Rigid3d camera_from_world = CameraAbovePlane(sequence, detection);
  const Rigid3d& truth = *sequence.FrameOf(detection).true_world_from_camera;
  EXPECT_LT(((camera_from_world * truth).Matrix() - Eigen::Matrix4d::Identity()).norm(), 1e-9);
}

TEST(GridsOfMap, AreOnThePlanesOfTheMap) {
  const Sequence sequence = CuboidSequence(3, 5);
  MapEstimate map;
  map.planes_in_world = {{Eigen::Vector3d(0.1, 0.0, 1.0).normalized(), 0.2}};
  map.objects.push_back({1, 5, sequence.objects[1].ground_truth->landmark_in_world, {}, ""});
  const PlaneGrids grids = GridsOfMap(map, sequence);
  ASSERT_EQ(grids.size(), 1u);
  ASSERT_FALSE(grids[kFloor].empty());
  for (const LineSegment3& line : grids[kFloor]) {
    EXPECT_NEAR(map.planes_in_world[kFloor].SignedDistance(line[0]), 0.0, 1e-9);
    EXPECT_NEAR(map.planes_in_world[kFloor].SignedDistance(line[1]), 0.0, 1e-9);
  }
  EXPECT_TRUE(GridsOfMap({}, sequence).empty());
}

TEST(UpOfSegment, IsTheFloorsAndNotTheWalls) {
  Sequence sequence = CuboidSequence(3, 5);
  const Plane floor = sequence.planes[kFloor].plane_in_world;
  const Eigen::Vector3d sideways = floor.normal.unitOrthogonal();
  sequence.planes.insert(sequence.planes.begin(), {1, {sideways, 2.0}});
  sequence.planes.push_back({2, {-floor.normal, 3.0}});
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    sequence.objects[i].plane_index = static_cast<int>(i);
  }
  EXPECT_LT((UpOfSegment(sequence, 0) - floor.normal).norm(), 1e-12);
}

TEST(UpOfSegment, IsThatOfTheImagesWithoutAFloor) {
  Sequence sequence = CuboidSequence(3, 5);
  const Eigen::Vector3d normal = sequence.planes[kFloor].plane_in_world.normal;
  sequence.planes[kFloor].plane_in_world.normal = normal.unitOrthogonal();
  EXPECT_GT(UpOfSegment(sequence, 0).dot(normal), 0.7);
  EXPECT_NEAR(UpOfSegment(sequence, 1).norm(), 1.0, 1e-12);  // none of its frames
}

}  // namespace
}  // namespace soslam
