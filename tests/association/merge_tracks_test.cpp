// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "association/association.h"
#include "association/labels.h"
#include "base/error.h"
#include "support/association_scenes.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

using testing::SizeIs;

// Two objects, of which tracks are made by hand.
class TrackTest : public testing::Test {
 protected:
  TrackTest() {
    association_.detections.resize(sequence_.detections.size());
    of_objects_ = DetectionsByObject(sequence_);
  }

  AssociationModel Model() const { return {sequence_, table_, options_}; }

  int AddTrack(const std::vector<int>& detections) {
    const AssociationModel model = Model();
    const int index = static_cast<int>(association_.tracks.size());
    Track track;
    track.detections = detections;
    track.linked = static_cast<int>(detections.size());
    for (const int i : detections) {
      track.votes[model.LabelOf(sequence_.detections[i])] += 1.0;
      association_.detections[i].track = index;
    }
    model.Fit(&track);
    association_.tracks.push_back(track);
    return index;
  }
  // Every `step`-th detection of an object from `first` on.
  std::vector<int> EveryOf(size_t object, size_t first, size_t step) const {
    std::vector<int> chosen;
    for (size_t i = first; i < of_objects_[object].size(); i += step) {
      chosen.push_back(of_objects_[object][i]);
    }
    return chosen;
  }
  const Track& TrackAt(int track) const { return association_.tracks[track]; }
  // The fate of a track once false ones are dropped.
  TrackFate FateOf(int track) {
    DropFalseTracks(Model(), 1, &association_);
    return TrackAt(track).fate;
  }

  AssociateOptions options_ = EstimatedAssociation();
  SemanticTable table_ = UnknowingTable();
  Sequence sequence_ = SyntheticSequence(LabelledScene(11, 2, 30, {"thing"}), false);
  std::vector<std::vector<int>> of_objects_;
  Association association_;
};

TEST_F(TrackTest, PartsOfOneObjectAreMergedIntoTheLargest) {
  ASSERT_THAT(of_objects_[0], SizeIs(testing::Ge(8u)));
  const int larger = AddTrack(EveryOf(0, 0, 2));
  const int smaller = AddTrack(EveryOf(0, 1, 4));
  const int rest = AddTrack(EveryOf(0, 3, 4));
  MergeTracks(Model(), 1, &association_);
  EXPECT_EQ(TrackAt(larger).detections, of_objects_[0]);
  for (const int track : {smaller, rest}) {
    EXPECT_EQ(TrackAt(track).fate, TrackFate::kMerged);
    EXPECT_EQ(TrackAt(track).explained, TrackAt(track).tried);
    EXPECT_EQ(TrackAt(track).shared_frames, 0);
  }
}

TEST_F(TrackTest, TwoObjectsAreNotMerged) {
  const int one = AddTrack(of_objects_[0]);
  const int other = AddTrack(of_objects_[1]);
  MergeTracks(Model(), 1, &association_);
  EXPECT_EQ(TrackAt(one).fate, TrackFate::kObject);
  EXPECT_EQ(TrackAt(other).fate, TrackFate::kObject);
}

// The same body twice in the same frames is two kinds of detections of one thing.
TEST_F(TrackTest, WhatIsDetectedTogetherIsMergedOnlyIfItIsAtOnePlace) {
  const size_t count = sequence_.detections.size();
  for (size_t i = 0; i < count; ++i) {
    Detection detection = sequence_.detections[i];
    if (detection.object_index == 0) sequence_.detections.push_back(detection);
  }
  association_.detections.resize(sequence_.detections.size());
  std::vector<int> copies;
  for (size_t i = count; i < sequence_.detections.size(); ++i)
    copies.push_back(static_cast<int>(i));
  const int original = AddTrack(of_objects_[0]);
  const int copy = AddTrack(copies);
  options_.same_place_overlap = 1.1;  // never
  MergeTracks(Model(), 1, &association_);
  EXPECT_EQ(TrackAt(original).fate, TrackFate::kObject);
  EXPECT_EQ(TrackAt(copy).fate, TrackFate::kObject);

  options_.same_place_overlap = 0.5;
  MergeTracks(Model(), 1, &association_);
  EXPECT_EQ(TrackAt(original).detections.size() + TrackAt(copy).detections.size(),
            2 * of_objects_[0].size());
  const auto superseded =
      std::ranges::count(association_.detections, true, &DetectionDecision::superseded);
  EXPECT_EQ(superseded, static_cast<long>(of_objects_[0].size()));
}

TEST_F(TrackTest, TracksWithFewDetectionsAreFalse) {
  const int track = AddTrack({of_objects_[0][0], of_objects_[0][1]});
  EXPECT_EQ(FateOf(track), TrackFate::kTooFewDetections);
  EXPECT_FALSE(TrackAt(track).frames_in_sight);
  options_.min_observations = 2;
  EXPECT_EQ(FateOf(track), TrackFate::kObject);
}

TEST_F(TrackTest, WhatIsRarelyDetectedThoughInSightIsFalse) {
  const int track = AddTrack(of_objects_[0]);
  EXPECT_EQ(FateOf(track), TrackFate::kObject);
  // It is detected in every frame that shows it whole; the estimate may reach a little farther.
  const auto detections = static_cast<int>(of_objects_[0].size());
  EXPECT_GE(TrackAt(track).frames_in_sight.value(), detections);
  EXPECT_LE(TrackAt(track).frames_in_sight.value(), detections + 2);

  // The camera goes back to where it saw the object well, and does not see it any more.
  const auto middle = static_cast<size_t>(of_objects_[0][of_objects_[0].size() / 2]);
  const Frame frame = sequence_.frames[sequence_.detections[middle].frame_index];
  for (int i = 0; i < 10 * detections; ++i) sequence_.frames.push_back(frame);
  EXPECT_EQ(FateOf(track), TrackFate::kRarelyDetected);
  options_.min_detection_share = 0.0;
  EXPECT_EQ(FateOf(track), TrackFate::kObject);
}

TEST_F(TrackTest, WhatIsNeverSeenWholeIsNoObject) {
  const int track = AddTrack(of_objects_[0]);
  for (const int index : of_objects_[0]) {
    sequence_.detections[index].is_bound = {true, false, false, false};
  }
  EXPECT_EQ(FateOf(track), TrackFate::kNeverWhole);
  sequence_.detections[of_objects_[0][2]].is_bound = {};
  EXPECT_EQ(FateOf(track), TrackFate::kObject);
}

TEST_F(TrackTest, OneGoodScoreMakesAnObject) {
  const int track = AddTrack(of_objects_[0]);
  for (const int index : of_objects_[0]) {
    sequence_.detections[index].score = options_.min_best_score - 0.01;
  }
  EXPECT_EQ(FateOf(track), TrackFate::kLowScores);
  sequence_.detections[of_objects_[0][1]].score = options_.min_best_score;
  EXPECT_EQ(FateOf(track), TrackFate::kObject);
}

TEST_F(TrackTest, ATrackWithoutLandmarkIsNoObject) {
  const int track = AddTrack(of_objects_[0]);
  association_.tracks[track].fit.reset();
  EXPECT_EQ(FateOf(track), TrackFate::kNoLandmark);
}

const std::set<std::string> kLabels = {"bowl", "cup", "tv", "mouse"};

AssociateOptions Confusing(double any, const std::string& interchangeable, double similar = 0.0,
                           const std::string& similar_labels = "") {
  AssociateOptions options;
  options.label_confusion = any;
  options.interchangeable_labels = interchangeable;
  options.similar_label_confusion = similar;
  options.similar_labels = similar_labels;
  return options;
}

double Sum(const LabelConfusion& confusion, const std::string& of_object) {
  double sum = 0.0;
  for (const std::string& label : kLabels) sum += confusion.Probability(label, of_object);
  return sum;
}

TEST(LabelConfusionTest, ProbabilitiesSumToOne) {
  const LabelConfusion confusion(kLabels, Confusing(0.06, "", 0.1, "cup, bowl, mug; tv, laptop"));
  for (const std::string label : {"cup", "mouse"}) {
    EXPECT_NEAR(Sum(confusion, label), 1.0, 1e-12) << label;
  }
  EXPECT_NEAR(confusion.Probability("cup", "cup"), 0.84, 1e-12);
  EXPECT_NEAR(confusion.Probability("bowl", "cup"), 0.1, 1e-12);
  EXPECT_NEAR(confusion.Probability("mouse", "cup"), 0.03, 1e-12);
  EXPECT_NEAR(std::exp(-0.5 * confusion.CostOfAnyLabel()), 0.25, 1e-12);
}

TEST(LabelConfusionTest, WithoutConfusionLabelsKeepApart) {
  const LabelConfusion confusion(kLabels, Confusing(0.0, ""));
  EXPECT_EQ(confusion.Probability("cup", "cup"), 1.0);
  EXPECT_EQ(confusion.Probability("bowl", "cup"), 0.0);
  EXPECT_EQ(confusion.Candidates({{"cup", 1.0}}), std::vector<std::string>({"cup"}));
}

TEST(LabelConfusionTest, InterchangeableLabelsCountAsOne) {
  const LabelConfusion confusion(kLabels, Confusing(0.0, "cup, bowl;  tv,monitor "));
  EXPECT_EQ(confusion.Probability("bowl", "cup"), 1.0);
  EXPECT_EQ(confusion.Probability("tv", "monitor"), 1.0);
  EXPECT_EQ(confusion.Probability("tv", "cup"), 0.0);
  EXPECT_NEAR(confusion.CostOfAnyLabel(), 2.0 * std::log(3.0), 1e-12);
}

TEST(LabelConfusionTest, SimilarLabelsAreCandidatesAndCostMoreThanTheVotes) {
  const LabelConfusion confusion(kLabels, Confusing(0.05, "", 0.1, "cup, mug, bowl; tv, laptop"));
  const LabelVotes votes = {{"cup", 3.0}, {"mouse", 0.5}};
  EXPECT_EQ(confusion.Candidates(votes), std::vector<std::string>({"bowl", "cup", "mouse", "mug"}));
  EXPECT_LT(confusion.CostOfVotes(votes, "cup"), confusion.CostOfVotes(votes, "mug"));
  EXPECT_LT(confusion.CostOfVotes(votes, "mug"), confusion.CostOfVotes(votes, "tv"));
}

TEST(LabelConfusionTest, AnUncertainObjectHasTheMeanProbability) {
  const LabelConfusion confusion(kLabels, Confusing(0.06, ""));
  EXPECT_NEAR(confusion.Probability("cup", {{"cup", 0.5}, {"tv", 0.5}}), 0.5 * (0.94 + 0.02),
              1e-12);
}

TEST(LabelConfusionTest, MalformedGroupsAreRefused) {
  for (const std::string groups : {"cup,", ";", "cup,bowl;cup,tv", "cup,,tv", " "}) {
    ExpectError<SettingsError>([&] { LabelConfusion(kLabels, Confusing(0.1, groups)); },
                               {"interchangeable_labels", groups});
  }
}

using testing::ElementsAre;

// Frames with one detection each, of the given objects; labels "a", "b", ... by object.
Sequence GivenSequence(const std::vector<int>& objects) {
  Sequence sequence;
  sequence.planes.resize(1);
  const int count = *std::ranges::max_element(objects) + 1;
  for (int i = 0; i < count; ++i) {
    sequence.objects.push_back({10 * i, std::string(1, static_cast<char>('a' + i)), 0, {}});
    sequence.objects.back().ground_truth = GroundTruth{};
    sequence.objects.back().ground_truth->landmark_in_world.half_axes.x() = i + 1.0;
  }
  for (size_t i = 0; i < objects.size(); ++i) {
    sequence.frames.emplace_back();
    sequence.detections.emplace_back();
    sequence.detections.back().frame_index = static_cast<int>(i);
    sequence.detections.back().object_index = objects[i];
  }
  return sequence;
}

// One track per object found; -1: a detection of a track that is none.
Association Found(const std::vector<int>& objects) {
  Association association;
  const int count = *std::ranges::max_element(objects) + 1;
  association.tracks.resize(static_cast<size_t>(count) + 1);
  association.tracks.back().fate = TrackFate::kTooFewDetections;
  for (int i = 0; i < count; ++i) association.objects.push_back(i);
  for (size_t i = 0; i < objects.size(); ++i) {
    DetectionDecision decision;
    decision.object = objects[i];
    decision.track = objects[i] >= 0 ? objects[i] : count;
    Track& track = association.tracks[decision.track];
    track.detections.push_back(static_cast<int>(i));
    track.votes["x"] += 1.0;
    track.labels = {{"x", 1.0}};
    association.detections.push_back(decision);
  }
  return association;
}

TEST(CompareWithGivenTest, TheSamePartitionAgreesWhateverItsOrder) {
  const Agreement agreement =
      CompareWithGiven(GivenSequence({0, 0, 0, 1, 1, 1}), Found({1, 1, 1, 0, 0, 0}), 3);
  EXPECT_EQ(agreement.Precision(), 1.0);
  EXPECT_EQ(agreement.Recall(), 1.0);
  EXPECT_EQ(agreement.F1(), 1.0);
  EXPECT_THAT(agreement.given_of_object, ElementsAre(1, 0));
}

TEST(CompareWithGivenTest, OfTwoHalvesOneMayMatch) {
  // Five of eight are more than half of all that either has, the other three are not.
  const Agreement agreement =
      CompareWithGiven(GivenSequence({0, 0, 0, 0, 0, 0, 0, 0}), Found({0, 0, 0, 0, 0, 1, 1, 1}), 3);
  EXPECT_EQ(agreement.matched, 1);
  EXPECT_EQ(agreement.Precision(), 0.5);
  EXPECT_EQ(agreement.Recall(), 1.0);
  EXPECT_DOUBLE_EQ(agreement.F1().value(), 2.0 / 3.0);
  EXPECT_THAT(agreement.given_of_object, ElementsAre(0, std::nullopt));
}

TEST(CompareWithGivenTest, OfTwoInOneTheLargerMatchesEqualOnesDoNot) {
  const auto merged = [](const std::vector<int>& given) {
    const std::vector<int> found(given.size(), 0);
    return CompareWithGiven(GivenSequence(given), Found(found), 3);
  };
  EXPECT_EQ(merged({0, 0, 0, 1, 1, 1, 1}).matched, 1);
  EXPECT_THAT(merged({0, 0, 0, 1, 1, 1, 1}).given_of_object, ElementsAre(1));
  EXPECT_DOUBLE_EQ(merged({0, 0, 0, 1, 1, 1, 1}).F1().value(), 2.0 / 3.0);
  EXPECT_EQ(merged({0, 0, 0, 1, 1, 1}).matched, 0);
  EXPECT_EQ(merged({0, 0, 0, 1, 1, 1}).F1(), 0.0);
}

TEST(CompareWithGivenTest, GivenObjectsWithFewDetectionsDoNotCount) {
  const Agreement agreement =
      CompareWithGiven(GivenSequence({0, 0, 0, 1, 1}), Found({0, 0, 0, -1, -1}), 3);
  EXPECT_EQ(agreement.given_objects, 1);
  EXPECT_EQ(agreement.F1(), 1.0);
}

TEST(CompareWithGivenTest, WithoutGivenObjectsThereIsNothingToCompareWith) {
  const Agreement agreement = CompareWithGiven(GivenSequence({0, 1, 2}), Found({0, 0, 0}), 3);
  EXPECT_FALSE(agreement.Precision());
  EXPECT_FALSE(agreement.Recall());
  EXPECT_FALSE(agreement.F1());
}

TEST(AssociatedSequenceTest, ObjectsAreTheFoundOnesWithTheGroundTruthOfTheGiven) {
  const Sequence given = GivenSequence({0, 0, 0, 1, 1, 1, 1});
  const Association found = Found({1, 1, 1, 0, 0, 0, -1});
  const Sequence associated = AssociatedSequence(given, found, CompareWithGiven(given, found, 3));
  ASSERT_EQ(associated.objects.size(), 2u);
  EXPECT_EQ(associated.objects[0].id, 1);
  EXPECT_EQ(associated.objects[0].label, "x");
  EXPECT_EQ(associated.objects[0].ground_truth->landmark_in_world.half_axes.x(), 2.0);
  EXPECT_EQ(associated.objects[1].ground_truth->landmark_in_world.half_axes.x(), 1.0);
  ASSERT_EQ(associated.detections.size(), 6u);
  EXPECT_EQ(associated.detections[0].object_index, 1);
  EXPECT_EQ(associated.detections[5].object_index, 0);
  EXPECT_EQ(associated.rejected_detections.at("too_few_detections"), 1);
  ASSERT_EQ(associated.rejected.size(), 1u);
  EXPECT_EQ(associated.rejected[0].stage, RejectingStage::kAssociate);
  EXPECT_EQ(associated.rejected[0].reason, "too_few_detections");
  EXPECT_EQ(associated.rejected[0].frame_index, given.detections[6].frame_index);
}

TEST(AssociatedSequenceTest, MovingObjectsAreNotCountedAndGiveNoGroundTruth) {
  Sequence given = GivenSequence({0, 0, 0, 1, 1, 1});
  given.objects[1].is_static = false;
  const Association found = Found({0, 0, 0, 1, 1, 1});
  const Agreement agreement = CompareWithGiven(given, found, 3);
  EXPECT_EQ(agreement.given_objects, 1);
  EXPECT_EQ(agreement.matched, 1);
  EXPECT_EQ(agreement.Precision(), 0.5);
  const Sequence associated = AssociatedSequence(given, found, agreement);
  EXPECT_TRUE(associated.objects[0].ground_truth);
  EXPECT_FALSE(associated.objects[1].ground_truth);
  EXPECT_TRUE(associated.objects[1].is_static);
}

TEST(AssociatedSequenceTest, AnObjectWithoutCounterpartHasNoGroundTruth) {
  const Sequence given = GivenSequence({0, 0, 0, 0, 0});
  const Association found = Found({0, 0, 0, 1, 1});
  const Sequence associated = AssociatedSequence(given, found, CompareWithGiven(given, found, 2));
  EXPECT_TRUE(associated.objects[0].ground_truth);
  EXPECT_FALSE(associated.objects[1].ground_truth);
}

}  // namespace
}  // namespace soslam
