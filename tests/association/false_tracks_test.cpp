// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/association/association_model.h"
#include "support/association_scenes.h"

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

TEST_F(TrackTest, WhatItsBoxesDoNotDetermineIsNoObject) {
  const int track = AddTrack(of_objects_[0]);
  for (const int index : of_objects_[0]) {
    sequence_.detections[index].is_one_sided = {true, false, false, true};
  }
  EXPECT_EQ(FateOf(track), TrackFate::kUndetermined);
  EXPECT_LT(TrackAt(track).overlap_by_boxes.value(), options_.min_overlap_by_boxes);
  options_.min_overlap_by_boxes = 0.0;
  EXPECT_EQ(FateOf(track), TrackFate::kObject);
}

TEST_F(TrackTest, WhatImagesShowTogetherIsAnObjectThoughNoneShowsItWhole) {
  const int track = AddTrack(of_objects_[0]);
  for (size_t i = 0; i < of_objects_[0].size(); ++i) {
    sequence_.detections[of_objects_[0][i]].is_one_sided[i % 4] = true;
  }
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

}  // namespace
}  // namespace soslam
