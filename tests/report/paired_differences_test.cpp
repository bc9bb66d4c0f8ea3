// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/base/error.h"
#include "soslam/report/tables.h"
#include "support/expect_error.h"
#include "support/results_folder.h"

namespace soslam {
namespace {

using testing::ElementsAre;

// The 97.5 % quantiles of printed tables, to their three decimals.
TEST(StudentT95, IsThatOfPrintedTables) {
  const std::vector<std::pair<int, double>> table = {
      {1, 12.706}, {2, 4.303},  {3, 3.182},  {4, 2.776},   {7, 2.365},
      {10, 2.228}, {18, 2.101}, {30, 2.042}, {120, 1.980}, {1000, 1.962}};
  for (const auto& [degrees_of_freedom, t] : table) {
    EXPECT_NEAR(StudentT95(degrees_of_freedom), t, 5e-4) << degrees_of_freedom;
  }
}

// Mean 0.02; squares of deviations 0.0002 in all, so the standard error is sqrt(0.0002 / 2 / 3) =
// 0.0057735, and t of 2 degrees of freedom is 4.302653.
TEST(MeanDifference, WorkedByHand) {
  const PairedDifference difference = MeanDifference({0.01, 0.02, 0.03});
  EXPECT_NEAR(difference.mean, 0.02, 1e-12);
  ASSERT_TRUE(difference.confidence_95);
  EXPECT_NEAR(difference.confidence_95->low, 0.02 - 4.302653 * 0.00577350, 1e-7);
  EXPECT_NEAR(difference.confidence_95->high, 0.02 + 4.302653 * 0.00577350, 1e-7);
}

TEST(ParseComparisons, EachVariantWithThoseBeforeItInAListOfTwoOrMore) {
  std::vector<std::string> texts;
  for (const Comparison& comparison : ParseComparisons("A B C, D Init1-1")) {
    texts.push_back(comparison.variant + " " + comparison.baseline);
  }
  EXPECT_THAT(texts, ElementsAre("B A", "C A", "C B", "Init1-1 D"));
  EXPECT_TRUE(ParseComparisons("").empty());
  ExpectError<SettingsError>([] { ParseComparisons("A B, C"); }, {"compare", "C"});
}

TEST(DifferencesTable, PairsByObjectWithinAndOverDatasets) {
  const ResultsFolder results;
  // Objects in another order, and one that only one variant has.
  results.WriteMetrics("desk", "A", {{.id = 1, .iou = 0.1}, {.id = 2, .iou = 0.5}});
  results.WriteMetrics("desk", "B", {{.id = 2, .iou = 0.6}, {.id = 1, .iou = 0.2}});
  results.WriteMetrics("room", "A", {{.id = 1, .iou = 0.4}});
  results.WriteMetrics("room", "B", {{.id = 1, .iou = 0.5}, {.id = 3, .iou = 0.9}});
  results.WriteMetrics("shed", "B", {{.id = 1, .iou = 0.5}});
  const Table table =
      DifferencesTable(ReadResults(results.path()), ParseComparisons("A B, A C"), kIou);
  EXPECT_THAT(CellTexts(table),
              ElementsAre("desk B A 2 *+0.100* +0.100 +0.100", "room B A 1 +0.100 - -",
                          "all datasets B A 3 *+0.100* +0.100 +0.100"));
}

TEST(DifferencesTable, OnlyIntervalsWithoutZeroAreBold) {
  const ResultsFolder results;
  results.WriteMetrics("desk", "A",
                       {{.id = 1, .rotation_deg = 1.0}, {.id = 2, .rotation_deg = 5.0}, {.id = 3}});
  results.WriteMetrics("desk", "B",
                       {{.id = 1, .rotation_deg = 4.0},
                        {.id = 2, .rotation_deg = 4.0},
                        {.id = 3, .rotation_deg = 1.0}});
  const Table table =
      DifferencesTable(ReadResults(results.path()), ParseComparisons("A B"), kRotation);
  // Differences 3 and -1: mean 1, standard error 2, t of one degree of freedom 12.706.
  EXPECT_THAT(CellTexts(table), ElementsAre("desk B A 2 +1.00 -24.41 +26.41"));
}

TEST(DifferencesTable, ADetectorsBoxesHaveARowOfTheirOwn) {
  const ResultsFolder results;
  for (const char* dataset : {"attic", "hall", "room"}) {
    results.WriteMetrics(dataset, "A", {{.id = 1, .iou = 0.25, .rotation_deg = 3.0}});
    results.WriteMetrics(dataset, "B", {{.id = 1, .iou = 0.5, .rotation_deg = 1.0}});
  }
  std::vector<DatasetResult> datasets = ReadResults(results.path());
  for (const int of_detector : {0, 1}) datasets[of_detector].facts.boxes_of = BoxesOf::kDetector;
  const auto comparisons = ParseComparisons("A B");
  const auto rows = CellTexts(DifferencesTable(datasets, comparisons, kIou));
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[3], "detector's boxes B A 2 *+0.250* +0.250 +0.250");
  EXPECT_EQ(rows[4], "all datasets B A 3 *+0.250* +0.250 +0.250");
  EXPECT_THAT(CellTexts(DifferencesOverDatasets(datasets, comparisons)),
              ElementsAre("B A detector's boxes 2 *+0.250 (+0.250 to +0.250)* 2 *-2.00 (-2.00 to "
                          "-2.00)*",
                          "B A all datasets 3 *+0.250 (+0.250 to +0.250)* 3 *-2.00 (-2.00 to "
                          "-2.00)*"));
}

}  // namespace
}  // namespace soslam
