// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/geometry/distortion.h"
#include "soslam/image/box_colours.h"
#include "soslam/image/feature_matches.h"
#include "soslam/image/undistorted_points.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/printed.h"
#include "support/temporary_folder.h"
#include "support/wall_sequence.h"

namespace soslam {
namespace {

class RunMatchTest : public WallSequenceTest {
 protected:
  ImageMatches RunAll(int threads = 2) {
    WriteSequence(folder_ / "sequence.json", sequence_, {});
    RunMatch({}, files_, threads);
    return ReadMatches(files_.at("output"));
  }
  std::vector<PointTrack> Run(int threads = 2) { return RunAll(threads).tracks; }

  // Where an observation lies in the picture on the wall.
  Eigen::Vector2d PlaceOf(const PointObservation& observation) const {
    const auto pixel = UndistortedPixel(sequence_, observation);
    return *pixel + Eigen::Vector2d(kShiftPx * observation.frame_id / 5, 0.0);
  }
};

TEST_F(RunMatchTest, TracksAreOfOnePlaceOfThePicture) {
  const std::vector<PointTrack> tracks = Run();
  EXPECT_GT(tracks.size(), 100u);
  size_t right = 0, through_all = 0;
  for (const PointTrack& track : tracks) {
    ASSERT_GE(track.observations.size(), 2u);
    const Eigen::Vector2d place = PlaceOf(track.observations.front());
    right += std::ranges::all_of(track.observations, [&](const PointObservation& observation) {
      return (PlaceOf(observation) - place).norm() < 2.0;
    });
    through_all += track.observations.size() == kImages;
  }
  EXPECT_GT(static_cast<double>(right), 0.95 * static_cast<double>(tracks.size()));
  EXPECT_GT(through_all, 20u);
}

// Frames between have no image.
TEST_F(RunMatchTest, ThePlaceIsFoundAgain) {
  for (const int i : {1, 2, 3}) sequence_.frames[i].image.clear();
  size_t found = 0;
  for (const PointTrack& track : Run()) {
    found += track.observations.front().frame_id == 0 && track.observations.back().frame_id >= 20;
  }
  EXPECT_GT(found, 50u);
}

TEST_F(RunMatchTest, PixelsAreThoseOfTheImageAsStored) {
  const std::vector<PointTrack> straight = Run();
  sequence_.image_distortion = Distortion{.k1 = -0.05};
  const std::vector<PointTrack> tracks = Run();
  EXPECT_GT(tracks.size(), 50u);
  // The images are the same, so their corners are where they were.
  size_t same = 0, all = 0;
  for (const PointTrack& track : tracks) {
    const PointObservation& seen = track.observations.front();
    all += 1;
    same += std::ranges::any_of(straight, [&](const PointTrack& other) {
      return std::ranges::any_of(other.observations, [&](const PointObservation& one) {
        return one.frame_id == seen.frame_id && (one.pixel - seen.pixel).norm() < 1.0;
      });
    });
  }
  EXPECT_GT(static_cast<double>(same), 0.7 * static_cast<double>(all));
}

TEST_F(RunMatchTest, ColoursAreThoseOfTheBoxes) {
  sequence_.objects = {{1, "picture", kNoPlane, {}}};
  for (int i = 0; i < kImages; ++i) {
    Detection& detection = sequence_.detections.emplace_back();
    detection.frame_index = i;
    detection.object_index = 0;
    detection.box = {20.0 + 5.0 * i, 30.0, 90.0 + 5.0 * i, 120.0};
  }
  const auto colours = RunAll().colours;
  ASSERT_EQ(colours.size(), sequence_.detections.size());
  for (const FrameImage& image :
       FrameImages(sequence_, files_.at("dataset"), files_.at("sequence"))) {
    const auto i = static_cast<size_t>(image.frame - sequence_.frames.data());
    EXPECT_EQ(colours[i], ColoursIn(cv::imread(image.path.string()), sequence_.detections[i].box))
        << i;
  }
}

TEST_F(RunMatchTest, SameBytesForAnyNumberOfThreads) {
  ExpectSameBytesForThreads([&](int threads) { Run(threads); }, {files_.at("output")});
}

TEST_F(RunMatchTest, TracksStayInTheirSegment) {
  for (size_t i = 4; i < sequence_.frames.size(); ++i) sequence_.frames[i].segment = 1;
  const std::vector<PointTrack> tracks = Run();
  EXPECT_GT(tracks.size(), 100u);
  for (const PointTrack& track : tracks) {
    EXPECT_EQ(track.observations.front().frame_id < 20, track.observations.back().frame_id < 20);
  }
}

TEST_F(RunMatchTest, WithoutMatchesTheCauseIsNamed) {
  sequence_.frames.resize(1);
  const std::string warning = PrintedBy([&] { EXPECT_TRUE(Run().empty()); }).errors;
  EXPECT_THAT(warning, testing::HasSubstr("no two of 1 image share a point"));
  sequence_.frames[0].image.clear();
  ExpectError<NothingUsableError>([&] { Run(); }, {"sequence.json", "has an image"});
}

}  // namespace
}  // namespace soslam
