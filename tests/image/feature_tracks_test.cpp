// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/feature_tracks.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "support/drawn_photos.h"

namespace soslam {
namespace {

// Soft edges: a picture between two pixels is then like its neighbours.
cv::Mat SoftView(int shift) {
  cv::Mat soft;
  cv::GaussianBlur(GreyOf(DrawnView(shift)), soft, {}, 1.0);
  return soft;
}

std::vector<FeatureTrack> TracksThrough(const std::vector<int>& shifts) {
  FeatureTracker tracker({});
  for (const int shift : shifts) tracker.Add(SoftView(shift));
  return tracker.Tracks();
}

// Pixels by which places differ from the motion of the picture.
double MotionError(const FeatureTrack& track, const std::vector<int>& shifts) {
  double error = 0.0;
  const auto in_picture = [&](const FeatureTrack::Place& place) {
    return Eigen::Vector2d(place.pixel.x() + shifts[place.image], place.pixel.y());
  };
  for (const FeatureTrack::Place& place : track.places) {
    error = std::max(error, (in_picture(place) - in_picture(track.places.front())).norm());
  }
  return error;
}

TEST(FeatureTrackerTest, FollowsThePicture) {
  const std::vector<int> shifts = {0, 4, 10, 25, 30};
  const std::vector<FeatureTrack> tracks = TracksThrough(shifts);
  EXPECT_GT(tracks.size(), 100u);
  int wrong = 0;
  for (const FeatureTrack& track : tracks) {
    EXPECT_GE(track.places.size(), 2u);
    if (MotionError(track, shifts) > 0.5) ++wrong;
  }
  EXPECT_LT(wrong, 0.05 * static_cast<double>(tracks.size()));
}

// The picture moves on by its own width, in steps: what is new is followed, too.
TEST(FeatureTrackerTest, LooksForNewFeatures) {
  std::vector<int> shifts;
  for (int i = 0; i < 20; ++i) shifts.push_back(20 * i);
  int of_the_end = 0;
  for (const FeatureTrack& track : TracksThrough(shifts)) {
    if (track.places.front().image > 16) ++of_the_end;
  }
  EXPECT_GT(of_the_end, 10);
}

TEST(FeatureTrackerTest, FollowsNothingThroughACut) {
  FeatureTracker tracker({});
  tracker.Add(SoftView(0));
  tracker.Add(SoftView(2));
  tracker.Cut();
  tracker.Add(SoftView(4));
  for (const FeatureTrack& track : tracker.Tracks()) EXPECT_EQ(track.places.back().image, 1);
}

// The motion is far beyond what is found without a prediction.
TEST(FeatureTrackerTest, APredictedMotionIsFollowed) {
  const std::vector<int> shifts = {0, 140};
  const auto right_tracks = [&](const Eigen::Matrix3d& prediction) {
    FeatureTracker tracker({.pyramid_levels = 0});
    tracker.Add(SoftView(shifts[0]));
    tracker.Add(SoftView(shifts[1]), prediction);
    int right = 0;
    for (const FeatureTrack& track : tracker.Tracks()) {
      if (MotionError(track, shifts) < 0.5) ++right;
    }
    return right;
  };
  Eigen::Matrix3d shift = Eigen::Matrix3d::Identity();
  shift(0, 2) = -139.0;
  EXPECT_GT(right_tracks(shift), 50);
  EXPECT_LT(right_tracks(Eigen::Matrix3d::Identity()), 10);
}

// The picture moves through a masked part of the image.
TEST(FeatureTrackerTest, NothingInAMask) {
  const std::vector<int> shifts = {0, 10, 20, 30};
  const cv::Mat first = SoftView(0);
  cv::Mat mask(first.size(), CV_8UC1, cv::Scalar(255));
  const int left = first.cols / 3, right = 2 * first.cols / 3;
  mask.colRange(left, right) = 0;
  FeatureTracker tracker({});
  for (const int shift : shifts) tracker.Add(SoftView(shift), Eigen::Matrix3d::Identity(), mask);
  int before = 0, behind = 0;
  for (const FeatureTrack& track : tracker.Tracks()) {
    for (const FeatureTrack::Place& place : track.places) {
      EXPECT_TRUE(place.pixel.x() < left || place.pixel.x() >= right) << place.pixel.x();
    }
    (track.places.front().pixel.x() < left ? before : behind) += 1;
    EXPECT_LT(MotionError(track, shifts), 20.0);
  }
  EXPECT_GT(before, 20);
  EXPECT_GT(behind, 20);
}

TEST(FeatureTrackerTest, NothingOfAnEmptyImage) {
  FeatureTracker tracker({});
  for (int i = 0; i < 3; ++i) tracker.Add(cv::Mat(48, 64, CV_8UC1, cv::Scalar(90)));
  EXPECT_TRUE(tracker.Tracks().empty());
}

}  // namespace
}  // namespace soslam
