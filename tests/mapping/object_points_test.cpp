// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/object_points.h"

#include <gtest/gtest.h>

#include "evaluation/metrics.h"
#include "mapping/initial_landmarks.h"
#include "support/cuboid_map.h"
#include "support/random.h"

namespace soslam {
namespace {

// The point as all frames see it that have it in their image.
MapPoint Seen(const Sequence& sequence, const Eigen::Vector3d& point_in_world) {
  MapPoint point{Eigen::Vector3d::Zero(), 0.1, {}};  // positions are not used
  for (const Frame& frame : sequence.frames) {
    const auto pixel = sequence.camera.Project(frame.world_from_camera.Inverse() * point_in_world);
    if (pixel && sequence.camera.IsInside(*pixel)) point.observations.push_back({frame.id, *pixel});
  }
  return point;
}

const Landmark& TrueBody(const Sequence& sequence, size_t object_index) {
  return sequence.objects[object_index].ground_truth->landmark_in_world;
}

// Points on the faces of all objects that can be seen, without occlusion.
std::vector<MapPoint> PointsOnObjects(const Sequence& sequence, int count) {
  std::vector<MapPoint> points;
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    const Landmark& body = TrueBody(sequence, i);
    for (int k = 0; k < count; ++k) {
      Eigen::Vector3d in_object = body.half_axes.cwiseProduct(RandomVector(-1.0, 1.0));
      in_object[k % 3] = std::copysign(body.half_axes[k % 3], in_object[k % 3]);
      if (k % 3 == 2) in_object.z() = body.half_axes.z();  // the top, not the foot
      points.push_back(Seen(sequence, body.frame_from_object * in_object));
    }
  }
  return points;
}

TEST(FindObjectPointsTest, PointsOfAnObjectAreInItsBoxes) {
  const Sequence sequence = CuboidSequence(1, 12);
  const std::vector<MapPoint> points = PointsOnObjects(sequence, 60);
  const auto found = FindObjectPoints(sequence, points, {});
  ASSERT_EQ(found.size(), 1u);
  size_t count = 0;
  for (const PointsInView& view : found[0]) {
    const Detection& detection = sequence.detections[view.detection_index];
    EXPECT_EQ(detection.object_index, 0);
    for (const ObjectPoint& point : view.points) {
      const auto pixel = sequence.camera.Project(point.position);
      ASSERT_TRUE(pixel);
      EXPECT_TRUE(detection.box.Contains(*pixel));
      EXPECT_LE(point.prior, 0.7);
      ++count;
    }
  }
  EXPECT_GT(count, 40u);
}

TEST(FindObjectPointsTest, PointsOnThePlaneAndOutsideBoxesAreNotOfTheObject) {
  const Sequence sequence = CuboidSequence(1, 12);
  const Landmark& body = TrueBody(sequence, 0);
  const Eigen::Vector3d foot =
      body.frame_from_object * Eigen::Vector3d(0.0, 0.0, -body.half_axes.z());
  const Eigen::Vector3d above =
      body.frame_from_object * Eigen::Vector3d(0.0, 0.0, 3.0 * body.half_axes.z());
  const auto found = FindObjectPoints(sequence, {Seen(sequence, foot), Seen(sequence, above)}, {});
  EXPECT_TRUE(found[0].empty());
}

TEST(FindObjectPointsTest, TheWorldOfThePointsDoesNotMatter) {
  const Sequence sequence = CuboidSequence(1, 12);
  const Eigen::Vector3d top = TrueBody(sequence, 0).frame_from_object *
                              Eigen::Vector3d(0.0, 0.0, TrueBody(sequence, 0).half_axes.z());
  MapPoint point = Seen(sequence, top);
  point.position_in_world = {100.0, 200.0, 300.0};
  const auto found = FindObjectPoints(sequence, {point}, {});
  ASSERT_EQ(found[0].size(), 1u);
  const Detection& detection = sequence.detections[found[0][0].detection_index];
  const Eigen::Vector3d in_world =
      sequence.FrameOf(detection).world_from_camera * found[0][0].points[0].position;
  EXPECT_LT((in_world - top).norm(), 1e-6);
}

// The worlds of segments have nothing in common.
TEST(FindObjectPointsTest, ViewsOfOtherSegmentsDoNotMatter) {
  const Sequence sequence = CuboidSequence(1, 12);
  const Eigen::Vector3d top = TrueBody(sequence, 0).frame_from_object *
                              Eigen::Vector3d(0.0, 0.0, TrueBody(sequence, 0).half_axes.z());
  const MapPoint point = Seen(sequence, top);
  Sequence two = sequence;
  for (size_t i = 6; i < two.frames.size(); ++i) {
    two.frames[i].segment = 1;
    two.frames[i].world_from_camera = RandomRigid() * two.frames[i].world_from_camera;
  }
  const auto found = FindObjectPoints(two, {point}, {});
  bool is_in_first = false;
  for (const PointsInView& view : found[0]) {
    const Frame& frame = two.FrameOf(two.detections[view.detection_index]);
    if (frame.segment != 0) continue;
    is_in_first = true;
    EXPECT_LT((frame.world_from_camera * view.points[0].position - top).norm(), 1e-6);
  }
  EXPECT_TRUE(is_in_first);
}

TEST(PointWeightTest, BoundsTheExpectedNumber) {
  PointOptions options;
  options.effective_points = 6.0;
  const ObjectPoint point{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Zero(), 0.5};
  const auto weight = [&](size_t count) {
    return PointWeight({{0, std::vector<ObjectPoint>(count, point)}}, options);
  };
  EXPECT_EQ(weight(10), 1.0);
  EXPECT_NEAR(weight(120), 0.1, 1e-12);
}

// Boxes with errors, and little known of the ratios.
TEST(TangencyBackEnd, PointsImproveWhatBoxesSay) {
  const Sequence sequence = CuboidSequence(3, 8);
  Sequence noisy = sequence;
  for (Detection& detection : noisy.detections) {
    detection.box.x_min += RandomUniform(-6, 6);
    detection.box.y_min += RandomUniform(-6, 6);
    detection.box.x_max += RandomUniform(-6, 6);
    detection.box.y_max += RandomUniform(-6, 6);
  }
  BackEndInput input = TruthInput(noisy);
  for (auto& prior : input.priors) prior->log_sigma = {0.3, 0.3};
  OptimiseOptions options = TangencyOptions();
  options.points.effective_points = 100.0;
  options.points.point_range_fraction = 0.0;
  const auto mean_iou = [&] {
    return EvaluateMap(sequence, OptimiseMap(input, options)).summary.iou_mean.value();
  };
  const double boxes = mean_iou();
  input.points = FindObjectPoints(noisy, PointsOnObjects(sequence, 100), options.points);
  const double points = mean_iou();
  EXPECT_GT(points, boxes + 0.02);
}

// With the options as they are shipped, points that are exact do not harm boxes with errors.
TEST(TangencyBackEnd, PointsWithDefaultWeightsDoNoHarm) {
  const Sequence sequence = CuboidSequence(3, 8);
  Sequence noisy = sequence;
  for (Detection& detection : noisy.detections) {
    detection.box.x_max += RandomUniform(-6, 6);
    detection.box.y_min += RandomUniform(-6, 6);
  }
  BackEndInput input = TruthInput(noisy);
  for (auto& prior : input.priors) prior->log_sigma = {0.3, 0.3};
  const OptimiseOptions options = TangencyOptions();
  const auto mean_iou = [&] {
    return EvaluateMap(sequence, OptimiseMap(input, options)).summary.iou_mean.value();
  };
  const double boxes = mean_iou();
  input.points = FindObjectPoints(noisy, PointsOnObjects(sequence, 100), options.points);
  EXPECT_GT(mean_iou(), boxes - 0.01);
}

TEST(TangencyBackEnd, ObjectsWithoutPointsAreCounted) {
  const Sequence sequence = CuboidSequence(3, 8);
  BackEndInput input = TruthInput(sequence);
  input.points.resize(sequence.objects.size());
  EXPECT_EQ(OptimiseMap(input, TangencyOptions()).solver.gated.at("objects_without_points"), 3);
}

}  // namespace
}  // namespace soslam
