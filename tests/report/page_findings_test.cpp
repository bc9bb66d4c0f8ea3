// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/page_html.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

json Finding(const std::string& severity, const std::string& found) {
  return {
      {"check", "camera_against_images"}, {"severity", severity},         {"found", found},
      {"expected", "640 x 480"},          {"cause", "<img onerror='x'>"}, {"remedy", "scale it"}};
}

class PageFindingsTest : public testing::Test {
 protected:
  void Write(const std::string& variant, const std::string& file, const json& findings) {
    const std::filesystem::path folder = folder_ / variant;
    if (std::filesystem::create_directories(folder)) {
      dataset_.variants.push_back({.name = variant, .folder = folder});
    }
    WriteBytes(folder / file, json{{"artefact", {}}, {"findings", findings}}.dump());
  }

  TemporaryFolder folder_;
  DatasetResult dataset_{"room", {}};
};

TEST_F(PageFindingsTest, EachIsThereOnceErrorsFirst) {
  const json warning = Finding("warning", "1280 x 960"), error = Finding("error", "no scale");
  for (const char* variant : {"InitP", "OursP"})
    Write(variant, "sequence.json", json::array({warning}));
  Write("OursP", "map.json", json::array({error}));
  const json findings = PageFindings(dataset_);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0]["found"], "no scale");
  EXPECT_EQ(findings[0]["where"], "map.json of OursP");
  EXPECT_EQ(findings[1]["where"], "sequence.json of all variants");
  EXPECT_EQ(findings[1]["remedy"], "scale it");
}

TEST_F(PageFindingsTest, WhatIsNoFindingIsNone) {
  Write("InitP", "sequence.json", json::array());
  WriteBytes(folder_ / "InitP/initial.json", "[1, 2]");
  WriteBytes(folder_ / "InitP/map.json", "{\"findings\": [");
  WriteBytes(folder_ / "InitP/planes.json", "{}");
  EXPECT_EQ(PageFindings(dataset_), json::array());
  EXPECT_EQ(FindingsHtml(json::array()), "");
}

TEST_F(PageFindingsTest, TextsAreEscaped) {
  Write("<Init>", "sequence.json", json::array({Finding("error\" onclick=\"x", "</li><script>")}));
  const std::string html = FindingsHtml(PageFindings(dataset_));
  EXPECT_THAT(html, AllOf(HasSubstr("&lt;/li&gt;&lt;script&gt;"), HasSubstr("640 x 480"),
                          HasSubstr("&lt;img onerror=&#39;x&#39;&gt;"), HasSubstr("scale it"),
                          HasSubstr("camera_against_images")));
  EXPECT_THAT(html, AllOf(Not(HasSubstr("<script>")), Not(HasSubstr("\" onclick"))));
}

}  // namespace
}  // namespace soslam
