// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "dataset/kitti_tracking.h"
#include "support/random.h"

namespace soslam {
namespace {

constexpr int kViews = 20;

// Views of one landmark from anywhere, its place in the world moved by `shift` from view to view.
std::vector<LabelledView> Views(const Landmark& in_world, const Eigen::Vector3d& shift) {
  std::vector<LabelledView> views;
  for (int i = 0; i < kViews; ++i) {
    Landmark moved = in_world;
    moved.frame_from_object.translation += i * shift;
    const Rigid3d world_from_camera = RandomRigid();
    views.push_back({world_from_camera, Transform(world_from_camera.Inverse(), moved)});
  }
  return views;
}

Landmark SomeLandmark() { return {RandomRigid(), {2.0, 0.8, 0.7}, kCuboidExponent}; }

TEST(SummariseTrack, FindsWhatStandsStill) {
  const Landmark landmark = SomeLandmark();
  auto views = Views(landmark, Eigen::Vector3d::Zero());
  // One wrong label among twenty.
  views[3].landmark_in_camera.frame_from_object.translation += Eigen::Vector3d(30, 0, 0);
  const TrackTruth truth = SummariseTrack(views, {});
  EXPECT_TRUE(truth.is_static);
  EXPECT_LT((truth.landmark_in_world.Centre() - landmark.Centre()).norm(), 1e-9);
  EXPECT_LT(truth.landmark_in_world.frame_from_object.rotation.angularDistance(
                landmark.frame_from_object.rotation),
            1e-6);
  EXPECT_LT((truth.landmark_in_world.half_axes - landmark.half_axes).norm(), 1e-9);
  const Eigen::Vector3d foot =
      landmark.frame_from_object * Eigen::Vector3d(0, 0, -landmark.half_axes.z());
  EXPECT_NEAR(truth.plane_in_world.SignedDistance(foot), 0.0, 1e-9);
  EXPECT_NEAR(truth.plane_in_world.SignedDistance(landmark.Centre()), 0.7, 1e-9);
}

TEST(SummariseTrack, OfWhatMovesTheFirstPlaceIsKept) {
  const Landmark landmark = SomeLandmark();
  const TrackTruth truth = SummariseTrack(Views(landmark, Eigen::Vector3d(0.5, 0, 0)), {});
  EXPECT_FALSE(truth.is_static);
  EXPECT_LT((truth.landmark_in_world.Centre() - landmark.Centre()).norm(), 1e-9);
}

TEST(SummariseTrack, SettingsDecide) {
  // Positions up to 0.95 m from their median.
  const auto views = Views(SomeLandmark(), Eigen::Vector3d(0, 0, 0.1));
  EXPECT_TRUE(SummariseTrack(views, {}).is_static);
  KittiOptions options;
  options.static_radius_m = 0.5;
  EXPECT_FALSE(SummariseTrack(views, options).is_static);
  options.static_share = 0.5;
  EXPECT_TRUE(SummariseTrack(views, options).is_static);
  options.static_min_views = kViews + 1;
  EXPECT_FALSE(SummariseTrack(views, options).is_static);
}

}  // namespace
}  // namespace soslam
