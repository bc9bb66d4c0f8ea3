// SPDX-License-Identifier: BSD-3-Clause
#include "planes/planes_estimate.h"

#include <gtest/gtest.h>

#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

Sequence ShelfSequence() {
  return SyntheticSequence(WithShelf(RandomScene(1, 4, 12, {Shape::kBox}), 0.3), false);
}

// Two planes of any attitude; objects stand on one and the other in turn.
PlanesEstimate AnyEstimate(const Sequence& sequence) {
  PlanesEstimate estimate;
  for (int i = 0; i < 2; ++i) {
    EstimatedPlane plane;
    plane.plane_in_world = RandomPlane();
    plane.point_in_world = -plane.plane_in_world.offset * plane.plane_in_world.normal;
    estimate.planes.push_back(plane);
  }
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    estimate.objects.push_back({static_cast<int>(i % 2), SupportReason::kOwnHeight, {}, {}, {}});
  }
  return estimate;
}

TEST(WithPlanes, CarriesThePlanesIntoEveryFrame) {
  const Sequence sequence = ShelfSequence();
  const PlanesEstimate estimate = AnyEstimate(sequence);
  const Sequence with = WithPlanes(sequence, estimate);
  ASSERT_EQ(with.planes.size(), 2u);
  EXPECT_EQ(with.planes[1].id, 1);
  ASSERT_EQ(with.detections.size(), sequence.detections.size());
  for (const Detection& detection : with.detections) {
    const int plane_index = detection.object_index % 2;
    EXPECT_EQ(with.objects[detection.object_index].plane_index, plane_index);
    const Plane& in_world = estimate.planes[plane_index].plane_in_world;
    const Frame& frame = with.frames[detection.frame_index];
    const Eigen::Vector3d point_in_camera = RandomVector(-2, 2);
    EXPECT_NEAR(detection.plane_in_camera.SignedDistance(point_in_camera),
                in_world.SignedDistance(frame.world_from_camera * point_in_camera), 1e-9);
  }
}

TEST(CompareWithGiven, MeasuresAgainstThePlaneOfMost) {
  const Sequence sequence = ShelfSequence();
  PlanesEstimate estimate = AnyEstimate(sequence);
  // Tilted by 0.02 rad, 0.1 m over the shelf at its point.
  estimate.planes[1].plane_in_world.normal = {std::sin(0.02), 0.0, std::cos(0.02)};
  estimate.planes[1].point_in_world = {1.0, 2.0, 0.4};
  const auto error = CompareWithGiven(sequence, estimate, 1);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->given_plane_index, 1);
  EXPECT_NEAR(error->angle, 0.02, 1e-12);
  EXPECT_NEAR(error->offset, 0.1, 1e-12);
}

TEST(CompareWithGiven, IsNoneForAPlaneOfNoObject) {
  const Sequence sequence = ShelfSequence();
  PlanesEstimate estimate = AnyEstimate(sequence);
  for (ObjectSupport& support : estimate.objects) support.plane_index = 0;
  EXPECT_FALSE(CompareWithGiven(sequence, estimate, 1));
}

// A camera that drives level 1.65 m over z = 0, and an object beside the way.
TEST(PlanesBelowCameras, IsTheGroundUnderALevelDrive) {
  Sequence sequence;
  Eigen::Matrix3d axes;
  axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;  // forward along x
  for (int i = 0; i < 5; ++i) {
    Frame frame;
    frame.id = i;
    frame.world_from_camera = {Eigen::Quaterniond(axes), {i * 1.0, 0.3, 1.65}};
    sequence.frames.push_back(frame);
  }
  sequence.planes = {{0, RandomPlane()}};
  sequence.objects = {{1, "car", 0, {}}, {2, "car", 0, {}}};
  sequence.detections = {{1, 0, 1.0, {10, 10, 50, 50}, {}, {}, {}}};
  const PlanesEstimate estimate = PlanesBelowCameras(sequence, 1.65);
  ASSERT_EQ(estimate.planes.size(), 2u);
  for (const EstimatedPlane& plane : estimate.planes) {
    EXPECT_LT((plane.plane_in_world.normal - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(plane.plane_in_world.offset, 0.0, 1e-12);
    EXPECT_FALSE(plane.covariance);
  }
  EXPECT_NEAR(estimate.planes[0].point_in_world.x(), 1.0, 1e-12);
  EXPECT_EQ(estimate.objects[0].reason, SupportReason::kCameraHeight);
  EXPECT_EQ(estimate.objects[1].reason, SupportReason::kNoViews);
  const Plane in_camera = WithPlanes(sequence, estimate).detections[0].plane_in_camera;
  const Plane ground = GroundInCamera(1.65);
  EXPECT_LT((in_camera.normal - ground.normal).norm(), 1e-12);
  EXPECT_NEAR(in_camera.offset, ground.offset, 1e-12);
}

}  // namespace
}  // namespace soslam
