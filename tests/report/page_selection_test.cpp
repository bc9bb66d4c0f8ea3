// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/page_parts.h"

namespace soslam {
namespace {

using testing::ElementsAre;

// Frames with ids 10, 20, ...; a detection in every `step`-th.
Sequence Recording(int frames, int step) {
  Sequence sequence;
  sequence.objects = {{7, "cup", kNoPlane, {}}};
  for (int i = 0; i < frames; ++i) {
    Frame frame;
    frame.id = 10 * (i + 1);
    sequence.frames.push_back(frame);
    Detection detection;
    detection.frame_index = i;
    if (i % step == 0) sequence.detections.push_back(detection);
  }
  return sequence;
}

const auto kNoImage = [](int) { return false; };

TEST(FramesToShow, AreThoseWithImages) {
  EXPECT_THAT(FramesToShow(Recording(9, 2), [](int frame) { return frame % 4 == 1; }),
              ElementsAre(20, 60));
}

TEST(FramesToShow, AreAllWhereThereAreNoImages) {
  EXPECT_EQ(FramesToShow(Recording(9, 2), kNoImage).size(), 9u);
}

TEST(FramesToShow, AreFewOfManyAndHaveDetections) {
  const Sequence sequence = Recording(1000, 4);
  const std::set<int> ids = FramesToShow(sequence, kNoImage);
  EXPECT_EQ(ids.size(), kMaxShownFrames);
  for (const int id : ids) EXPECT_EQ((id / 10 - 1) % 4, 0);
  EXPECT_GT(*ids.rbegin(), 9000);
}

TEST(SelectForPage, HasAllThatIsShownAndSomeOfTheWay) {
  const Sequence sequence = Recording(5000, 2);
  const PageSelection selection = SelectForPage(sequence, {10, 40, 30030});
  EXPECT_THAT(selection.shown, ElementsAre(0, 3, 3002));
  EXPECT_THAT(selection.detections, ElementsAre(0, 1501));
  EXPECT_GE(selection.frames.size(), kMaxWayFrames);
  EXPECT_LE(selection.frames.size(), kMaxWayFrames + 3);
  for (const int frame : selection.shown) {
    EXPECT_TRUE(selection.Shows(frame));
    EXPECT_EQ(selection.frames[selection.PlaceOfFrame(frame)], frame);
  }
  EXPECT_EQ(selection.PlaceOfDetection(1501), 1);
  EXPECT_FALSE(selection.Shows(1));
}

}  // namespace
}  // namespace soslam
