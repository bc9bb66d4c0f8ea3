// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "artefact/json_file.h"
#include "report/paper_tables.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

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

TEST(Published, FindsTablesByNumberAndQuantity) {
  const Published published = ReadPublished(kFile);
  const PublishedTable* const table = published.Find("II", kRotation);
  ASSERT_NE(table, nullptr);
  EXPECT_EQ(table->rows.front().dataset, "icl_room2");
  EXPECT_EQ(table->rows.front().values.at("InitPT"), 13.97);
  EXPECT_EQ(published.Find("II", kIou), nullptr);
  EXPECT_EQ(published.times.values.at(3).ms_mean, 295.3);
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
