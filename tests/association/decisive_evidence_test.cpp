// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/decisive_evidence.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/association_scenes.h"

namespace soslam {
namespace {

constexpr int kViews = 10;
constexpr int kPoints = 12;

// Things side by side that a camera drives past, with points in the middle of each box.
class DecisiveEvidenceTest : public testing::Test {
 protected:
  DecisiveEvidenceTest() {
    Scene scene = LabelledScene(2, 3, kViews, {"thing"});
    for (size_t i = 0; i < scene.objects.size(); ++i) {
      scene.objects[i].half_axes = {0.15, 0.15, 0.2};
      scene.objects[i].shape = Shape::kBox;
      scene.objects[i].position_on_plane = {4.0, static_cast<double>(i) - 1.0};
    }
    scene.trajectory.waypoints = {{{0.0, -1.0, 1.1}, {4.0, 0.0, 0.3}},
                                  {{0.0, 1.0, 1.1}, {4.0, 0.0, 0.3}}};
    given_ = SyntheticSequence(scene, false);
    seen_ = WithoutIds(given_);
  }

  // Tracks of points of each object; in the frame with index `beside` they are outside its boxes.
  std::vector<PointTrack> Tracks(int beside = -1) const {
    std::vector<PointTrack> tracks(3 * kPoints);
    for (const Detection& detection : given_.detections) {
      Eigen::Vector2d pixel = detection.box.Centre();
      if (detection.frame_index == beside) pixel.y() = detection.box.y_max + 5.0;
      for (int k = 0; k < kPoints; ++k) {
        tracks[detection.object_index * kPoints + k].observations.push_back(
            {given_.FrameOf(detection).id, pixel});
      }
    }
    return tracks;
  }

  Association Run(const PairEvidence& points) const {
    return Associate(seen_, UnknowingTable(), points, EstimatedAssociation(), 2);
  }
  // The index of the detection that is named.
  int IndexOf(const Associations::DetectionName& name) const {
    for (int i = 0; i < std::ssize(seen_.detections); ++i) {
      const Associations::DetectionName known = NameOfDetection(seen_, i);
      if (known.frame == name.frame && known.box == name.box) return i;
    }
    return -1;
  }

  Sequence given_, seen_;
};

TEST_F(DecisiveEvidenceTest, PairsHaveTheEvidenceOfTheirBoxes) {
  const PairEvidence points(seen_, ImageMatches{Tracks()});
  const Association association = Run(points);
  ASSERT_EQ(association.objects.size(), 3u);
  ASSERT_EQ(association.held_least.size(), 9u);
  ASSERT_EQ(association.held_most.size(), 9u);
  for (const auto* rows : {&association.held_least, &association.held_most}) {
    for (const Associations::PairRow& row : *rows) {
      const int one = IndexOf(row.one), other = IndexOf(row.other);
      ASSERT_TRUE(one >= 0 && other >= 0);
      EXPECT_LT(row.one.frame, row.other.frame);
      for (const int index : {one, other}) {
        EXPECT_EQ(association.detections[index].object + 1, row.object);
      }
      EXPECT_EQ(row.evidence.points_in_both, kPoints);
      EXPECT_EQ(row.evidence.points_in_any, kPoints);
      EXPECT_EQ(row.evidence.points, points.LogRatio(one, other));
      EXPECT_GT(row.evidence.body, 0.0);  // boxes where the body predicts them
      // There is no other label, which any object has.
      EXPECT_NEAR(row.evidence.labels, 2.0 * std::log(1.0 - EstimatedAssociation().label_confusion),
                  1e-9);
    }
  }
}

TEST_F(DecisiveEvidenceTest, BoxesWithoutTheirPointsAreHeldLeast) {
  constexpr int kBeside = 4;
  const Association association = Run(PairEvidence(seen_, ImageMatches{Tracks(kBeside)}));
  ASSERT_EQ(association.objects.size(), 3u);
  const int frame = seen_.frames[kBeside].id;
  for (const Associations::PairRow& row : association.held_least) {
    EXPECT_TRUE(row.one.frame == frame || row.other.frame == frame);
    EXPECT_EQ(row.evidence.points_in_both, 0);
    EXPECT_LT(row.evidence.points, 0.0);
  }
  for (const Associations::PairRow& row : association.held_most) {
    EXPECT_TRUE(row.one.frame != frame && row.other.frame != frame);
    EXPECT_GT(row.evidence.points, 0.0);
  }
  EXPECT_TRUE(std::ranges::is_sorted(association.held_least, {},
                                     [](const auto& row) { return row.evidence.points; }));
}

TEST_F(DecisiveEvidenceTest, NeighboursAreKeptOut) {
  const Association association = Run(PairEvidence(seen_, ImageMatches{Tracks()}));
  ASSERT_EQ(association.kept_out.size(), 6u);  // two neighbours of each
  for (const Associations::KeptOutRow& row : association.kept_out) {
    EXPECT_NE(association.objects[row.object - 1], row.track);
    EXPECT_EQ(row.boxes, kViews);
    EXPECT_EQ(row.frames_with_both, kViews);
    EXPECT_EQ(association.detections[IndexOf(row.nearest)].track, row.track);
    // Each box shares none of its own points and of those of the other with all other frames.
    EXPECT_EQ(row.evidence.points_in_both, 0);
    EXPECT_EQ(row.evidence.points_in_any, 2 * kPoints * kViews * (kViews - 1));
    EXPECT_LT(row.evidence.points, 0.0);
    EXPECT_LT(row.evidence.body, 0.0);
  }
}

TEST_F(DecisiveEvidenceTest, BodiesAreAllThatIsKnownWithoutPoints) {
  const Association association = Run(PairEvidence());
  ASSERT_EQ(association.held_least.size(), 9u);
  ASSERT_EQ(association.kept_out.size(), 6u);
  for (const Associations::PairRow& row : association.held_least) {
    EXPECT_EQ(row.evidence.points_in_any, 0);
    EXPECT_EQ(row.evidence.points, 0.0);
    EXPECT_GT(row.evidence.body, 0.0);
  }
  const auto body = [](const Associations::PairRow& row) {
    return row.evidence.body + row.evidence.labels;
  };
  EXPECT_TRUE(std::ranges::is_sorted(association.held_least, {}, body));
  EXPECT_LE(body(association.held_least.back()), body(association.held_most.front()));
}

}  // namespace
}  // namespace soslam
