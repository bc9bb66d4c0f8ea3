// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/fit_track.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/association_scenes.h"

namespace soslam {
namespace {

// One box tells how large the body would be at each distance, the prior's height how far it is.
TEST(FitObjectWithoutPlanesTest, OneBoxGivesABodyOfThePriorsHeight) {
  const AssociateOptions options = EstimatedAssociation();
  const Sequence sequence =
      WithoutPlanes(SyntheticSequence(LabelledScene(3, 1, 30, {"box"}), false));
  const UpEstimate up = UpOfSegments(sequence, SemanticTable(), options).at(0);
  for (const double height_m : {0.2, 2.0}) {
    ShapePrior prior = *UnknowingTable().default_prior;
    prior.height_m = LogNormal{height_m, 0.3};
    const auto object = FitTrack(sequence, {0}, prior, options, up);
    ASSERT_TRUE(object);
    EXPECT_NEAR(2.0 * object->landmark_in_world.half_axes.z() / height_m, 1.0,
                0.02);  // as far as the fit gets along its valley
    const Detection& detection = sequence.detections[0];
    const Rigid3d world_from_camera = sequence.FrameOf(detection).world_from_camera;
    const Landmark in_camera = Transform(world_from_camera.Inverse(), object->landmark_in_world);
    EXPECT_LT(OutlineEdgeRms(sequence.camera, in_camera, detection.box),
              0.05 * detection.box.Width());
    // Along the ray it is known as well as the height is.
    const Eigen::Vector3d ray = world_from_camera.translation - object->landmark_in_world.Centre();
    const Eigen::Matrix3d covariance = object->covariance.block<3, 3>(3, 3);
    const double sigma = std::sqrt(ray.normalized().dot(covariance * ray.normalized()));
    EXPECT_NEAR(sigma / ray.norm(), 0.3, 0.05);
  }
}

// The lower half of a thing whose height is known is hidden in all views, as that of a chair behind
// a table: as low as it looks, it would stand farther away.
TEST(FitObjectTest, ThingsWithHiddenFeetStandWhereTheyAre) {
  Scene scene = LabelledScene(4, 1, 40, {"chair"});
  scene.objects[0].half_axes = {0.25, 0.25, 0.45};
  scene.objects[0].shape = Shape::kBox;
  scene.objects[0].position_on_plane = {3.0, 0.0};
  scene.trajectory.waypoints = {{{0.3, -1.2, 1.5}, {3.0, 0.0, 0.4}},
                                {{0.0, 0.0, 1.5}, {3.0, 0.0, 0.4}},
                                {{0.3, 1.2, 1.5}, {3.0, 0.0, 0.4}}};
  Sequence sequence = SyntheticSequence(scene, false);
  const Landmark truth = sequence.objects[0].ground_truth->landmark_in_world;
  const Plane plane = sequence.planes[0].plane_in_world;
  std::vector<int> all;
  for (size_t i = 0; i < sequence.detections.size(); ++i) all.push_back(static_cast<int>(i));
  const ShapePrior prior = {{0.55, 0.55}, {0.2, 0.2}, kCuboidExponent, 0.0, LogNormal{0.9, 0.1}};
  const AssociateOptions options = EstimatedAssociation();
  const auto whole = FitTrack(sequence, all, prior, options, plane);
  ASSERT_TRUE(whole);
  EXPECT_FALSE(whole->feet_are_hidden);
  EXPECT_LT((whole->landmark_in_world.Centre() - truth.Centre()).norm(), 0.1);

  for (Detection& detection : sequence.detections) {
    detection.box.y_max -= 0.5 * detection.box.Height();
  }
  const auto hidden = FitTrack(sequence, all, prior, options, plane);
  ASSERT_TRUE(hidden);
  EXPECT_TRUE(hidden->feet_are_hidden);
  EXPECT_LT((hidden->landmark_in_world.Centre() - truth.Centre()).norm(), 0.15);
  const auto as_seen =
      FitTrack(sequence, all, prior, options, plane, {.feet_may_be_hidden = false});
  ASSERT_TRUE(as_seen);
  EXPECT_GT((as_seen->landmark_in_world.Centre() - truth.Centre()).norm(), 0.3);
}

// A fit from the landmark that it ends at is that of the whole profile.
TEST(FitObjectTest, StartsReplaceTheProfile) {
  const Sequence sequence = SyntheticSequence(LabelledScene(4, 1, 40, {"box"}), false);
  const Plane plane = sequence.planes[0].plane_in_world;
  const ShapePrior prior = *UnknowingTable().default_prior;
  const AssociateOptions options = EstimatedAssociation();
  const auto fit = FitTrack(sequence, {0, 3, 6}, prior, options, plane);
  ASSERT_TRUE(fit);
  const auto again =
      FitTrack(sequence, {0, 3, 6}, prior, options, plane, {.starts = {fit->landmark_in_world}});
  ASSERT_TRUE(again);
  EXPECT_NEAR(again->cost, fit->cost, 1e-3);
  EXPECT_NEAR(again->prior_cost, fit->prior_cost, 1e-3);
}

// An object that is seen from many sides.
class OverlapByBoxesTest : public testing::Test {
 protected:
  OverlapByBoxesTest() {
    for (size_t i = 0; i < sequence_.detections.size(); ++i) all_.push_back(static_cast<int>(i));
  }
  double Overlap() const {
    const auto object =
        FitTrack(sequence_, all_, prior_, options_, sequence_.planes[0].plane_in_world);
    return object ? OverlapByBoxes(sequence_, all_, prior_, options_, *object) : -1.0;
  }

  AssociateOptions options_ = EstimatedAssociation();
  ShapePrior prior_ = *UnknowingTable().default_prior;
  Sequence sequence_ = SyntheticSequence(LabelledScene(4, 1, 40, {"box"}), false);
  std::vector<int> all_;
};

TEST_F(OverlapByBoxesTest, GrowsToOneWithBetterBoxes) {
  const double before = Overlap();
  EXPECT_GT(before, 0.25);
  options_.upright.detection_sigma_fraction = 1e-3;  // with a floor of 1 px
  EXPECT_GT(Overlap(), before);
  EXPECT_LE(Overlap(), 1.0);
}

TEST_F(OverlapByBoxesTest, IsNearZeroWhereAllEdgesAreCutOff) {
  const auto object =
      FitTrack(sequence_, all_, prior_, options_, sequence_.planes[0].plane_in_world);
  ASSERT_TRUE(object);
  for (Detection& detection : sequence_.detections) {
    detection.is_one_sided = {true, true, true, true};
  }
  EXPECT_LT(OverlapByBoxes(sequence_, all_, prior_, options_, *object), 0.01);
}

// Every edge is seen in some images, none in all.
TEST_F(OverlapByBoxesTest, NeedsNoWholeBox) {
  for (size_t i = 0; i < sequence_.detections.size(); ++i) {
    sequence_.detections[i].is_one_sided[i % 4] = true;
  }
  EXPECT_GT(Overlap(), 0.25);
}

TEST_F(OverlapByBoxesTest, DoesNotCountWhatTheLabelTells) {
  const auto object =
      FitTrack(sequence_, all_, prior_, options_, sequence_.planes[0].plane_in_world);
  ASSERT_TRUE(object);
  ShapePrior sure = prior_;
  sure.log_sigma.setConstant(1e-3);
  sure.height_m = LogNormal{1.0, 1e-3};
  EXPECT_EQ(OverlapByBoxes(sequence_, all_, sure, options_, *object),
            OverlapByBoxes(sequence_, all_, prior_, options_, *object));
}

}  // namespace
}  // namespace soslam
