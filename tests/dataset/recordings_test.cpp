// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/error.h"
#include "dataset/kitti_label.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

TEST(ParseRecordings, ReadsNumbersAndRanges) {
  const auto ranges = ParseRecordings("sequences", " 0001  0003-0005 ");
  ASSERT_EQ(ranges.size(), 2u);
  EXPECT_TRUE(ranges[0].Contains(1));
  EXPECT_FALSE(ranges[0].Contains(2));
  EXPECT_TRUE(ranges[1].Contains(3));
  EXPECT_TRUE(ranges[1].Contains(5));
  EXPECT_FALSE(ranges[1].Contains(6));
  EXPECT_TRUE(ParseRecordings("sequences", "").empty());
}

TEST(ParseRecordings, RefusesAnythingElse) {
  for (const char* text : {"one", "1-", "-1", "5-3", "1,2", "99999999999"}) {
    ExpectError<SettingsError>([&] { ParseRecordings("sequences", text); }, {"sequences"});
  }
}

TEST(RecordingValues, AreThoseOfTheirRecordings) {
  const RecordingValues values("scale", "0000-0013:0.969 0020:0.988");
  EXPECT_EQ(values.PositiveOf(0), 0.969);
  EXPECT_EQ(values.PositiveOf(13), 0.969);
  EXPECT_EQ(values.Of(20), "0.988");
  ExpectError<SettingsError>([&] { values.Of(14); }, {"scale", "0014"});
}

TEST(RecordingValues, OneValueIsForAll) {
  EXPECT_EQ(RecordingValues("scale", "0.5").PositiveOf(77), 0.5);
}

TEST(RecordingValues, RefusesWhatIsNoValue) {
  ExpectError<SettingsError>([] { RecordingValues("scale", "0.5 0.6"); }, {"scale", "0.5"});
  ExpectError<SettingsError>([] { RecordingValues("scale", "a:0.6"); }, {"scale", "a"});
  for (const char* text : {"0", "-1", "much", "0001:"}) {
    ExpectError<SettingsError>([&] { RecordingValues("scale", text).PositiveOf(1); }, {"scale"});
  }
}

}  // namespace
}  // namespace soslam
