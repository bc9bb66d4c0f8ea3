// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "report/results_tree.h"
#include "report/tables.h"
#include "support/expect_error.h"
#include "support/results_folder.h"
#include "support/table_cells.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using testing::ElementsAre;

TEST(DatasetFacts, AboutIsReadBesideTheSettings) {
  const TemporaryFolder folder;
  WriteBytes(
      folder / "room.json",
      R"({"import": {"labels": "cup"}, "about": {"boxes": "a network", "boxes_of": "detector"}})");
  DatasetFacts facts;
  facts.odometry = "COLMAP";
  ReadAbout(folder / "room.json", &facts);
  EXPECT_TRUE(facts.HasDetectorBoxes());
  EXPECT_EQ(DifferencesInWords(facts), "boxes: a network; odometry: COLMAP");
  ReadAbout(folder / "none.json", &facts);
  EXPECT_EQ(facts.boxes, "a network");
}

TEST(DatasetFacts, RefusesWhatTheSchemaDoesNotAllow) {
  const TemporaryFolder folder;
  WriteBytes(folder / "room.json", R"({"about": {"boxes_of": "hand"}})");
  DatasetFacts facts;
  ExpectError<InputError>([&] { ReadAbout(folder / "room.json", &facts); },
                          {"room.json", "/boxes_of", "hand"});
}

TEST(DatasetFacts, MarksSayWhatLimitsARow) {
  DatasetFacts facts;
  EXPECT_EQ(MarksOf(facts, 3), kNoValue);
  EXPECT_EQ(MarksOf(facts, 2), "f");
  facts.partly_annotated = true;
  facts.counts = DatasetCounts{.frames = 4, .objects = 3, .round_objects = 1};
  EXPECT_EQ(MarksOf(facts, 3), "p, r");
  EXPECT_EQ(DifferencesInWords(facts), "4 frames, 3 annotated objects");
}

// The settings of the project say of each dataset whose boxes it has.
TEST(DatasetFacts, AllDatasetsOfTheProjectAreDescribed) {
  const std::filesystem::path settings =
      std::filesystem::path(SOSLAM_SOURCE_DIR) / "pipelines" / "datasets";
  for (const auto& file : std::filesystem::directory_iterator(settings)) {
    DatasetFacts facts;
    ReadAbout(file.path(), &facts);
    EXPECT_FALSE(facts.boxes.empty()) << file.path();
    EXPECT_FALSE(facts.boxes_of.empty()) << file.path();
  }
}

TEST(SequencesTable, HasARowForEachCountedDataset) {
  DatasetFacts facts;
  facts.counts = DatasetCounts{.frames = 4, .objects = 3, .round_objects = 1};
  facts.boxes = "a network";
  EXPECT_THAT(CellTexts(SequencesTable({{"room", {}, facts}, {"attic", {}}})),
              ElementsAre("room a network - - r 4 3 1"));
}

}  // namespace
}  // namespace soslam
