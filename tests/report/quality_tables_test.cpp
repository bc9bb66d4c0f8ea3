// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/tables.h"
#include "support/map_metrics.h"
#include "support/table_cells.h"

namespace soslam {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(QualityTables, HaveARowForEachMap) {
  const auto tables = QualityTables(
      "room", {{"InitP", json::object()},
               {"OursS", MapMetrics(json::array({Alignment("rigid", 1.0, 9, 0.25)}))}});
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].name, "map_quality_room");
  EXPECT_THAT(CellTexts(tables[0]),
              ElementsAre("OursS 4 (3) 5 (1) 0.75 3 0.88 0.62 0.75 0.500 2 0.88 0.62 0.50 0.500"));
  EXPECT_THAT(tables[0].notes,
              ElementsAre(testing::StartsWith("True objects"), "Odometry: ORB-SLAM2."));
  EXPECT_EQ(tables[1].name, "map_errors_room");
  EXPECT_THAT(CellTexts(tables[1]),
              ElementsAre("OursS 0.125 0.25 0.10, 0.20, - 0.062 - 1.5 0.010 2.5 2 of 3 1 of 3 "
                          "0.625 0.500"));
  for (const Table& table : tables) EXPECT_EQ(table.header.size(), table.rows.front().size());
}

TEST(QualityTables, TitlesSayWhatAlignedTheMaps) {
  const auto title = [](const std::vector<json>& alignments) {
    std::vector<NamedMetrics> variants;
    for (const json& of_map : alignments) variants.emplace_back("OursS", MapMetrics(of_map));
    const std::string text = QualityTables("road", variants)[0].title;
    return text.substr(text.find("alignment"));
  };
  // sqrt((3 * 0.01 + 0.25) / 4)
  EXPECT_EQ(title({{Alignment("none", 1.0, 3, 0.1), Alignment("none", 1.0, 1, 0.5)}}),
            "alignment none, cameras 0.2646 m apart");
  EXPECT_EQ(
      title({{Alignment("similarity", 2.5, 9, 0.25)}, {Alignment("similarity", 2.0, 9, 0.5)}}),
      "alignment similarity, scale 2 to 2.5, cameras 0.25 to 0.5 m apart");
  json unknown = Alignment("none", 1.0, 0, 0.0);
  unknown["rmse_m"] = nullptr;
  EXPECT_EQ(title({{unknown}}), "alignment none");
}

TEST(QualityTables, RowsSayTheirAlignmentWhereOthersHaveAnother) {
  const auto tables = QualityTables(
      "road", {{"OursS", MapMetrics(json::array({Alignment("none", 1.0, 3, 0.1)}))},
               {"OursP", MapMetrics(json::array({Alignment("rigid", 1.0, 3, 0.1)}))}});
  EXPECT_EQ(tables[0].rows[0][0].text, "OursS (none)");
  EXPECT_EQ(tables[1].rows[1][0].text, "OursP (rigid)");
}

TEST(QualityTables, AreNoneWithoutMaps) {
  EXPECT_THAT(QualityTables("room", {{"InitP", json::object()}, {"SVD", nullptr}}), IsEmpty());
}

TEST(MistakesTable, HasWhatIsMissedAndWhatIsFalse) {
  EXPECT_THAT(CellTexts(MistakesTable(MapMetrics(json::array()))),
              ElementsAre("missed cup 7 not detected 0 of 9", "false tv 2 background "));
  EXPECT_THAT(MistakesTable(json::object()).rows, IsEmpty());
}

}  // namespace
}  // namespace soslam
