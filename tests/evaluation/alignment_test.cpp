// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/evaluation/alignment.h"

#include <gtest/gtest.h>

#include "support/lists.h"
#include "support/random.h"

namespace soslam {
namespace {

// Poses of a camera whose centres are these, and as another world and unit have them.
std::vector<PosePair> MovePath(const std::vector<Eigen::Vector3d>& centres,
                               const Rigid3d& truth_from_scaled, double scale) {
  std::vector<PosePair> pairs;
  for (const Eigen::Vector3d& centre : centres) {
    const Rigid3d truth{RandomRotation(), centre};
    Rigid3d estimated = truth_from_scaled.Inverse() * truth;
    estimated.translation /= scale;
    pairs.push_back({estimated, truth});
  }
  return pairs;
}

std::vector<Eigen::Vector3d> RandomCentres(int count) {
  std::vector<Eigen::Vector3d> centres;
  for (int i = 0; i < count; ++i) centres.push_back(RandomVector(-2.0, 2.0));
  return centres;
}

void ExpectTrue(const Alignment& alignment, const std::vector<PosePair>& pairs) {
  EXPECT_NEAR(alignment.rmse_m.value(), 0.0, 1e-9);
  for (const auto& [estimated, truth] : pairs) {
    const Rigid3d aligned = alignment.Apply(estimated);
    EXPECT_LT((aligned.translation - truth.translation).norm(), 1e-9);
    EXPECT_LT(aligned.rotation.angularDistance(truth.rotation), 1e-7);
  }
}

TEST(AlignTest, UndoesAnyMotionAndScale) {
  for (int trial = 0; trial < 20; ++trial) {
    const auto rigid = MovePath(RandomCentres(6), RandomRigid(), 1.0);
    ExpectTrue(Align(rigid, AlignmentKind::kRigid), rigid);
    const double scale = RandomUniform(0.1, 10.0);
    const auto scaled = MovePath(RandomCentres(6), RandomRigid(), scale);
    const Alignment alignment = Align(scaled, AlignmentKind::kSimilarity);
    EXPECT_EQ(alignment.kind, AlignmentKind::kSimilarity);
    EXPECT_EQ(alignment.path, CameraPath::kGeneral);
    EXPECT_NEAR(alignment.scale, scale, 1e-9 * scale);
    ExpectTrue(alignment, scaled);
    const Rigid3d& truth = scaled[0].truth;
    const Rigid3d back = alignment.Apply(alignment.Inverse().Apply(truth));
    EXPECT_LT((back.translation - truth.translation).norm(), 1e-9);
    EXPECT_LT(back.rotation.angularDistance(truth.rotation), 1e-7);
  }
}

// The rotation about the line is that of the cameras; the scale is that of the centres.
TEST(AlignTest, CentresOnALineTakeTheRotationOfTheCameras) {
  const Eigen::Vector3d direction = RandomVector(-1.0, 1.0);
  for (const std::vector<double>& ways : {std::vector{0.0, 0.4}, std::vector{0.0, 0.4, 1.0, 1.7}}) {
    std::vector<Eigen::Vector3d> centres;
    for (const double way : ways) centres.emplace_back(way * direction);
    const auto pairs = MovePath(centres, RandomRigid(), 2.5);
    const Alignment alignment = Align(pairs, AlignmentKind::kSimilarity);
    EXPECT_EQ(alignment.path, CameraPath::kLine);
    EXPECT_NEAR(alignment.scale, 2.5, 1e-9);
    ExpectTrue(alignment, pairs);
  }
}

TEST(AlignTest, ACameraThatStandsStillTellsNoScale) {
  const auto pairs = MovePath(std::vector<Eigen::Vector3d>(4, {1, 2, 3}), RandomRigid(), 1.0);
  const Alignment alignment = Align(pairs, AlignmentKind::kSimilarity);
  EXPECT_EQ(alignment.kind, AlignmentKind::kRigid);
  EXPECT_EQ(alignment.path, CameraPath::kStill);
  EXPECT_EQ(alignment.scale, 1.0);
  ExpectTrue(alignment, pairs);
}

TEST(AlignTest, AnEstimateThatStandsStillTellsNoScale) {
  auto pairs = MovePath(RandomCentres(9), RandomRigid(), 1.0);
  const Eigen::Vector3d place = pairs[0].estimated.translation;
  for (PosePair& pair : pairs) pair.estimated.translation = place + RandomVector(-1e-5, 1e-5);
  const Alignment alignment = Align(pairs, AlignmentKind::kSimilarity);
  EXPECT_EQ(alignment.path, CameraPath::kUnrelated);
  EXPECT_EQ(alignment.kind, AlignmentKind::kRigid);
  EXPECT_EQ(alignment.scale, 1.0);
}

// Centres a few millimetres off a line, and as uncertain: the cameras' rotations are exact.
TEST(AlignTest, AShortPathTakesTheRotationOfTheCameras) {
  std::vector<Eigen::Vector3d> centres;
  for (int i = 0; i < 12; ++i) centres.emplace_back(0.01 * i, 0.004 * (i % 2), 0.0);
  const Rigid3d truth_from_scaled = RandomRigid();
  auto pairs = MovePath(centres, truth_from_scaled, 1.0);
  for (PosePair& pair : pairs) pair.estimated.translation += RandomVector(-0.002, 0.002);
  const Alignment alignment = Align(pairs, AlignmentKind::kRigid);
  EXPECT_EQ(alignment.path, CameraPath::kLine);
  EXPECT_LT(alignment.truth_from_scaled.rotation.angularDistance(truth_from_scaled.rotation), 1e-7);
}

TEST(AlignTest, FewPoses) {
  EXPECT_EQ(Align({}, AlignmentKind::kRigid).kind, AlignmentKind::kNone);
  EXPECT_FALSE(Align({}, AlignmentKind::kRigid).rmse_m);
  const auto one = MovePath(RandomCentres(1), RandomRigid(), 1.0);
  const Alignment alignment = Align(one, AlignmentKind::kRigid);
  EXPECT_EQ(alignment.path, CameraPath::kFewPoses);
  ExpectTrue(alignment, one);
}

class AlignSegmentsTest : public testing::Test {
 protected:
  // A sequence whose odometry is this motion of the truth away.
  static Sequence Make(const Rigid3d& truth_from_scaled, double scale) {
    Sequence sequence;
    for (const auto& [estimated, truth] : MovePath(RandomCentres(8), truth_from_scaled, scale)) {
      sequence.frames.push_back({0, 0.0, "", estimated, truth});
    }
    return sequence;
  }
  static Alignments Of(const Sequence& sequence, AlignmentKind choice) {
    return AlignSegments(sequence, PosesOf(sequence), choice);
  }
  static AlignmentKind AutoKind(const Sequence& sequence) {
    return Of(sequence, AlignmentKind::kAuto).of_segment.at(0).kind;
  }
  const Rigid3d elsewhere_{ExpRotation({0, 0, 1.5}), {9, 0, 0}};
  const Rigid3d drift_{ExpRotation({0.02, -0.01, 0.03}), {0.1, 0.0, -0.1}};
};

TEST_F(AlignSegmentsTest, AutoTellsOneWorldFromAnother) {
  EXPECT_EQ(AutoKind(Make(drift_, 1.0)), AlignmentKind::kNone);
  EXPECT_EQ(AutoKind(Make(elsewhere_, 1.0)), AlignmentKind::kRigid);
  EXPECT_EQ(AutoKind(Make(elsewhere_, 4.0)), AlignmentKind::kSimilarity);
}

// Whatever the odometry of single frames says.
TEST_F(AlignSegmentsTest, AutoIsNotMovedByAWrongPose) {
  Sequence sequence = Make(drift_, 1.0);
  sequence.frames[3].world_from_camera.translation.x() += 40.0;
  EXPECT_EQ(AutoKind(sequence), AlignmentKind::kNone);
}

TEST_F(AlignSegmentsTest, AutoScalesWhereOnlyAScaleFits) {
  for (const double scale : {0.7, 1.3}) {
    EXPECT_EQ(AutoKind(Make(elsewhere_, scale)), AlignmentKind::kSimilarity);
  }
  Sequence short_path = Make(elsewhere_, 1.0);
  for (Frame& frame : short_path.frames) {
    frame.world_from_camera.translation *= 0.05;
    frame.true_world_from_camera->translation *= 0.02;
  }
  EXPECT_EQ(AutoKind(short_path), AlignmentKind::kSimilarity);
}

TEST_F(AlignSegmentsTest, TwoPosesTellAnotherWorldAndNoScale) {
  Sequence sequence = Make(elsewhere_, 2.0);
  for (size_t i = 2; i < sequence.frames.size(); ++i) {
    sequence.frames[i].true_world_from_camera.reset();
  }
  EXPECT_EQ(AutoKind(sequence), AlignmentKind::kRigid);
}

TEST_F(AlignSegmentsTest, AnotherScaleThatIsNotTakenIsSaid) {
  const Alignments alignments = Of(Make({}, 1.25), AlignmentKind::kAuto);
  EXPECT_EQ(alignments.of_segment.at(0).kind, AlignmentKind::kNone);
  EXPECT_EQ(Only(alignments.findings).check, "alignment_scale");
  EXPECT_TRUE(Of(Make({}, 1.25), AlignmentKind::kSimilarity).findings.empty());
  EXPECT_TRUE(Of(Make(drift_, 1.0), AlignmentKind::kAuto).findings.empty());
}

TEST_F(AlignSegmentsTest, SettingsOfTheDatasetGoFirst) {
  Sequence sequence = Make(drift_, 1.0);
  sequence.odometry_world = OdometryWorld::kOwn;
  EXPECT_EQ(AutoKind(sequence), AlignmentKind::kRigid);
  sequence.odometry_world = OdometryWorld::kOwnWithScale;
  EXPECT_EQ(AutoKind(sequence), AlignmentKind::kSimilarity);
}

TEST_F(AlignSegmentsTest, WithoutTruthNothingIsAlignedAndWhoAskedIsTold) {
  Sequence sequence = Make(drift_, 1.0);
  for (Frame& frame : sequence.frames) frame.true_world_from_camera.reset();
  const Alignments automatic = Of(sequence, AlignmentKind::kAuto);
  EXPECT_EQ(automatic.of_segment.at(0).kind, AlignmentKind::kNone);
  EXPECT_TRUE(automatic.findings.empty());
  sequence.odometry_world = OdometryWorld::kOwn;
  EXPECT_EQ(Of(sequence, AlignmentKind::kAuto).findings.size(), 1u);
  const Alignments asked = Of(sequence, AlignmentKind::kSimilarity);
  EXPECT_EQ(asked.of_segment.at(0).kind, AlignmentKind::kNone);
  EXPECT_EQ(Only(asked.findings).check, "alignment");
}

TEST_F(AlignSegmentsTest, EachSegmentHasItsOwn) {
  Sequence sequence = Make(elsewhere_, 1.0);
  const Sequence other = Make({ExpRotation({1, 0, 0}), {0, 5, 0}}, 1.0);
  for (Frame frame : other.frames) {
    frame.segment = 3;
    sequence.frames.push_back(frame);
  }
  const auto of_segment = Of(sequence, AlignmentKind::kRigid).of_segment;
  ASSERT_EQ(of_segment.size(), 2u);
  EXPECT_NEAR(of_segment.at(0).rmse_m.value(), 0.0, 1e-9);
  EXPECT_NEAR(of_segment.at(3).rmse_m.value(), 0.0, 1e-9);
  EXPECT_NEAR(of_segment.at(3).truth_from_scaled.translation.y(), 5.0, 1e-9);
}

}  // namespace
}  // namespace soslam
