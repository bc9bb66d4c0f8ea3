// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/pair_evidence.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "support/association_scenes.h"

namespace soslam {
namespace {

// Three frames with two boxes side by side in each, of two objects.
Sequence TwoBoxesInThreeFrames() {
  Sequence sequence;
  for (int frame = 0; frame < 3; ++frame) {
    sequence.frames.emplace_back().id = 10 * frame;
    for (int object = 0; object < 2; ++object) {
      Detection& detection = sequence.detections.emplace_back();
      detection.frame_index = frame;
      detection.object_index = object;
      detection.box = {100.0 * object, 0.0, 100.0 * object + 50.0, 50.0};
    }
  }
  return sequence;
}

// A point at these x (pixels) in the frames with ids 0, 10 and 20; NaN: not seen there.
PointTrack PointAt(const std::array<double, 3>& x) {
  PointTrack track;
  for (int frame = 0; frame < 3; ++frame) {
    if (!std::isnan(x[frame])) track.observations.push_back({10 * frame, {x[frame], 20.0}});
  }
  return track;
}

TEST(PairEvidenceTest, CountsThePointsThatBothFramesShow) {
  const double unseen = std::nan("");
  const PairEvidence points(
      TwoBoxesInThreeFrames(),
      {{PointAt({10.0, 20.0, 30.0}), PointAt({20.0, 30.0, unseen}), PointAt({30.0, 130.0, unseen}),
        PointAt({40.0, 80.0, 40.0}), PointAt({80.0, 80.0, 80.0})}});
  const auto expect = [&](int one, int other, int in_both, int in_any) {
    for (const auto& counts : {points.CountPoints(one, other), points.CountPoints(other, one)}) {
      EXPECT_EQ(counts.in_both, in_both) << one << " " << other;
      EXPECT_EQ(counts.in_any, in_any) << one << " " << other;
    }
    EXPECT_EQ(points.LogRatio(one, other), points.LogRatio(other, one));
  };
  expect(0, 2, 2, 4);
  expect(0, 3, 1, 4);
  expect(0, 4, 2, 2);
  expect(2, 4, 1, 2);
  expect(3, 5, 0, 0);
  EXPECT_EQ(points.LogRatio(3, 5), 0.0);
  EXPECT_EQ(PairEvidence().LogRatio(0, 2), 0.0);
}

TEST(PairEvidenceTest, MoreSharedPointsAreMoreEvidence) {
  for (const int in_any : {1, 3, 10, 40, 200}) {
    double last = -std::numeric_limits<double>::infinity();
    for (int in_both = 0; in_both <= in_any; ++in_both) {
      const double log_ratio = LogRatioOfSharedPoints({in_both, in_any});
      EXPECT_GT(log_ratio, last) << in_both << " of " << in_any;
      last = log_ratio;
    }
    EXPECT_LT(LogRatioOfSharedPoints({0, in_any}), 0.0);
    EXPECT_GT(last, 0.0);
  }
}

// The mean likelihood ratio under the hypothesis in its denominator is 1, whatever the curves are.
TEST(PairEvidenceTest, RatiosAreThoseOfTwoDistributions) {
  constexpr int kAny = 12;
  constexpr std::array<double, 2> kTwo = {0.06, 3.0};
  const auto log_beta = [](double a, double b) {
    return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b);
  };
  double sum = 0.0;
  for (int in_both = 0; in_both <= kAny; ++in_both) {
    const double log_choose =
        std::lgamma(kAny + 1.0) - std::lgamma(in_both + 1.0) - std::lgamma(kAny - in_both + 1.0);
    const double log_two = log_choose + log_beta(in_both + kTwo[0], kAny - in_both + kTwo[1]) -
                           log_beta(kTwo[0], kTwo[1]);
    sum += std::exp(LogRatioOfSharedPoints({in_both, kAny}) + log_two);
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

// All pairs of a detection together count as one comparison.
TEST(PairEvidenceTest, ManyFramesDoNotMakeTheSamePointsSurer) {
  Sequence sequence;
  PointTrack track;
  for (int frame = 0; frame < 40; ++frame) {
    sequence.frames.emplace_back().id = frame;
    Detection& detection = sequence.detections.emplace_back();
    detection.frame_index = frame;
    detection.box = {0.0, 0.0, 50.0, 50.0};
    track.observations.push_back({frame, {20.0, 20.0}});
  }
  const PairEvidence points(sequence, ImageMatches{std::vector<PointTrack>(10, track)});
  double sum = 0.0;
  for (int other = 1; other < 40; ++other) sum += points.LogRatio(0, other);
  EXPECT_NEAR(sum, 2.0 * LogRatioOfSharedPoints({10, 10}), 1e-9);
}

TEST(PairEvidenceTest, ColoursTellThingsApartInFramesThatShareAPoint) {
  ImageMatches matches{{PointAt({200.0, 200.0, std::nan("")})}};
  for (int i = 0; i < 6; ++i) {
    BoxColours& colours = matches.colours.emplace_back(BoxColours::Zero());
    colours[i % 2 == 0 ? 3 : 5] = 255;
  }
  const PairEvidence pairs(TwoBoxesInThreeFrames(), matches);
  EXPECT_EQ(pairs.LogRatio(0, 2), 0.0) << "equal colours do not join";
  EXPECT_NEAR(pairs.LogRatio(0, 3), LogRatioOfColours(0.0), 1e-9);
  EXPECT_EQ(pairs.LogRatio(0, 3), pairs.LogRatio(3, 0));
  EXPECT_EQ(pairs.LogRatio(0, 5), 0.0) << "frames that share no point";
  EXPECT_NEAR(pairs.LogRatio({0, 1}, {2, 3, 5}), 2.0 * pairs.LogRatio(0, 3), 1e-9);
}

TEST(PairEvidenceTest, ColoursFartherApartAreMoreEvidence) {
  EXPECT_EQ(LogRatioOfColours(1.0), 0.0);
  EXPECT_EQ(LogRatioOfColours(1.0 + 1e-7), 0.0);
  for (double product = 0.95; product > 0.0; product -= 0.05) {
    EXPECT_LE(LogRatioOfColours(product), LogRatioOfColours(product + 0.05));
  }
  EXPECT_LT(LogRatioOfColours(0.5), -4.0);
}

// Equal things in a row, seen with odometry that drifts by more than the distance between them.
TEST(PairEvidenceTest, TellThingsApartThatOdometryConfuses) {
  constexpr int kPoints = 8;
  Scene scene = LabelledScene(2, 6, 40, {"thing"});
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    scene.objects[i].half_axes = {0.15, 0.15, 0.2};
    scene.objects[i].shape = Shape::kBox;
    scene.objects[i].position_on_plane = {4.0, 0.5 * static_cast<double>(i) - 1.25};
  }
  scene.trajectory.waypoints = {{{0.0, -1.0, 1.1}, {4.0, 0.0, 0.3}},
                                {{0.0, 1.0, 1.1}, {4.0, 0.0, 0.3}}};
  Sequence sequence = SyntheticSequence(scene, false);
  std::vector<PointTrack> tracks;
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    const Landmark& body = sequence.objects[i].ground_truth->landmark_in_world;
    for (int k = 0; k < kPoints; ++k) {
      PointTrack& track = tracks.emplace_back();
      const Eigen::Vector3d in_object = body.half_axes.cwiseProduct(Eigen::Vector3d(
          RandomUniform(-0.7, 0.7), RandomUniform(-0.7, 0.7), RandomUniform(-0.7, 0.7)));
      const Eigen::Vector3d in_world = body.frame_from_object * in_object;
      for (const Frame& frame : sequence.frames) {
        const Eigen::Vector3d in_camera = frame.true_world_from_camera->Inverse() * in_world;
        const auto pixel = sequence.camera.Project(in_camera);
        if (!pixel || !sequence.camera.IsInside(*pixel)) continue;
        track.observations.push_back({frame.id, *pixel});
      }
    }
  }
  constexpr double kDriftM = 0.1;  // from frame to frame
  double drift = 0.0;
  for (Frame& frame : sequence.frames) {
    frame.world_from_camera.translation.y() += drift;
    drift += kDriftM * RandomNormal();
  }
  const Sequence seen = WithoutIds(sequence);
  AssociateOptions options = EstimatedAssociation();
  options.odometry_translation_sigma_m = kDriftM;
  // Pairs of detections that are of one object for the association or in truth, but not for both.
  const auto wrong_pairs = [&](const PairEvidence& points) {
    const auto detections = Associate(seen, UnknowingTable(), points, options, 2).detections;
    int wrong = 0;
    for (size_t i = 0; i < detections.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        const bool are_one = detections[i].track == detections[j].track;
        const bool are_truly_one =
            sequence.detections[i].object_index == sequence.detections[j].object_index;
        wrong += are_one != are_truly_one ? 1 : 0;
      }
    }
    return wrong;
  };
  // Not all are held: boxes far from where a body predicts them may be of something else.
  EXPECT_LT(5 * wrong_pairs(PairEvidence(seen, ImageMatches{tracks})), wrong_pairs(PairEvidence()));
}

}  // namespace
}  // namespace soslam
