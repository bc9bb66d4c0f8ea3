// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "geometry/angles.h"
#include "report/page_parts.h"

namespace soslam {
namespace {

// A curve over half a turn in steps of 2 degrees with `minima` equal minima, one of them at
// `lowest_deg`, another cost that knows nothing.
SymmetryRecord Record(double lowest_deg, int minima, double true_deg) {
  SymmetryRecord record;
  const double nan = std::nan("");
  for (int deg = 0; deg < 180; deg += 2) {
    record.yaw.push_back(deg * kRadPerDeg);
    record.cost["wave"].push_back(1.0 - std::cos(2.0 * minima * (deg - lowest_deg) * kRadPerDeg) -
                                  1e-3 * std::cos(2.0 * (deg - lowest_deg) * kRadPerDeg));
    record.cost["gap"].push_back(nan);
  }
  record.true_yaw = true_deg * kRadPerDeg;
  return record;
}

TEST(PageDescriptors, CountErrorsModuloHalfATurnAndMinima) {
  const auto found = PageDescriptors({Record(40, 1, 44), Record(10, 1, 190), Record(100, 1, 160)});
  ASSERT_EQ(found.size(), 1u);  // what has no cost anywhere says nothing
  const auto& wave = found.at("wave");
  EXPECT_EQ(wave.at("observations"), 3);
  EXPECT_NEAR(wave.at("median_error_deg").get<double>(), 4.0, 1e-3);
  // 4 degrees off twice, 60 once.
  EXPECT_EQ(wave.at("within")[0], 0.0);
  EXPECT_NEAR(wave.at("within")[1].get<double>(), 2.0 / 3.0, 1e-4);
  EXPECT_NEAR(wave.at("within")[11].get<double>(), 2.0 / 3.0, 1e-4);
  EXPECT_EQ(wave.at("within")[12], 1.0);
  EXPECT_EQ(wave.at("within")[90 / kErrorStepDeg], 1.0);
  EXPECT_EQ(wave.at("minima"), 1.0);
  EXPECT_EQ(PageDescriptors({Record(40, 3, 40)}).at("wave").at("minima"), 3.0);
}

TEST(PageDescriptors, TellWhereTheTrueYawHasNoCost) {
  SymmetryRecord gap = Record(40, 1, 100);
  for (size_t i = 45; i < 56; ++i) gap.cost["wave"][i] = std::nan("");  // 90 to 110 degrees
  const auto wave = PageDescriptors({gap, Record(40, 1, 44)}).at("wave");
  EXPECT_EQ(wave.at("known_at_truth"), 0.5);
  EXPECT_EQ(wave.at("near_where_known"), 1.0);
  EXPECT_EQ(wave.at("within")[2], 0.5);
  EXPECT_TRUE(PageDescriptors({gap}).at("wave").at("near_where_known").is_null());
}

TEST(PageDescriptors, NeedTheTruth) {
  SymmetryRecord record = Record(40, 1, 44);
  record.true_yaw.reset();
  EXPECT_TRUE(PageDescriptors({record}).empty());
}

Sequence Seen(int frames) {
  Sequence sequence;
  sequence.objects = {{7, "cup", kNoPlane, {}}};
  for (int i = 0; i < frames; ++i) {
    Frame frame;
    frame.id = 10 * i;
    sequence.frames.push_back(frame);
    Detection detection;
    detection.frame_index = i;
    sequence.detections.push_back(detection);
  }
  return sequence;
}

TEST(PageCurves, AreOfObservationsSpreadOverEachObject) {
  std::vector<SymmetryRecord> records;
  for (int i = 0; i < 9; ++i) {
    records.push_back(Record(40, 1, 44));
    records.back().frame_id = 10 * i;
    records.back().object_id = 7;
    records.back().samples.assign(500, {1.0f, 2.0f});
    records.back().mirrored.assign(500, {3.0f, 4.0f});
  }
  const Sequence sequence = Seen(9);
  const auto curves =
      PageCurves(records, sequence, SelectForPage(sequence, {0, 10, 20, 40, 50, 60}));
  ASSERT_EQ(curves.size(), kCurvesPerObject);
  EXPECT_EQ(curves[0].at("detection"), 0);
  EXPECT_EQ(curves[1].at("detection"), 2);
  EXPECT_EQ(curves[2].at("detection"), 4);
  EXPECT_TRUE(PageCurves(records, sequence, SelectForPage(sequence, {})).empty());
  EXPECT_NEAR(curves[0].at("true_yaw_deg").get<double>(), 44.0, 1e-3);
  EXPECT_TRUE(curves[0].at("refined_yaw_deg").is_null());
  EXPECT_EQ(curves[0].at("pairs").size(), kPairsOfCurve);
  EXPECT_EQ(curves[0].at("pairs")[0], nlohmann::json({1.0, 2.0, 3.0, 4.0}));
  EXPECT_EQ(curves[0].at("pairs_in_all"), 500);
  EXPECT_TRUE(curves[0].at("cost").at("gap")[0].is_null());
}

}  // namespace
}  // namespace soslam
