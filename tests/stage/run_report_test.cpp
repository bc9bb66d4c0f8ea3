// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "artefact/json_file.h"
#include "base/error.h"
#include "stage/stages.h"
#include "support/expect_error.h"
#include "support/printed.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class RunReportTest : public testing::Test {
 protected:
  void Write(const std::string& dataset, const std::string& variant, const std::string& text) {
    fs::create_directories(results_.path() / dataset / variant);
    nlohmann::json body = {{"dataset", dataset}, {"objects", nlohmann::json::array()}};
    body.update(nlohmann::json::parse(text));
    for (int id = 1; id <= body["summary"]["objects"]; ++id) {
      body["objects"].push_back({{"object", id},
                                 {"label", "box"},
                                 {"observations", 30},
                                 {"estimates", 30},
                                 {"iou", 0.5},
                                 {"centre_m", 0.1},
                                 {"rotation_deg", 1.0},
                                 {"yaw_error_deg", 2.0}});
    }
    WriteArtefact(results_.path() / dataset / variant / "metrics.json", "metrics", {}, body);
  }
  // The report; what is printed is the same as what is written.
  std::string Report() {
    const std::string printed = PrintedBy([&] { RunReport({}, files_, 1); }).output;
    EXPECT_EQ(printed, FileBytes(results_ / "tables.md"));
    return printed;
  }
  // What the report says of single datasets comes last.
  static std::string DatasetTables(const std::string& report) {
    return report.substr(report.find("\n| variant "));
  }
  static std::vector<std::string> Cells(const std::string& report, const std::string& variant) {
    std::istringstream lines(DatasetTables(report));
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("| " + variant + " ", 0) != 0) continue;
      std::vector<std::string> cells;
      std::istringstream words(line);
      for (std::string word; words >> word;) {
        if (word != "|") cells.push_back(word);
      }
      return cells;
    }
    return {};
  }
  TemporaryFolder results_;
  StageFiles files_ = {{"results", results_.path()}, {"output", results_ / "tables.md"}};
};

constexpr const char* kSingleFrame = R"({
  "summary": {"objects": 8, "observations": 247, "iou_mean": 0.34678, "iou_median": 0.3,
              "rotation_deg_mean": 7.1016, "rotation_deg_median": 6, "yaw_error_deg_mean": 22.874,
              "yaw_error_deg_median": 20},
  "first_observation": {"objects": 8, "observations": 8, "iou_mean": 0.4053, "iou_median": 0.4,
              "rotation_deg_mean": null, "rotation_deg_median": null, "yaw_error_deg_mean": null,
              "yaw_error_deg_median": null},
  "trajectory": null})";
constexpr const char* kMap = R"({
  "summary": {"objects": 8, "observations": 247, "iou_mean": 0.5, "iou_median": 0.5,
              "rotation_deg_mean": 1, "rotation_deg_median": 1, "yaw_error_deg_mean": 2,
              "yaw_error_deg_median": 2},
  "first_observation": null,
  "trajectory": {"ate_rmse_m": 0.01234, "odometry_ate_rmse_m": 0.05678}})";

TEST_F(RunReportTest, RowsHoldTheNumbersOfTheMetrics) {
  Write("room", "InitP", kSingleFrame);
  Write("room", "OursP", kMap);
  const std::string report = Report();
  EXPECT_THAT(Cells(report, "InitP"),
              ElementsAre("InitP", "8", "247", "0.347", "0.405", "7.10", "-", "22.87", "-"));
  EXPECT_THAT(Cells(report, "OursP"),
              ElementsAre("OursP", "8", "247", "0.500", "-", "1.00", "-", "2.00", "0.0123"));
  EXPECT_THAT(Cells(report, "Quadric"),
              ElementsAre("Quadric", "-", "-", "-", "-", "-", "-", "-", "-"));
  EXPECT_THAT(report, HasSubstr("ATE of the odometry alone: 0.0568 m"));
}

TEST_F(RunReportTest, DanglingLinkCountsAsMissing) {
  Write("room", "SVD", kMap);
  fs::create_directories(results_.path() / "room" / "InitP");
  fs::create_symlink("../shared/none/metrics.json",
                     results_.path() / "room" / "InitP" / "metrics.json");
  EXPECT_EQ(Cells(Report(), "InitP")[3], "-");
}

TEST_F(RunReportTest, TablesOfThePaperAndDifferencesComeBeforeThoseOfDatasets) {
  for (const char* variant : {"OursS", "OursST"}) Write("room", variant, kMap);
  const std::string report = Report();
  EXPECT_LT(report.find("## Map, IoU (Table III)"),
            report.find("## Map, Rot (degrees) (Table IV)"));
  EXPECT_LT(report.find("(Table IV)"), report.find("## room"));
  EXPECT_THAT(report, Not(HasSubstr("(Table I)")));
}

TEST_F(RunReportTest, EachTableIsAFileForProgramsAndForLatex) {
  Write("room", "OursS", kMap);
  Report();
  EXPECT_THAT(FileBytes(results_ / "tables/table_3_map_iou.csv"),
              HasSubstr("\nroom,measured,-,8,247,-,-,-,0.500,-,-,-,-\n"));
  EXPECT_THAT(FileBytes(results_ / "tables/dataset_room.csv"), HasSubstr("\nOursS,8,247,0.500,"));
  EXPECT_THAT(FileBytes(results_ / "tables/table_3_map_iou.tex"), HasSubstr("\\textbf{0.500}"));
}

TEST_F(RunReportTest, PublishedValuesAreThoseOfTheFile) {
  Write("fr3_cabinet", "OursP", kMap);
  files_["published"] = SOSLAM_SOURCE_DIR "/pipelines/published.json";
  Report();
  EXPECT_THAT(FileBytes(results_ / "tables/table_3_map_iou.csv"),
              HasSubstr("fr3_cabinet,measured,-,8,247,-,0.500,-,-,-,-,-,-\n"
                        "fr3_cabinet,published,-,1,-,0.255,0.316,0.317,-,-,-,-,-\n"));
}

TEST_F(RunReportTest, SettingsOfADatasetShowInTables) {
  Write("room", "OursP", kMap);
  fs::create_directories(results_ / "settings");
  WriteBytes(results_ / "settings/room.json",
             R"({"about": {"published": "fr3_cabinet", "boxes": "a network"}})");
  files_["published"] = SOSLAM_SOURCE_DIR "/pipelines/published.json";
  files_["datasets"] = results_ / "settings";
  EXPECT_THAT(Report(), HasSubstr("room (boxes: a network).\n"));
}

TEST_F(RunReportTest, APageGetsItsTables) {
  Write("room", "OursP", kMap);
  files_["page"] = results_ / "page.md";
  ExpectError<InputError>([&] { Report(); }, {"page.md"});
  WriteBytes(files_["page"], "Prose.\n\n<!-- table: dataset_room -->\n<!-- end -->\n");
  Report();
  EXPECT_THAT(FileBytes(files_["page"]),
              HasSubstr("Prose.\n\n<!-- table: dataset_room -->\n\n### "));
}

TEST_F(RunReportTest, NoMetricsIsNothingUsable) {
  EXPECT_THROW(Report(), NothingUsableError);
  EXPECT_FALSE(fs::exists(results_ / "tables.md"));
  fs::remove_all(results_.path());
  EXPECT_THROW(Report(), NothingUsableError);
}

}  // namespace
}  // namespace soslam
