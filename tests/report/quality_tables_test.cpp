// SPDX-License-Identifier: BSD-3-Clause
#include "report/quality_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/table_cells.h"

namespace soslam {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

json Alignment(const char* kind, double scale, int frames, double rmse_m) {
  return {{"kind", kind}, {"scale", scale}, {"frames", frames}, {"rmse_m", rmse_m}};
}

json Score(int found, double f1) {
  return {{"true_objects", 4},
          {"detectable", 3},
          {"landmarks", 5},
          {"ignored", 1},
          {"found", found},
          {"f1", f1},
          {"recall_of_detectable", 0.75},
          {"of_found",
           {{"iou_mean", 0.5},
            {"centre_m_mean", 0.125},
            {"centre_relative_mean", 0.25},
            {"log_scale_abs_mean", std::log(1.25)},
            {"yaw_error_deg_mean", nullptr},
            {"up_error_deg_mean", 1.5},
            {"labels_agree", 2}}}};
}

json Metrics(const json& alignments) {
  return {
      {"odometry_source", "ORB-SLAM2"},
      {"map_quality",
       {{"alignments", alignments},
        {"scores", {Score(3, 0.75), Score(2, 0.5)}},
        {"in_frames", {{"iou_mean", 0.625}, {"iou_mean_in_world", 0.5}}},
        {"objects",
         {{{"true_object", 7}, {"label", "cup"}, {"reason", "not_detected"}, {"detail", "0 of 9"}},
          {{"true_object", 8}, {"label", "book"}, {"reason", nullptr}, {"detail", nullptr}}}},
        {"landmarks",
         {{{"object", 2}, {"label", "tv"}, {"reason", "background"}, {"detail", ""}}}}}}};
}

TEST(QualityTable, HasARowForEachMapWithWhatAlignedIt) {
  const Table table = QualityTable(
      "room", {{"InitP", json::object()},
               {"OursS", Metrics(json::array({Alignment("similarity", 2.0, 9, 0.25)}))}});
  EXPECT_EQ(table.name, "map_quality_room");
  EXPECT_THAT(
      CellTexts(table),
      ElementsAre("OursS similarity 2 0.2500 4 (3) 5 (1) 3, 0.750 2, 0.500 0.750 0.500 0.125 "
                  "0.25 1.250 - 1.5 2 of 3 0.625 0.500"));
  EXPECT_THAT(table.notes, ElementsAre("Odometry: ORB-SLAM2."));
  EXPECT_EQ(table.header.size(), table.rows.front().size());
}

TEST(QualityTable, ResidualsOfSegmentsCountByFrames) {
  const Table table =
      QualityTable("road", {{"OursS", Metrics(json::array({Alignment("none", 1.0, 3, 0.1),
                                                           Alignment("none", 1.0, 1, 0.5)}))}});
  EXPECT_EQ(table.rows.front()[1].text, "none");
  EXPECT_EQ(table.rows.front()[2].text, "0.2646");  // sqrt((3 * 0.01 + 0.25) / 4)
}

TEST(QualityTable, IsEmptyWithoutMaps) {
  EXPECT_THAT(QualityTable("room", {{"InitP", json::object()}, {"SVD", nullptr}}).rows, IsEmpty());
}

TEST(MistakesTable, HasWhatIsMissedAndWhatIsFalse) {
  EXPECT_THAT(CellTexts(MistakesTable(Metrics(json::array()))),
              ElementsAre("missed cup 7 not detected 0 of 9", "false tv 2 background "));
  EXPECT_THAT(MistakesTable(json::object()).rows, IsEmpty());
}

}  // namespace
}  // namespace soslam
