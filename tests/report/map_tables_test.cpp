// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/tables.h"
#include "support/map_metrics.h"
#include "support/table_cells.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

const json kExact = json::array({Alignment("none", 1.0, 3, 0.0)});

json FalseLandmark(int id, const json& true_object, const char* reason) {
  return {{"object", id},     {"label", "jar"}, {"fate", "false"}, {"true_object", true_object},
          {"reason", reason}, {"detail", ""}};
}

json FoundLandmark(int true_object, const json& wrong_part) {
  return {{"object", 5},
          {"label", "bowl"},
          {"fate", "found"},
          {"true_object", true_object},
          {"reason", nullptr},
          {"detail", nullptr},
          {"wrong_part", wrong_part},
          {"errors",
           {{"iou", 0.5},
            {"centre_m", 0.25},
            {"log_size", {0.5, -0.25, 0.0}},
            {"yaw_error_deg", nullptr}}}};
}

std::vector<DatasetResult> OneMap(const json& metrics, const std::filesystem::path& folder = {}) {
  return {{"room", {{"OursS", folder, metrics}}}};
}

TEST(MapsTable, SaysWhatTheVariantWasGiven) {
  const TemporaryFolder folder;
  WriteBytes(folder / "associations.json", "");
  const Table table = MapsTable(OneMap(MapMetrics(kExact), folder.path()), {"OursSTE", "OursS"});
  EXPECT_THAT(CellTexts(table),
              ElementsAre("room OursS estimated given 4 (3) 5 (1) 0.75 3 0.88 0.62 0.75 0.500 2 "
                          "0.88 0.62 0.50 0.500"));
  EXPECT_EQ(table.header.size(), table.rows.front().size());
}

TEST(LostTable, JoinsTheObjectsOfAReason) {
  json metrics = MapMetrics(kExact);
  metrics["map_quality"]["objects"].push_back(
      {{"true_object", 9}, {"label", "can"}, {"reason", "not_detected"}, {"detail", ""}});
  EXPECT_THAT(CellTexts(LostTable(OneMap(metrics), {"OursS"})),
              ElementsAre("room OursS missed not detected cup 7, can 9",
                          "room OursS false background tv 2"));
}

TEST(LostTable, VariantsWithTheSameMistakesShareARow) {
  std::vector<DatasetResult> datasets = OneMap(MapMetrics(kExact));
  datasets[0].variants.push_back({"OursSTE", {}, MapMetrics(kExact)});
  datasets[0].variants[1].metrics["map_quality"]["landmarks"] = json::array();
  EXPECT_THAT(CellTexts(LostTable(datasets, {"OursS", "OursSTE"})),
              ElementsAre("room OursS, OursSTE missed not detected cup 7",
                          "room OursS false background tv 2"));
}

TEST(LostTable, TheLandmarkOfAMissedObjectIsNotListedAgain) {
  json metrics = MapMetrics(kExact);
  metrics["map_quality"]["landmarks"] = {FalseLandmark(1, 7, "wrong_size"),
                                         FalseLandmark(3, 8, "duplicate")};
  EXPECT_THAT(
      CellTexts(LostTable(OneMap(metrics), {"OursS"})),
      ElementsAre("room OursS missed not detected cup 7", "room OursS false duplicate jar 3"));
}

TEST(LimitsTable, HasTheFoundLandmarks) {
  json metrics = MapMetrics(kExact);
  metrics["map_quality"]["landmarks"].push_back(
      FoundLandmark(8, {{"part", "size"}, {"iou_corrected", 0.75}}));
  metrics["map_quality"]["landmarks"].push_back(FoundLandmark(6, nullptr));
  EXPECT_THAT(CellTexts(LimitsTable(OneMap(metrics), {"OursS"})),
              ElementsAre("room OursS bowl 8 size 0.500 0.750 0.250 0.50, -0.25, 0.00 -",
                          "room OursS bowl 6 - 0.500 - 0.250 0.50, -0.25, 0.00 -"));
}

TEST(MapTables, HaveNoRowsOfVariantsWithoutAMap) {
  const std::vector<DatasetResult> datasets = OneMap({{"summary", json::object()}});
  for (const auto& table_of : {&MapsTable, &LostTable, &LimitsTable}) {
    EXPECT_THAT(table_of(datasets, {"OursS", "InitP"}).rows, IsEmpty());
  }
}

}  // namespace
}  // namespace soslam
