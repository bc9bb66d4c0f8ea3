// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/json_file.h"
#include "soslam/report/tables.h"
#include "support/expect_error.h"
#include "support/results_folder.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::IsEmpty;

Published OnePublishedTable() {
  return {"whole sequences",
          {{"III",
            "iou",
            "A paper, Table III",
            {{"hall", 5, {{"Quadric", 0.1}}}, {"room", 3, {{"OursP", 0.25}}}},
            {"average", 8, {{"OursP", 0.2}}}}},
          {}};
}

class PaperTablesTest : public testing::Test {
 protected:
  std::vector<DatasetResult> Read() const { return ReadResults(results_.path()); }
  // The last of `count` tables.
  static Table TableOf(const std::vector<DatasetResult>& datasets, const Published& published = {},
                       size_t count = 1) {
    const auto tables = PaperTables(datasets, published);
    EXPECT_EQ(tables.size(), count);
    return tables.empty() ? Table() : tables.back();
  }

  const ResultsFolder results_;
};

TEST_F(PaperTablesTest, NoneWithoutAMeasuredValue) {
  results_.WriteMetrics("room", "InitP-fine", {{.id = 1, .iou = 0.5}});
  EXPECT_THAT(PaperTables(Read(), OnePublishedTable()), IsEmpty());
}

TEST(ReadPublished, RefusesAQuantityThatIsNone) {
  const TemporaryFolder folder;
  const nlohmann::json means = {{"objects", 3}, {"values", {{"OursS", 0.5}}}};
  const auto path =
      WriteBytes(folder / "published.json", nlohmann::json({{"tables",
                                                             {{{"table", "I"},
                                                               {"quantity", "iuo"},
                                                               {"source", "a paper"},
                                                               {"rows", nlohmann::json::array()},
                                                               {"average", means}}}}})
                                                .dump());
  ExpectError<InputError>([&] { ReadPublished(path); },
                          {"published.json: /tables/0: quantity is \"iuo\""});
}

TEST_F(PaperTablesTest, PublishedRowsStandBelowMeasuredOnes) {
  results_.WriteMetrics("attic", "OursP", {{.id = 1, .iou = 0.5}});
  results_.WriteMetrics("room", "OursP", {{.id = 1, .iou = 0.25, .observations = 7}});
  results_.WriteMetrics("room", "OursSTE", {{.id = 1, .iou = 0.75, .observations = 7}});
  const Table table = TableOf(Read(), OnePublishedTable());
  EXPECT_EQ(table.title, "Map, IoU (Table III)");
  EXPECT_THAT(CellTexts(table), ElementsAre("hall published - 5 - 0.100 - - - - - - -",
                                            "room measured f 1 7 - 0.250 - - - *0.750* - -",
                                            "room published - 3 - - 0.250 - - - - - -",
                                            "attic measured f 1 1 - *0.500* - - - - - -",
                                            "average published - 8 - - 0.200 - - - - - -"));
  EXPECT_EQ(table.notes.back(), "Published: A paper, Table III: whole sequences.");
}

TEST_F(PaperTablesTest, SingleFrameVariantsHaveARowForTheFirstObservation) {
  results_.WriteMetrics("room", "SVD", {{.id = 1, .iou = 0.25, .observations = 7}});
  results_.WriteMetrics("room", "InitP", {{.id = 1, .iou = 0.5, .observations = 7}}, true);
  const Table table = TableOf(Read());
  EXPECT_THAT(CellTexts(table),
              ElementsAre("room all observations f 1 7 0.250 - - *0.500* - - - - - - -",
                          "room first observation f 1 1 - - - *0.500* - - - - - - -"));
}

TEST_F(PaperTablesTest, ObservationsThatDifferAreThoseOfANamedVariant) {
  results_.WriteMetrics("room", "Quadric", {{.id = 1, .iou = 0.5, .observations = 5}});
  for (const char* variant : {"OursS", "OursST"}) {
    results_.WriteMetrics("room", variant, {{.id = 1, .iou = 0.5, .observations = 7}});
  }
  EXPECT_THAT(CellTexts(TableOf(Read())),
              ElementsAre("room measured f 1 7 (OursS) *0.500* - - *0.500* *0.500* - - -"));
}

TEST_F(PaperTablesTest, ValuesOverFewerObjectsSaySo) {
  results_.WriteMetrics("room", "Quadric", {{.id = 1, .rotation_deg = 5.0}, {.id = 2}});
  for (const char* variant : {"OursP", "OursPT"}) {
    results_.WriteMetrics("room", variant,
                          {{.id = 1, .rotation_deg = 2.0}, {.id = 2, .rotation_deg = 4.0}});
  }
  const Table table = TableOf(Read(), {}, 2);
  EXPECT_THAT(CellTexts(table),
              ElementsAre("room measured f 2 2 5.00 (1) *3.00* *3.00* - - - - -"));
}

// Neither the best, which has fewer objects, nor the best of the rest, which it beats.
TEST_F(PaperTablesTest, NoValueIsBoldWhereTheBestIsOverFewerObjects) {
  results_.WriteMetrics("room", "Quadric", {{.id = 1, .rotation_deg = 1.0}, {.id = 2}});
  results_.WriteMetrics("room", "OursP",
                        {{.id = 1, .rotation_deg = 2.0}, {.id = 2, .rotation_deg = 4.0}});
  const Table table = TableOf(Read(), {}, 2);
  EXPECT_THAT(CellTexts(table), ElementsAre("room measured f 2 2 1.00 (1) 3.00 - - - - - -"));
}

TEST_F(PaperTablesTest, AverageIsOverDatasetsThatAllVariantsHave) {
  for (const char* variant : {"OursP", "OursS"}) {
    results_.WriteMetrics("attic", variant, {{.id = 1, .iou = 0.2}});
    results_.WriteMetrics("room", variant,
                          {{.id = 1, .iou = 0.5}, {.id = 2, .iou = 0.6}, {.id = 3, .iou = 0.7}});
  }
  results_.WriteMetrics("shed", "OursP", {{.id = 1, .iou = 0.9}});
  const Table table = TableOf(Read());
  EXPECT_EQ(CellTexts(table).back(), "average measured - 4 4 - *0.500* - *0.500* - - - -");
  EXPECT_THAT(table.notes.back(), EndsWith(": attic, room."));
}

// An attic that was seen instead of the published room.
TEST_F(PaperTablesTest, DatasetsStandAboveThePublishedOneThatTheyAreOf) {
  results_.WriteMetrics("attic", "OursP", {{.id = 1, .iou = 0.5}});
  results_.WriteMetrics("barn", "OursP-slow", {{.id = 1, .iou = 0.5}});
  std::vector<DatasetResult> datasets = Read();
  for (DatasetResult& dataset : datasets) {
    dataset.facts.published = "room";
    dataset.facts.differs = "another room";
  }
  const Table table = TableOf(datasets, OnePublishedTable());
  EXPECT_THAT(CellTexts(table), ElementsAre("hall published - 5 - 0.100 - - - - - - -",
                                            "attic measured f 1 1 - *0.500* - - - - - -",
                                            "room published - 3 - - 0.250 - - - - - -",
                                            "average published - 8 - - 0.200 - - - - - -"));
  EXPECT_THAT(table.notes,
              testing::Contains("Measured above published rows: attic (another room)."));
}

TEST_F(PaperTablesTest, ADetectorsBoxesHaveARowOverTheObjectsThatAllVariantsHave) {
  for (const char* dataset : {"attic", "hall", "room"}) {
    results_.WriteMetrics(dataset, "OursP", {{.id = 1, .iou = 0.2}, {.id = 2, .iou = 0.4}});
    results_.WriteMetrics(dataset, "OursS", {{.id = 2, .iou = 0.6}, {.id = 3, .iou = 1.0}});
  }
  results_.WriteMetrics("shed", "OursP", {{.id = 1, .iou = 0.9}});
  std::vector<DatasetResult> datasets = Read();
  for (const int of_detector : {0, 1, 3}) datasets[of_detector].facts.boxes_of = BoxesOf::kDetector;
  const Table table = TableOf(datasets);
  EXPECT_EQ(CellTexts(table).back(),
            "detector's boxes common objects f 2 - - 0.400 - *0.600* - - - -");
  EXPECT_THAT(table.notes.back(), EndsWith(" of attic, hall."));
}

const std::filesystem::path kFile =
    std::filesystem::path(SOSLAM_SOURCE_DIR) / "pipelines" / "published.json";

// Also shows that the paper weights its averages by objects: each value is rounded, so an average
// may be off by half a unit of its last place for the values and another half for itself.
TEST(Published, AveragesArePrintedAsWeightedByObjects) {
  const Published published = ReadPublished(kFile);
  ASSERT_EQ(published.tables.size(), 4u);
  for (const PublishedTable& table : published.tables) {
    const double last_place = table.quantity == "iou" ? 1e-3 : 1e-2;
    int objects = 0;
    for (const PublishedRow& row : table.rows) objects += row.objects;
    EXPECT_EQ(objects, table.average.objects) << table.table;
    for (const auto& [variant, average] : table.average.values) {
      std::vector<ObjectMean> means;
      for (const PublishedRow& row : table.rows) {
        means.push_back({row.values.at(variant), row.objects, 0});
      }
      EXPECT_NEAR(WeightedMean(means).mean, average, last_place + 1e-9)
          << table.table << " " << variant;
    }
  }
}

TEST(Published, RefusesWhatTheSchemaDoesNotAllow) {
  const TemporaryFolder folder;
  nlohmann::json document = ParseJsonFile(kFile);
  document["tables"][0]["rows"][0]["values"]["SVD"] = "low";
  WriteBytes(folder / "published.json", document.dump());
  ExpectError<InputError>([&] { ReadPublished(folder / "published.json"); },
                          {"published.json", "/tables/0/rows/0/values/SVD"});
}

}  // namespace
}  // namespace soslam
