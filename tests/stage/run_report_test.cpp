// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "soslam/base/error.h"
#include "soslam/stage/stages.h"
#include "support/expect_error.h"
#include "support/printed.h"
#include "support/results_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class RunReportTest : public testing::Test {
 protected:
  void Write(const std::string& dataset, const std::string& variant) const {
    results_.WriteMetrics(dataset, variant,
                          {{.id = 1, .iou = 0.5, .rotation_deg = 1.0, .observations = 247}});
  }
  fs::path File(const std::string& name) const { return results_.path() / name; }
  // The report; what is printed is the same as what is written.
  std::string Report() {
    const std::string printed = PrintedBy([&] { RunReport({}, files_, 1); }).output;
    EXPECT_EQ(printed, FileBytes(File("tables.md")));
    return printed;
  }

  ResultsFolder results_;
  StageFiles files_ = {{"results", results_.path()}, {"output", File("tables.md")}};
};

TEST_F(RunReportTest, DanglingLinkCountsAsMissing) {
  Write("room", "SVD");
  fs::create_symlink("../shared/none/metrics.json",
                     results_.VariantFolder("room", "InitP") / "metrics.json");
  EXPECT_THAT(Report(), testing::ContainsRegex("\\| InitP +\\| +- \\|"));
}

TEST_F(RunReportTest, EachTableIsAFileForProgramsAndForLatex) {
  Write("fr3_cabinet", "OursP");
  files_["published"] = SOSLAM_SOURCE_DIR "/pipelines/published.json";
  Report();
  EXPECT_THAT(FileBytes(File("tables/table_3_map_iou.csv")),
              HasSubstr("fr3_cabinet,measured,f,1,247,-,0.500,-,-,-,-,-,-\n"
                        "fr3_cabinet,published,-,1,-,0.255,0.316,0.317,-,-,-,-,-\n"));
  EXPECT_THAT(FileBytes(File("tables/dataset_fr3_cabinet.csv")), HasSubstr("\nOursP,1,247,0.500,"));
  EXPECT_THAT(FileBytes(File("tables/table_3_map_iou.tex")), HasSubstr("\\textbf{0.500}"));
}

TEST_F(RunReportTest, APageGetsItsTables) {
  Write("room", "OursP");
  files_["page"] = File("page.md");
  ExpectError<InputError>([&] { Report(); }, {"page.md"});
  WriteBytes(files_["page"], "Prose.\n\n<!-- table: dataset_room -->\n<!-- end -->\n");
  Report();
  EXPECT_THAT(FileBytes(files_["page"]),
              HasSubstr("Prose.\n\n<!-- table: dataset_room -->\n\n### "));
}

TEST_F(RunReportTest, NoMetricsIsNothingUsable) {
  EXPECT_THROW(Report(), NothingUsableError);
  EXPECT_FALSE(fs::exists(File("tables.md")));
  fs::remove_all(results_.path());
  EXPECT_THROW(Report(), NothingUsableError);
}

}  // namespace
}  // namespace soslam
