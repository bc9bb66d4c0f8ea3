// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "soslam/initialisation/initialise.h"
#include "soslam/initialisation/points_in_frames.h"
#include "support/cuboid_map.h"
#include "support/points_on_objects.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {
namespace {

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

// A point of the first body's vertical axis, this many half axes over its centre.
Eigen::Vector3d OnAxis(const Sequence& sequence, double half_axes) {
  const Landmark& body = TrueBody(sequence, 0);
  return body.frame_from_object * Eigen::Vector3d(0.0, 0.0, half_axes * body.half_axes.z());
}

TEST(FindObjectPointsTest, PointsOnThePlaneAndOutsideBoxesAreNotOfTheObject) {
  const Sequence sequence = CuboidSequence(1, 12);
  const auto found = FindObjectPoints(sequence,
                                      {Seen(sequence, OnAxis(sequence, -1.0)),  // the foot
                                       Seen(sequence, OnAxis(sequence, 3.0))},
                                      {});
  EXPECT_TRUE(found[0].empty());
}

// Options with which points of a scene without errors say much.
PointOptions ExactPoints() {
  PointOptions options;
  options.point_range_fraction = 0.0;
  options.effective_points = 100.0;
  return options;
}

TEST(PointsInFramesTest, AreInTheCameraOfEachDetection) {
  const Sequence sequence = CuboidSequence(1, 12);
  const Eigen::Vector3d top = OnAxis(sequence, 1.0);
  const PointsInFrames points(sequence, {Seen(sequence, top)}, {});
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Landmark in_camera = *TrueLandmarkInCamera(sequence, sequence.detections[i]);
    Landmark twice = in_camera;
    twice.half_axes *= 2.0;
    const auto evidence = points.Of(static_cast<int>(i), {{twice}, {in_camera}, {in_camera}});
    ASSERT_TRUE(evidence);
    ASSERT_EQ(evidence->points.size(), 1u);
    const Rigid3d world_from_camera = sequence.FrameOf(sequence.detections[i]).world_from_camera;
    EXPECT_LT((world_from_camera * evidence->points[0].position - top).norm(), 1e-6);
    EXPECT_EQ(evidence->size_m, SizeForPoints(in_camera));
  }
  EXPECT_FALSE(points.Of(0, {}));
}

// Where other segments are is not known, nor where a moving object was in other frames.
TEST(PointsInFramesTest, AreOfTheSegmentAndOfWhatStands) {
  Sequence sequence = CuboidSequence(1, 12);
  const std::vector<MapPoint> on_object = PointsOnObjects(sequence, 20);
  const std::vector<Hypothesis> hypotheses = {{TrueBody(sequence, 0)}};
  for (size_t i = 6; i < sequence.frames.size(); ++i) sequence.frames[i].segment = 1;
  std::vector<MapPoint> of_first = on_object;
  for (MapPoint& point : of_first) {
    std::erase_if(point.observations, [&](const PointObservation& observation) {
      return observation.frame_id >= sequence.frames[6].id;
    });
  }
  const PointsInFrames points(sequence, of_first, {});
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    EXPECT_EQ(points.Of(static_cast<int>(i), hypotheses).has_value(),
              sequence.FrameOf(sequence.detections[i]).segment == 0);
  }
  sequence.objects[0].is_static = false;
  EXPECT_FALSE(points.Of(0, hypotheses));
}

// Points on objects, and as many behind them and in front of them.
std::vector<MapPoint> PointsOfScene(const Sequence& sequence) {
  std::vector<MapPoint> points = PointsOnObjects(sequence, 60);
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    const Landmark& body = TrueBody(sequence, i);
    for (int k = 0; k < 60; ++k) {
      const Frame& frame = sequence.frames[static_cast<size_t>(k) % sequence.frames.size()];
      const Eigen::Vector3d in_body =
          body.frame_from_object * body.half_axes.cwiseProduct(RandomVector(-1.0, 1.0));
      const Eigen::Vector3d from_camera = in_body - frame.world_from_camera.translation;
      const double depth = k % 2 == 0 ? RandomUniform(1.3, 2.0) : RandomUniform(0.4, 0.8);
      points.push_back(Seen(sequence, frame.world_from_camera.translation + depth * from_camera));
    }
  }
  return points;
}

struct MeanErrors {
  double yaw = 0.0;       // rad, mean of the absolute values
  double log_size = 0.0;  // mean of the absolute logarithms of the half axes' ratios
};
MeanErrors MeanErrorsOf(const Sequence& sequence, const LandmarkEstimates& estimates) {
  MeanErrors errors;
  for (const ObservationEstimate& estimate : estimates.observations) {
    const Detection& detection = sequence.detections[estimate.detection_index];
    const Landmark truth = *TrueLandmarkInCamera(sequence, detection);
    const Landmark& found = estimate.hypotheses.front().landmark_in_camera;
    const auto yaw = [&](const Landmark& landmark) {
      return Yaw(detection.plane_in_camera.normal, landmark.frame_from_object.rotation);
    };
    const double share = 1.0 / static_cast<double>(estimates.observations.size());
    errors.yaw += share * std::abs(YawDifferenceModuloPi(yaw(found), yaw(truth)));
    errors.log_size +=
        share * (found.half_axes.array() / truth.half_axes.array()).log().abs().mean();
  }
  return errors;
}

// A box has two yaws, and boxes have errors.
TEST(PointsInFramesTest, MakeSingleFramesBetter) {
  const Sequence sequence = CuboidSequence(4, 8);
  const Sequence noisy = WithBoxNoise(sequence, 6.0);
  const auto priors = TrueCuboidPriors(sequence, 0.2);
  UprightOptions options;
  options.axes_weight = 0.0;
  const PointsInFrames points(noisy, PointsOfScene(sequence), ExactPoints());
  const MeanErrors without = MeanErrorsOf(sequence, InitialiseUpright(noisy, priors, options, 2));
  const MeanErrors with =
      MeanErrorsOf(sequence, InitialiseUpright(noisy, priors, options, 2, {}, &points));
  EXPECT_LT(with.yaw, 0.5 * without.yaw);
  EXPECT_LT(with.log_size, 0.7 * without.log_size);
}

}  // namespace
}  // namespace soslam
