// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "association/association.h"
#include "support/association_scenes.h"

namespace soslam {
namespace {

constexpr int kShelfScenes = 4;

// Boxes of objects on the floor and on a shelf, without ids.
struct ShelfScene {
  Sequence given;
  Sequence seen;
};

ShelfScene OnFloorAndShelf(int seed, double shelf_height_m) {
  Scene scene = WithShelf(LabelledScene(seed, 6, 30, {"thing"}), shelf_height_m);
  scene.noise.box_edge_sigma = 0.01;
  const Sequence given = SyntheticSequence(scene, false);
  return {given, WithoutIds(given)};
}

Sequence WithUnknownSupports(Sequence sequence) {
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  return sequence;
}

Sequence Associated(const Sequence& seen, const Association& association) {
  return AssociatedSequence(seen, association,
                            CompareWithGiven(seen, association, /*min_observations=*/3));
}

TEST(SupportsTest, AreFoundFromBoxes) {
  double sum = 0.0;
  int right = 0;
  int all = 0;
  for (int seed = 0; seed < kShelfScenes; ++seed) {
    const auto [given, seen] = OnFloorAndShelf(seed, 1.0);
    const Sequence unknown = WithUnknownSupports(seen);
    ASSERT_FALSE(unknown.HasSupports());
    const Association association = Associate(unknown, UnknowingTable(), EstimatedAssociation(), 2);
    const Agreement agreement = CompareWithGiven(given, association, 3);
    sum += agreement.F1().value();
    const Sequence associated = Associated(unknown, association);
    EXPECT_TRUE(associated.HasSupports());
    for (size_t i = 0; i < associated.objects.size(); ++i) {
      if (!agreement.given_of_object[i]) continue;
      const auto of_given = static_cast<size_t>(*agreement.given_of_object[i]);
      ++all;
      right += associated.objects[i].plane_index == given.objects[of_given].plane_index;
    }
  }
  EXPECT_GE(sum / kShelfScenes, 0.85);
  EXPECT_GE(right, 0.9 * all) << right << " of " << all;
}

// The plane of each detection in its camera is that of its object.
TEST(SupportsTest, DetectionsHaveThePlanesOfTheirObjects) {
  const auto [given, seen] = OnFloorAndShelf(1, 1.0);
  const Sequence unknown = WithUnknownSupports(seen);
  const Sequence associated =
      Associated(unknown, Associate(unknown, UnknowingTable(), EstimatedAssociation(), 2));
  ASSERT_FALSE(associated.detections.empty());
  for (const Detection& detection : associated.detections) {
    const auto plane = static_cast<size_t>(associated.ObjectOf(detection).plane_index);
    const Plane expected = Transform(associated.FrameOf(detection).world_from_camera.Inverse(),
                                     associated.planes[plane].plane_in_world);
    EXPECT_NEAR((detection.plane_in_camera.normal - expected.normal).norm(), 0.0, 1e-12);
    EXPECT_NEAR(detection.plane_in_camera.offset, expected.offset, 1e-12);
  }
}

// Objects on a shelf that is not among the planes have no place in the map where their boxes tell;
// none on the floor is mistaken for one of them.
TEST(SupportsTest, WhatStandsOnNoPlaneIsNoObject) {
  SemanticTable table = UnknowingTable();
  table.default_prior->height_m = LogNormal{0.5, 0.5};
  int without_support = 0;
  for (int seed = 1; seed < 6; ++seed) {
    const auto [given, seen] = OnFloorAndShelf(seed, 0.8);
    Sequence floor_only = seen;
    floor_only.planes.resize(1);
    for (Object& object : floor_only.objects) object.plane_index = 0;
    const Association association = Associate(floor_only, table, EstimatedAssociation(), 2);
    for (const Track& track : association.tracks) {
      if (track.fate != TrackFate::kNoSupport) continue;
      const auto first = static_cast<size_t>(track.detections.front());
      const Object& object = seen.ObjectOf(seen.detections[first]);
      EXPECT_EQ(object.plane_index, 1) << seed;
      ++without_support;
    }
  }
  EXPECT_GE(without_support, 5);
}

TEST(MovingLabelsTest, ThingsThatMoveAreNoObjects) {
  const Sequence given = SyntheticSequence(LabelledScene(3, 4, 30, {"dog", "cup"}), false);
  const Association association =
      Associate(WithoutIds(given), UnknowingTable(), EstimatedAssociation(), 2);
  ASSERT_EQ(association.objects.size(), 2U);
  for (const int object : association.objects) {
    EXPECT_EQ(LabelOf(association.tracks[object]), "cup");
  }
}

// Objects of two labels that the detector calls by one name are told apart by their boxes.
TEST(LabelEvidenceTest, BoxesDecideAmongSimilarLabels) {
  Scene scene = LabelledScene(5, 6, 40, {"cup"});
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    scene.objects[i].shape = Shape::kBox;
    scene.objects[i].half_axes =
        i % 2 == 0 ? Eigen::Vector3d(0.2, 0.2, 0.4) : Eigen::Vector3d(0.45, 0.45, 0.15);
  }
  const Sequence given = SyntheticSequence(scene, false);
  SemanticTable table;
  table.priors["cup"] = {{0.5, 0.5}, {0.1, 0.1}, kCuboidExponent, 0.0, LogNormal{0.8, 0.1}};
  table.priors["mug"] = {{3.0, 3.0}, {0.1, 0.1}, kCuboidExponent, 0.0, LogNormal{0.3, 0.1}};
  AssociateOptions options = EstimatedAssociation();
  options.similar_labels = "cup, mug";
  const Association association = Associate(WithoutIds(given), table, options, 2);
  const Agreement agreement = CompareWithGiven(given, association, 3);
  ASSERT_GE(association.objects.size(), 4U);
  for (size_t i = 0; i < association.objects.size(); ++i) {
    const auto object = static_cast<size_t>(agreement.given_of_object[i].value());
    const Track& track = association.tracks[association.objects[i]];
    EXPECT_EQ(track.labels.front().label, object % 2 == 0 ? "cup" : "mug");
    EXPECT_EQ(LabelOf(track), "cup");  // what it is called
  }
}

}  // namespace
}  // namespace soslam
