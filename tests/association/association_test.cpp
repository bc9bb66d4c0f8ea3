// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/association.h"

#include <gtest/gtest.h>

#include <functional>
#include <numeric>
#include <set>
#include <utility>

#include "soslam/association/association_model.h"
#include "soslam/association/clustering.h"
#include "support/association_scenes.h"

namespace soslam {
namespace {

constexpr int kObjects = 8;
constexpr int kFrames = 40;
constexpr int kScenes = 4;

// The detections of each object, as a set: what an association comes down to.
std::set<std::set<int>> Partition(const Association& association) {
  std::set<std::set<int>> partition;
  for (const int track : association.objects) {
    const auto& detections = association.tracks[track].detections;
    partition.insert(std::set<int>(detections.begin(), detections.end()));
  }
  return partition;
}

Association AssociateAll(const Sequence& sequence, int threads = 2) {
  return Associate(sequence, UnknowingTable(), PairEvidence(), EstimatedAssociation(), threads);
}

Sequence NoisySequence(int seed, const std::vector<std::string>& labels) {
  Scene scene = LabelledScene(seed, kObjects, kFrames, labels);
  scene.noise = OrdinaryNoise();
  return SyntheticSequence(scene, true);
}

// Sequences with the true ids and what is seen of them: nearly all objects are found, in each of
// the scenes at least as many as `least` says.
void ExpectNearlyAllFound(
    int scenes, double least,
    const std::function<std::pair<Sequence, Sequence>(int seed)>& given_and_seen) {
  double sum = 0.0;
  for (int seed = 0; seed < scenes; ++seed) {
    const auto [given, seen] = given_and_seen(seed);
    const double f1 = F1(seen, given);
    EXPECT_GE(f1, least) << seed;
    sum += f1;
  }
  EXPECT_GE(sum / scenes, 0.95);
}

TEST(AssociateTest, ExactBoxesOfOneLabelAreTheirObjects) {
  for (int seed = 0; seed < kScenes; ++seed) {
    const Sequence sequence =
        SyntheticSequence(LabelledScene(seed, kObjects, kFrames, {"thing"}), false);
    EXPECT_EQ(F1(WithoutIds(sequence), sequence), 1.0) << seed;
  }
}

TEST(AssociateTest, NoisyBoxesAreNearlyAllTheirObjects) {
  ExpectNearlyAllFound(kScenes, 0.8, [](int seed) {
    const Sequence sequence = NoisySequence(seed, {"thing", "other"});
    return std::pair(sequence, WithoutIds(sequence));
  });
}

// But for steps that none of the single ones leads to: as much as one second box.
TEST(ClusterDetectionsTest, FoundGroupsCostNoMoreThanTrueOnes) {
  constexpr double kMissed = 8.0;
  for (int seed = 0; seed < kScenes; ++seed) {
    const Sequence given = NoisySequence(seed, {"thing", "other"});
    const Sequence seen = WithoutIds(given);
    const SemanticTable table = UnknowingTable();
    const AssociateOptions options = EstimatedAssociation();
    const AssociationModel model(seen, table, options);
    std::vector<int> all(seen.detections.size());
    std::iota(all.begin(), all.end(), 0);
    std::vector<std::vector<int>> found, split = DetectionsByObject(given);
    for (const Cluster& cluster : ClusterDetections(model, PairEvidence(), all, 2).all) {
      found.push_back(cluster.track.detections);
    }
    const double of_truth = CostOfGroups(model, PairEvidence(), DetectionsByObject(given), 2);
    EXPECT_LE(CostOfGroups(model, PairEvidence(), found, 2), of_truth + kMissed) << seed;
    split.push_back({split.front().back()});
    split.front().pop_back();
    EXPECT_GT(CostOfGroups(model, PairEvidence(), split, 2), of_truth + kMissed) << seed;
  }
}

TEST(AssociateTest, FlickeringLabelsMakeNoObjects) {
  const std::vector<std::string> labels = {"thing", "other", "third"};
  double sum = 0.0;
  for (int seed = 0; seed < kScenes; ++seed) {
    const Sequence sequence = NoisySequence(seed, labels);
    Sequence seen = WithoutIds(sequence);
    for (Object& object : seen.objects) {
      if (RandomUniform(0.0, 1.0) > 0.1) continue;
      object.label = labels[static_cast<size_t>(RandomUniform(0.0, 2.99))];
    }
    const Association association = AssociateAll(seen);
    const Agreement agreement = CompareWithGiven(sequence, association, 3);
    sum += agreement.F1().value();
    for (size_t i = 0; i < association.objects.size(); ++i) {
      const Track& track = association.tracks[association.objects[i]];
      if (!agreement.given_of_object[i]) continue;  // a part of an object
      const auto given = static_cast<size_t>(*agreement.given_of_object[i]);
      // Votes of a few detections may go wrong, as may objects themselves.
      if (track.detections.size() < 6) continue;
      EXPECT_EQ(LabelOf(track), sequence.objects[given].label) << seed;
    }
  }
  EXPECT_GE(sum / kScenes, 0.95);
}

TEST(AssociateTest, FalseDetectionsAreNoObjects) {
  ExpectNearlyAllFound(kScenes, 0.0, [](int seed) {
    Sequence sequence = NoisySequence(seed, {"thing", "other"});
    for (int frame = 0; frame < kFrames; ++frame) {
      if (RandomUniform(0.0, 1.0) > 0.5) continue;
      const std::string label = RandomUniform(0.0, 1.0) < 0.5 ? "thing" : "other";
      AddFalseDetection(frame, RandomBox(sequence.camera), label, &sequence);
    }
    SortDetections(&sequence);
    return std::pair(sequence, WithoutIds(sequence));
  });
}

// Two boxes of one label, one behind the other, seen in passing: their boxes cross in the image.
Scene CrossingScene() {
  Scene scene = LabelledScene(0, 1, 1, {"thing"});
  scene.objects.clear();
  for (int i = 0; i < 2; ++i) {
    SceneObject object;
    object.id = i;
    object.label = "thing";
    object.shape = Shape::kBox;
    object.half_axes = {0.2, 0.25, 0.3};
    object.position_on_plane = {3.0 + 1.5 * i, 0.1 * i};
    scene.objects.push_back(object);
  }
  scene.trajectory.waypoints = {{{0.0, -1.6, 1.1}, {4.0, 0.0, 0.3}},
                                {{0.0, 0.0, 1.1}, {4.0, 0.0, 0.3}},
                                {{0.0, 1.6, 1.1}, {4.0, 0.0, 0.3}}};
  scene.trajectory.frames = 30;
  scene.noise = OrdinaryNoise();
  return scene;
}

TEST(AssociateTest, ObjectsOfOneLabelMayCrossInTheImage) {
  const Scene scene = CrossingScene();
  for (const bool noise : {false, true}) {
    const Sequence sequence = SyntheticSequence(scene, noise);
    const auto of_objects = DetectionsByObject(sequence);
    const auto offset = [&](size_t i, size_t j) {
      return sequence.detections[of_objects[i][j]].box.Centre().x();
    };
    const size_t last = of_objects[1].size() - 1;
    ASSERT_LT(
        (offset(0, 0) - offset(1, 0)) * (offset(0, of_objects[0].size() - 1) - offset(1, last)),
        0.0)
        << "they do not cross";
    EXPECT_EQ(F1(WithoutIds(sequence), sequence), 1.0) << noise;
  }
}

// The camera looks at three things of one label, away for a second, and back from the other side.
Scene RevisitScene() {
  Scene scene = CrossingScene();
  SceneObject third = scene.objects[0];
  third.id = 2;
  third.position_on_plane = {3.5, -1.0};
  scene.objects.push_back(third);
  scene.trajectory.waypoints = {
      {{0.0, -0.6, 1.1}, {4.0, -0.2, 0.3}}, {{0.2, -0.3, 1.1}, {4.0, -0.2, 0.3}},
      {{0.2, 0.0, 1.1}, {0.4, 4.0, 0.3}},   {{0.0, 0.4, 1.1}, {0.4, 4.0, 0.3}},
      {{0.0, 0.6, 1.1}, {4.0, -0.2, 0.3}},  {{0.0, 0.9, 1.1}, {4.0, -0.2, 0.3}}};
  scene.trajectory.frames = 40;
  return scene;
}

TEST(AssociateTest, ObjectsAreFoundAgainAfterTheyWereOutOfSight) {
  for (int seed = 0; seed < 4; ++seed) {
    Scene scene = RevisitScene();
    scene.seed = seed;
    const Sequence sequence = SyntheticSequence(scene, true);
    const Association association = AssociateAll(WithoutIds(sequence));
    EXPECT_EQ(CompareWithGiven(sequence, association, 3).F1().value(), 1.0) << seed;
  }
}

TEST(AssociateTest, TheOrderWithinAFrameDoesNotMatter) {
  const Sequence sequence = WithoutIds(NoisySequence(2, {"thing"}));
  Sequence reversed = sequence;
  const auto count = static_cast<int>(sequence.detections.size());
  for (Detection& detection : reversed.detections) {
    detection.object_index = count - 1 - detection.object_index;
  }
  std::ranges::reverse(reversed.objects);
  SortDetections(&reversed);
  // Compares detections by frame and box, as their indices differ.
  const auto boxes = [](const Sequence& of, const Association& association) {
    std::set<std::set<std::pair<int, double>>> objects;
    for (const std::set<int>& detections : Partition(association)) {
      std::set<std::pair<int, double>> object;
      for (const int i : detections) {
        const Detection& detection = of.detections[i];
        object.insert({detection.frame_index, detection.box.x_min});
      }
      objects.insert(object);
    }
    return objects;
  };
  EXPECT_EQ(boxes(sequence, AssociateAll(sequence)), boxes(reversed, AssociateAll(reversed)));
}

TEST(AssociateTest, AMovedWorldChangesNoDecision) {
  const Sequence sequence = NoisySequence(3, {"thing"});
  const Sequence moved = TransformSequence(RandomRigid(), sequence);
  EXPECT_EQ(Partition(AssociateAll(sequence)), Partition(AssociateAll(moved)));
}

TEST(AssociateTest, OfTwoBoxesAtOnePlaceTheBetterIsUsed) {
  Sequence sequence = SyntheticSequence(LabelledScene(5, 2, 20, {"thing"}), false);
  const Detection copied = sequence.detections[0];
  AddFalseDetection(copied.frame_index, copied.box, "other", &sequence);
  sequence.detections.back().score = 0.4;
  SortDetections(&sequence);
  const auto copy = std::ranges::find(sequence.detections, 0.4, &Detection::score);
  const auto index = static_cast<size_t>(copy - sequence.detections.begin());
  const Association association = AssociateAll(sequence);
  const DetectionDecision& decision = association.detections[index];
  EXPECT_EQ(decision.fate, BoxFate::kDuplicate);
  EXPECT_EQ(decision.object, -1);
  const Detection& kept = sequence.detections[decision.duplicate_of];
  EXPECT_EQ(kept.box, copied.box);
  EXPECT_EQ(kept.score, 1.0);
}

// The same frames once more, as another recording, in a world of its own that looks the same.
TEST(AssociateTest, EachSegmentHasItsOwnObjects) {
  const Sequence once = SyntheticSequence(LabelledScene(6, 2, 20, {"thing"}), false);
  Sequence twice = once;
  const auto frames = static_cast<int>(once.frames.size());
  for (Frame frame : once.frames) {
    frame.id += frames;
    frame.segment = 1;
    twice.frames.push_back(frame);
  }
  for (Detection detection : once.detections) {
    detection.frame_index += frames;
    twice.detections.push_back(detection);
  }
  const Association association = AssociateAll(twice);
  EXPECT_EQ(association.objects.size(), 4u);
  for (const Track& track : association.tracks) {
    std::set<int> segments;
    for (const int i : track.detections) {
      segments.insert(twice.FrameOf(twice.detections[i]).segment);
    }
    EXPECT_EQ(segments.size(), 1u);
  }
}

// Nothing explains what stands on another plane, wherever it is in the image.
TEST(AssociateTest, ObjectsStayOnTheirPlane) {
  Sequence sequence = SyntheticSequence(LabelledScene(6, 1, 20, {"thing"}), false);
  sequence.planes.push_back(sequence.planes[0]);
  sequence.planes[1].id = sequence.planes[0].id + 1;
  Sequence seen = WithoutIds(sequence);
  for (size_t i = 0; i < seen.objects.size(); ++i) seen.objects[i].plane_index = i % 2;
  const Association association = AssociateAll(seen);
  for (const Track& track : association.tracks) {
    for (const int i : track.detections) {
      const auto object = static_cast<size_t>(seen.detections[static_cast<size_t>(i)].object_index);
      EXPECT_EQ(seen.objects[object].plane_index, track.plane_index);
    }
  }
  EXPECT_EQ(association.objects.size(), 2u);
}

// Neither planes nor the height of any label is known.
TEST(AssociateWithoutPlanesTest, NoisyBoxesAreNearlyAllTheirObjects) {
  ExpectNearlyAllFound(2, 0.8, [](int seed) {
    const Sequence sequence = NoisySequence(seed, {"thing", "other"});
    // The axes of the world mean nothing.
    return std::pair(sequence,
                     TransformSequence(RandomRigid(), WithoutPlanes(WithoutIds(sequence))));
  });
}

}  // namespace
}  // namespace soslam
