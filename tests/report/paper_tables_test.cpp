// SPDX-License-Identifier: BSD-3-Clause
#include "report/paper_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/results_folder.h"
#include "support/table_cells.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::IsEmpty;

Published OnePublishedTable() {
  return {{{"III",
            "iou",
            "A paper, Table III",
            {{"hall", 5, {{"Quadric", 0.1}}}, {"room", 3, {{"OursP", 0.25}}}},
            {"average", 8, {{"OursP", 0.2}}}}},
          {}};
}

TEST(WeightedMean, WeightsByObjects) {
  const ObjectMean mean = WeightedMean({{0.2, 1, 10}, {0.6, 3, 20}});
  EXPECT_NEAR(mean.mean, 0.5, 1e-12);
  EXPECT_EQ(mean.objects, 4);
  EXPECT_EQ(mean.observations, 30);
}

TEST(PaperTables, NoneWithoutAMeasuredValue) {
  const ResultsFolder results;
  results.WriteMetrics("room", "InitP-fine", {{.id = 1, .iou = 0.5}});
  EXPECT_THAT(PaperTables(ReadResults(results.path()), OnePublishedTable()), IsEmpty());
}

TEST(PaperTables, PublishedRowsStandBelowMeasuredOnes) {
  const ResultsFolder results;
  results.WriteMetrics("attic", "OursP", {{.id = 1, .iou = 0.5}});
  results.WriteMetrics("room", "OursP", {{.id = 1, .iou = 0.25, .observations = 7}});
  results.WriteMetrics("room", "OursSTE", {{.id = 1, .iou = 0.75, .observations = 7}});
  const auto tables = PaperTables(ReadResults(results.path()), OnePublishedTable());
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(tables[0].title, "Map, IoU (Table III)");
  EXPECT_THAT(
      CellTexts(tables[0]),
      ElementsAre("hall published 5 - 0.100 - - - - -", "room measured 1 7 - 0.250 - - - *0.750*",
                  "room published 3 - - 0.250 - - - -", "attic measured 1 1 - *0.500* - - - -",
                  "average published 8 - - 0.200 - - - -"));
  EXPECT_EQ(tables[0].notes.back(), "Published: A paper, Table III.");
}

TEST(PaperTables, SingleFrameVariantsHaveARowForTheFirstObservation) {
  const ResultsFolder results;
  results.WriteMetrics("room", "SVD", {{.id = 1, .iou = 0.25, .observations = 7}});
  results.WriteMetrics("room", "InitP", {{.id = 1, .iou = 0.5, .observations = 7}}, true);
  const auto tables = PaperTables(ReadResults(results.path()), {});
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_THAT(CellTexts(tables[0]),
              ElementsAre("room all observations 1 7 0.250 - - *0.500* - - - - -",
                          "room first observation 1 1 - - - *0.500* - - - - -"));
}

TEST(PaperTables, ValuesOverFewerObjectsSaySo) {
  const ResultsFolder results;
  results.WriteMetrics("room", "Quadric", {{.id = 1, .rotation_deg = 5.0}, {.id = 2}});
  for (const char* variant : {"OursP", "OursPT"}) {
    results.WriteMetrics("room", variant,
                         {{.id = 1, .rotation_deg = 2.0}, {.id = 2, .rotation_deg = 4.0}});
  }
  const auto tables = PaperTables(ReadResults(results.path()), {});
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_THAT(CellTexts(tables[1]), ElementsAre("room measured 2 2 5.00 (1) *3.00* *3.00* - - -"));
}

// Neither the best, which has fewer objects, nor the best of the rest, which it beats.
TEST(PaperTables, NoValueIsBoldWhereTheBestIsOverFewerObjects) {
  const ResultsFolder results;
  results.WriteMetrics("room", "Quadric", {{.id = 1, .rotation_deg = 1.0}, {.id = 2}});
  results.WriteMetrics("room", "OursP",
                       {{.id = 1, .rotation_deg = 2.0}, {.id = 2, .rotation_deg = 4.0}});
  const auto tables = PaperTables(ReadResults(results.path()), {});
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_THAT(CellTexts(tables[1]), ElementsAre("room measured 2 2 1.00 (1) 3.00 - - - -"));
}

TEST(PaperTables, AverageIsOverDatasetsThatAllVariantsHave) {
  const ResultsFolder results;
  for (const char* variant : {"OursP", "OursS"}) {
    results.WriteMetrics("attic", variant, {{.id = 1, .iou = 0.2}});
    results.WriteMetrics("room", variant,
                         {{.id = 1, .iou = 0.5}, {.id = 2, .iou = 0.6}, {.id = 3, .iou = 0.7}});
  }
  results.WriteMetrics("shed", "OursP", {{.id = 1, .iou = 0.9}});
  const auto tables = PaperTables(ReadResults(results.path()), {});
  ASSERT_EQ(tables.size(), 1u);
  EXPECT_EQ(CellTexts(tables[0]).back(), "average measured 4 4 - *0.500* - *0.500* - -");
  EXPECT_THAT(tables[0].notes.back(), EndsWith(": attic, room."));
}

}  // namespace
}  // namespace soslam
