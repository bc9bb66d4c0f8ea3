// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/artefact/files.h"
#include "soslam/geometry/distortion.h"
#include "soslam/image/distort_pixels.h"
#include "soslam/image/feature_tracks.h"
#include "soslam/stage/stages.h"
#include "support/printed.h"
#include "support/temporary_folder.h"
#include "support/wall_sequence.h"

namespace soslam {
namespace {

class RunTrackTest : public WallSequenceTest {
 protected:
  std::vector<MapPoint> Run(int threads = 2) {
    WriteSequence(folder_ / "sequence.json", sequence_, {});
    RunTrack({}, files_, threads);
    return ReadPoints(files_.at("output"));
  }
};

TEST_F(RunTrackTest, PointsLieOnThePicture) {
  const std::vector<MapPoint> points = Run();
  EXPECT_GT(points.size(), 100u);
  size_t right = 0;
  for (const MapPoint& point : points) {
    EXPECT_GE(point.observations.size(), 3u);
    EXPECT_LT(point.reprojection_error_px, 3.0);
    if (std::abs(point.position_in_world.z() - kDepthM) < 0.05) ++right;
  }
  EXPECT_GT(static_cast<double>(right), 0.95 * static_cast<double>(points.size()));
}

TEST_F(RunTrackTest, ObservationsAreWhereThePointsProject) {
  sequence_.image_distortion = Distortion{.k1 = -0.05};
  for (const MapPoint& point : Run()) {
    for (const PointObservation& observation : point.observations) {
      const Frame& frame = sequence_.frames[observation.frame_id / 5];
      ASSERT_EQ(frame.id, observation.frame_id);
      const auto pixel =
          sequence_.camera.Project(frame.world_from_camera.Inverse() * point.position_in_world);
      ASSERT_TRUE(pixel);
      const auto stored = DistortPixels(sequence_.camera, *sequence_.image_distortion, {*pixel});
      EXPECT_LT((stored.front() - observation.pixel).norm(), 3.5);
    }
  }
}

// A person stands before the picture, whose box is not used.
TEST_F(RunTrackTest, NoPointInABoxOfAPerson) {
  const Box person = {100.0, 20.0, 180.0, 200.0};
  const auto in_box = [&] {
    size_t count = 0;
    for (const MapPoint& point : Run()) {
      count += std::ranges::count_if(point.observations, [&](const PointObservation& seen) {
        return person.Contains(seen.pixel);
      });
    }
    return count;
  };
  for (int i = 0; i < kImages; ++i) {
    sequence_.rejected.push_back(
        {i, "person", 0.5, person, {}, RejectingStage::kImport, "near_border"});
  }
  EXPECT_EQ(in_box(), 0u);
  sequence_.moving_labels = "dog";
  EXPECT_GT(in_box(), 100u);
}

TEST_F(RunTrackTest, SameBytesForAnyNumberOfThreads) {
  ExpectSameBytesForThreads([&](int threads) { Run(threads); }, {files_.at("output")});
}

TEST_F(RunTrackTest, PointsOfASegmentAreSeenInIt) {
  for (size_t i = 4; i < sequence_.frames.size(); ++i) sequence_.frames[i].segment = 1;
  for (const MapPoint& point : Run()) {
    EXPECT_EQ(point.observations.front().frame_id < 20, point.observations.back().frame_id < 20);
  }
}

// Without points, the file is empty, and the warning has the cause.
TEST_F(RunTrackTest, WithoutPointsTheCauseIsNamed) {
  const auto expect_warning = [&](const std::vector<std::string>& words) {
    const std::string warning = PrintedBy([&] { EXPECT_TRUE(Run().empty()); }).errors;
    for (const std::string& word : words) EXPECT_NE(warning.find(word), std::string::npos) << word;
  };
  const std::vector<Frame> frames = sequence_.frames;
  for (Frame& frame : sequence_.frames) frame.world_from_camera.translation.setZero();
  expect_warning({"no point", "9 images", "does not move"});
  sequence_.frames = frames;
  for (Frame& frame : sequence_.frames) {
    frame.world_from_camera.translation =
        frame.world_from_camera.translation.x() * Eigen::Vector3d(0.0, 20.0, 0.0);
  }
  expect_warning({"no point", "poses do not fit"});
  sequence_.frames = frames;
  for (size_t i = 0; i < frames.size(); ++i) sequence_.frames[i].segment = static_cast<int>(i);
  expect_warning({"no track over 3 images"});
  sequence_.frames = {frames[0]};
  expect_warning({"1 image", "at least 3 images"});
}

}  // namespace
}  // namespace soslam
