// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "soslam/association/agreement.h"
#include "soslam/association/association.h"
#include "soslam/association/association_model.h"
#include "soslam/association/up_estimate.h"
#include "soslam/geometry/angles.h"
#include "support/association_scenes.h"
#include "support/looking_at.h"
#include "support/random.h"
#include "support/scene.h"

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

Sequence OnFloorAlone(Sequence sequence) {
  sequence.planes.resize(1);
  for (Object& object : sequence.objects) object.plane_index = 0;
  return sequence;
}

Sequence WithUnknownSupports(Sequence sequence) {
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  return sequence;
}

TEST(SupportsTest, AreFoundFromBoxes) {
  double sum = 0.0;
  int right = 0;
  int all = 0;
  for (int seed = 0; seed < kShelfScenes; ++seed) {
    const auto [given, seen] = OnFloorAndShelf(seed, 1.0);
    const Sequence unknown = WithUnknownSupports(seen);
    ASSERT_FALSE(unknown.HasSupports());
    const Association association =
        Associate(unknown, UnknowingTable(), PairEvidence(), EstimatedAssociation(), 2);
    const Agreement agreement = CompareWithGiven(given, association, 3);
    sum += agreement.F1().value();
    const Sequence associated =
        AssociatedSequence(unknown, association, CompareWithGiven(unknown, association, 3));
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

// Objects on a shelf that is not among the planes have no place in the map where their boxes tell;
// none on the floor is mistaken for one of them.
TEST(SupportsTest, WhatStandsOnNoPlaneIsNoObject) {
  SemanticTable table = UnknowingTable();
  table.default_prior->height_m = LogNormal{0.5, 0.5};
  int without_support = 0;
  for (int seed = 1; seed < 6; ++seed) {
    const auto [given, seen] = OnFloorAndShelf(seed, 0.8);
    const Association association =
        Associate(OnFloorAlone(seen), table, PairEvidence(), EstimatedAssociation(), 2);
    for (const Track& track : association.tracks) {
      if (track.fate != TrackFate::kNoSupport) continue;
      const auto first = static_cast<size_t>(track.detections.front());
      const Object& object = seen.ObjectOf(seen.detections[first]);
      EXPECT_EQ(object.plane_index, 1) << seed;
      ++without_support;
    }
  }
  EXPECT_GE(without_support, 3);
}

// The same where the detector calls them by the name of much lower things.
TEST(SupportsTest, WhatIsOfASimilarLabelOnNoPlaneIsNoObjectEither) {
  SemanticTable table;
  table.priors["other"] = *UnknowingTable().default_prior;
  table.priors["other"].height_m = LogNormal{0.5, 0.5};
  table.priors["thing"] = {{5.0, 5.0}, {0.1, 0.1}, kCuboidExponent, 0.0, LogNormal{0.1, 0.1}};
  AssociateOptions options = EstimatedAssociation();
  options.similar_labels = "thing, other";
  options.similar_label_confusion = 0.3;
  int without_support = 0;
  for (int seed = 1; seed < 6; ++seed) {
    const auto [given, seen] = OnFloorAndShelf(seed, 0.8);
    for (const Track& track :
         Associate(OnFloorAlone(seen), table, PairEvidence(), options, 2).tracks) {
      if (track.fate != TrackFate::kNoSupport) continue;
      const auto first = static_cast<size_t>(track.detections.front());
      EXPECT_EQ(seen.ObjectOf(seen.detections[first]).plane_index, 1) << seed;
      ++without_support;
    }
  }
  EXPECT_GE(without_support, 1);
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
  options.similar_label_confusion = 0.3;  // half of them are mugs
  const Association association = Associate(WithoutIds(given), table, PairEvidence(), options, 2);
  const Agreement agreement = CompareWithGiven(given, association, 3);
  ASSERT_GE(association.objects.size(), 4U);
  for (size_t i = 0; i < association.objects.size(); ++i) {
    const auto object = static_cast<size_t>(agreement.given_of_object[i].value());
    const Track& track = association.tracks[association.objects[i]];
    EXPECT_EQ(track.labels.front().label, object % 2 == 0 ? "cup" : "mug");
    EXPECT_EQ(LabelOf(track), "cup");  // what it is called
  }
}

// The floor suits nothing that is on a wall, but a similar label that stands.
TEST(LabelEvidenceTest, WhereNoPlaneSuitsALabelASimilarOneIsFitted) {
  const Sequence sequence =
      WithUnknownSupports(SyntheticSequence(LabelledScene(11, 1, 30, {"screen"}), false));
  SemanticTable table;
  table.priors["monitor"] = *UnknowingTable().default_prior;
  table.priors["monitor"].height_m = LogNormal{0.5, 0.5};
  table.priors["monitor"].edge_bias = {0.0, 0.0, 0.0, -0.25};
  table.priors["screen"] = table.priors["monitor"];
  table.priors["screen"].mount = Mount::kOnWall;
  table.priors["screen"].edge_bias = {0.0, 0.0, 0.0, -0.5};
  AssociateOptions options = EstimatedAssociation();
  const auto fitted = [&](const char* similar_labels) {
    options.similar_labels = similar_labels;
    Track track;
    track.detections = DetectionsByObject(sequence)[0];
    track.votes["screen"] = 1.0;
    AssociationModel(sequence, table, options).Fit(&track);
    return track;
  };
  EXPECT_FALSE(fitted("").fit);
  const Track track = fitted("screen, monitor");
  ASSERT_TRUE(track.fit);
  EXPECT_EQ(track.fit_label, "monitor");
  const int frame = sequence.detections[track.detections.front()].frame_index;
  const auto prediction = AssociationModel(sequence, table, options).Predict(track, frame);
  ASSERT_TRUE(prediction);
  EXPECT_EQ(prediction->edge_bias, table.Find(LabelOf(track))->edge_bias);
}

// The rotation of a camera that looks along the world's x axis, with z up.
Eigen::Quaterniond LevelCamera() {
  return LookingAt(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitX()).rotation;
}

Sequence SequenceOf(const std::vector<Eigen::Quaterniond>& rotations) {
  Sequence sequence;
  for (const Eigen::Quaterniond& rotation : rotations) {
    Frame frame;
    frame.id = static_cast<int>(sequence.frames.size());
    frame.world_from_camera = {rotation, Eigen::Vector3d::Zero()};
    sequence.frames.push_back(frame);
  }
  return sequence;
}

// The horizon of one camera leans as it is rolled, about its x axis it may be pitched.
TEST(UpEstimateTest, OneCameraIsAsUncertainAsItIsHeld) {
  AssociateOptions options;
  options.tilt.roll_sigma_deg = 4.0;
  options.tilt.pitch_sigma_deg = 20.0;
  const UpEstimate up = UpOfSegments(SequenceOf({LevelCamera()}), SemanticTable(), options).at(0);
  EXPECT_NEAR((up.up_in_world - Eigen::Vector3d::UnitZ()).norm(), 0.0, 1e-12);
  const Eigen::Vector3d variances = Eigen::Vector3d(4.0, 20.0, 0.0).array().square();
  const Eigen::Matrix3d expected = (kRadPerDeg * kRadPerDeg * variances).asDiagonal();
  EXPECT_LT((up.covariance - expected).norm(), 1e-9);
}

// Cameras all around that look down by half a right angle and are rolled by the given sigma.
TEST(UpEstimateTest, ErrorsAreAsLargeAsTheCovarianceSays) {
  constexpr int kTrials = 200;
  const AssociateOptions options;
  double sum = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<Eigen::Quaterniond> rotations;
    for (int i = 0; i < 6; ++i) {
      const Eigen::AngleAxisd heading(i * std::numbers::pi / 3.0, Eigen::Vector3d::UnitZ());
      const Eigen::AngleAxisd pitch(-45.0 * kRadPerDeg, Eigen::Vector3d::UnitX());
      const Eigen::AngleAxisd roll(options.tilt.roll_sigma_deg * kRadPerDeg * RandomNormal(),
                                   Eigen::Vector3d::UnitZ());
      rotations.push_back(heading * LevelCamera() * pitch * roll);
    }
    const UpEstimate up = UpOfSegments(SequenceOf(rotations), SemanticTable(), options).at(0);
    const Eigen::Vector3d error = up.up_in_world.cross(Eigen::Vector3d::UnitZ());
    const Eigen::Matrix3d about_up = up.up_in_world * up.up_in_world.transpose();
    sum += error.dot((up.covariance + about_up).inverse() * error);
  }
  // Chi-square with two degrees of freedom: the mean of 200 has a standard deviation of 0.14.
  // Attitudes that are exact in pitch add information that is not used.
  EXPECT_GT(sum / kTrials, 0.5);
  EXPECT_LT(sum / kTrials, 2.5);
}

// Which end is up does not matter.
TEST(UpEstimateTest, SingleBoxesSayHowCamerasAreRolled) {
  for (int quarters = 0; quarters < 4; ++quarters) {
    const UpEstimate up =
        UpOfSegments(Rolled(PostsAndMats(), quarters), TableOfPostsAndMats(), AssociateOptions())
            .at(0);
    EXPECT_GT(std::abs(up.up_in_world.z()), std::cos(25.0 * kRadPerDeg)) << quarters;
    EXPECT_LT(up.covariance.norm(), 0.3) << quarters;
  }
}

// Spreads as of labels that stand for many things.
TEST(UpEstimateTest, OtherWaysToHoldCamerasAreNamedWithTheirProbabilities) {
  const auto up_with = [](double log_sigma) {
    return UpOfSegments(Rolled(PostsAndMats(), 1), TableOfPostsAndMats(log_sigma),
                        AssociateOptions())
        .at(0);
  };
  const UpEstimate clear = up_with(0.3);
  EXPECT_EQ(clear.orientation, CameraOrientation::kRolled90);
  EXPECT_EQ(clear.orientation_tilt_variance, 0.0);
  const UpEstimate open = up_with(0.5);
  EXPECT_EQ(open.orientation, CameraOrientation::kRolled90);
  EXPECT_GT(open.orientation_tilt_variance, 0.0);
  double sum = 0.0;
  for (const TriedOrientation& tried : open.orientations) sum += tried.probability;
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

TEST(UpEstimateTest, AGroundThatIsKnownIsNotGuessed) {
  Sequence sequence = Rolled(PostsAndMats(), 1);
  PointGround& ground = sequence.ground.emplace();
  ground.up_in_world = {0.0, 0.6, 0.8};
  const Eigen::Matrix3d across =
      Eigen::Matrix3d::Identity() - ground.up_in_world * ground.up_in_world.transpose();
  ground.up_information = 1e4 * across;
  const UpEstimate up =
      UpOfSegments(sequence, TableOfPostsAndMats(), AssociateOptions()).begin()->second;
  EXPECT_EQ(up.up_in_world, ground.up_in_world);
  EXPECT_LT((up.covariance - 1e-4 * across).norm(), 1e-9);
  EXPECT_TRUE(up.orientations.empty());
}

// A table that says nothing leaves cameras level, and no surer of it.
TEST(UpEstimateTest, BoxesThatSayNothingMakeNothingSurer) {
  const Sequence sequence = PostsAndMats();
  Sequence without = sequence;
  without.detections.clear();
  const auto with_boxes = UpOfSegments(sequence, SemanticTable(), AssociateOptions()).at(0);
  const auto alone = UpOfSegments(without, SemanticTable(), AssociateOptions()).at(0);
  EXPECT_EQ(with_boxes.up_in_world, alone.up_in_world);
  const Eigen::Matrix3d added = with_boxes.covariance - alone.covariance;
  EXPECT_GE(added.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-12);
}

}  // namespace
}  // namespace soslam
