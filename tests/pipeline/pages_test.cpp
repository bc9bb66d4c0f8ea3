// SPDX-License-Identifier: BSD-3-Clause
// Pages of a small run, as a browser shows them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "soslam/report/page_html.h"
#include "support/run_command.h"
#include "support/small_pipeline.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

bool HasBrowser() { return RunCommand({"which", "chromium"}).exit_code == 0; }

// What tests/support/page_check.js finds on a page in a browser without a screen; null when the
// browser did not come that far.
nlohmann::json CheckPage(const std::filesystem::path& page) {
  const TemporaryFolder folder;
  std::string html = FileBytes(page);
  const std::string watch =
      "<script>window.errorsOfPage = [];"
      "addEventListener(\"error\", (event) => errorsOfPage.push(event.message));"
      "console.error = console.warn = (...words) => errorsOfPage.push(words.join(\" \"));"
      "</script>\n<main";
  html.replace(html.find("<main"), 5, watch);
  const std::string check = FileBytes(SOSLAM_SOURCE_DIR "/tests/support/page_check.js");
  const std::string end = "</body>";
  html.insert(html.rfind(end), "<script>" + check + "</script>\n");
  WriteBytes(folder / "page.html", html);
  const CommandResult shown = RunCommand(
      {"timeout", "120", "chromium", "--headless", "--no-sandbox", "--use-angle=swiftshader",
       "--enable-unsafe-swiftshader", "--window-size=1280,900", "--virtual-time-budget=20000",
       "--user-data-dir=" + (folder / "profile").string(), "--dump-dom",
       "file://" + (folder / "page.html").string()});
  const size_t begin = shown.output.rfind("CHECK{");
  const size_t close = shown.output.rfind("}KCEHC");
  if (begin == std::string::npos || close == std::string::npos) return {};
  return nlohmann::json::parse(shown.output.substr(begin + 5, close + 1 - begin - 5));
}

class PagesTest : public testing::Test {
 protected:
  static constexpr int kFrames = 6;

  // The results with pages, which are made once for all tests.
  static std::filesystem::path Results() {
    static const SmallPipeline pipeline(kFrames);
    static const std::filesystem::path results = [] {
      ExpectSuccess(pipeline.Run("InitPT OursPT SVD"));
      ExpectSuccess(RunCommand(
          {StageProgram("pages"), "--results", (pipeline.Folder() / "results").string()}));
      return pipeline.Folder() / "results";
    }();
    return results;
  }
};

// With a browser.
using SlowPagesTest = PagesTest;

TEST_F(SlowPagesTest, ADatasetIsShownWithoutErrors) {
  const std::filesystem::path page = Results() / "small/report.html";
  EXPECT_LT(std::filesystem::file_size(page), kMaxPageBytes);
  if (!HasBrowser()) GTEST_SKIP() << "there is no chromium";
  const nlohmann::json found = CheckPage(page);
  ASSERT_FALSE(found.is_null());
  EXPECT_EQ(found.at("errors"), nlohmann::json::array());
  EXPECT_EQ(found.at("variants"), 3);
  EXPECT_EQ(found.at("broken_images"), 0);
  // The frame, an object's evidence, pairs of three objects, and the map's pictures of them.
  EXPECT_EQ(found.at("images"), 1 + kFrames + 3 + 3);
  // Yaw errors, convergence.
  EXPECT_EQ(found.at("charts"), 2);
  EXPECT_EQ(found.at("canvases"), 2);
  EXPECT_EQ(found.at("charts_after_use"), 2);
  EXPECT_GE(found.at("strips"), 3);
  EXPECT_EQ(found.at("rows"), 3);
  EXPECT_GT(found.at("drawn_pixels"), 10000);
  EXPECT_EQ(found.at("last_frame"), "frame 5");
  EXPECT_THAT(found.at("picked").get<std::string>(),
              testing::AllOf(testing::ContainsRegex("chest|stool|armchair"),
                             testing::HasSubstr("sigma of yaw"), testing::HasSubstr("IoU")));
}

TEST_F(SlowPagesTest, MapAndChartsAreUsedByKeyboard) {
  if (!HasBrowser()) GTEST_SKIP() << "there is no chromium";
  const nlohmann::json found = CheckPage(Results() / "small/report.html");
  ASSERT_FALSE(found.is_null());
  const nlohmann::json& keys = found.at("keys");
  EXPECT_EQ(keys.at("changed"), nlohmann::json({"ArrowLeft", "ArrowUp", "+", "-", "0"}));
  EXPECT_NE(keys.at("names")[0], keys.at("names")[1]);
  EXPECT_EQ(keys.at("names")[0], keys.at("names")[2]);
  EXPECT_EQ(keys.at("focusable"), true);
  EXPECT_THAT(keys.at("said").get<std::string>(), testing::StartsWith("OursPT: 2.00, "));
}

TEST_F(SlowPagesTest, TheOverviewLeadsToTheDataset) {
  const std::string page = FileBytes(Results() / "report.html");
  EXPECT_THAT(page, testing::HasSubstr("\"dataset\":\"small\""));
  if (!HasBrowser()) GTEST_SKIP() << "there is no chromium";
  const nlohmann::json found = CheckPage(Results() / "report.html");
  ASSERT_FALSE(found.is_null());
  EXPECT_EQ(found.at("errors"), nlohmann::json::array());
}

TEST_F(PagesTest, NeedNothingFromElsewhere) {
  for (const char* name : {"report.html", "small/report.html"}) {
    const std::string page = FileBytes(Results() / name);
    EXPECT_THAT(page, testing::Not(testing::ContainsRegex("src=\"|<link rel=\"stylesheet")))
        << name;
  }
}

TEST_F(PagesTest, HaveTheSameBytesAgain) {
  const std::filesystem::path page = Results() / "small/report.html";
  const std::string before = FileBytes(page);
  ExpectSuccess(
      RunCommand({StageProgram("pages"), "--results", Results().string(), "--threads", "1"}));
  EXPECT_EQ(FileBytes(page), before);
}

}  // namespace
}  // namespace soslam
