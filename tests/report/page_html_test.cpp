// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/report/page_html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/described_json.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(EncodeUrl, IsTheSameBytes) {
  EXPECT_EQ(EncodeUrl("room_a-2"), "room_a-2");
  EXPECT_EQ(EncodeUrl("a b%.\xe9"), "a%20b%25%2E%E9");
}

TEST(HtmlText, IsTextWithinElementsAndQuotes) {
  EXPECT_EQ(HtmlText("<b a='1' c=\"2\"> & \xe9"),
            "&lt;b a=&#39;1&#39; c=&quot;2&quot;&gt; &amp; \xef\xbf\xbd");
}

TEST(PageHtml, CarriesTheLicencesOfTheScriptsInIt) {
  const std::string html = PageHtml("room", "", {}, PageScripts::kDataset);
  const size_t footer = html.find("<footer>");
  ASSERT_NE(footer, std::string::npos);
  EXPECT_LT(footer, html.find("THREE="));
  for (const char* words :
       {"2010-2019 three.js authors", "2014-2022 Chart.js Contributors", "2018-2021 Jukka Kurkela",
        "The above copyright notice and this permission notice shall be included", "Chart.js v3"}) {
    EXPECT_THAT(html, HasSubstr(words));
  }
  EXPECT_THAT(PageHtml("all", "", {}, PageScripts::kNone), Not(HasSubstr("three.js")));
}

using nlohmann::json;

Finding FindingAs(Severity severity, const std::string& found) {
  return {"camera_against_images", severity, found, "640 x 480", "<img onerror='x'>", "scale it"};
}

class PageFindingsTest : public testing::Test {
 protected:
  void Write(const std::string& variant, const std::string& file,
             const std::vector<Finding>& findings) {
    const std::filesystem::path folder = folder_ / variant;
    if (std::filesystem::create_directories(folder)) {
      dataset_.variants.push_back({.name = variant, .folder = folder});
    }
    WriteBytes(folder / file,
               json{{"artefact", {}}, {"findings", DescribedToJson(findings)}}.dump());
  }

  TemporaryFolder folder_;
  DatasetResult dataset_{"room", {}};
};

TEST_F(PageFindingsTest, EachIsThereOnceErrorsFirst) {
  const Finding warning = FindingAs(Severity::kWarning, "1280 x 960");
  for (const char* variant : {"InitP", "OursP"}) Write(variant, "sequence.json", {warning});
  Write("OursP", "map.json", {FindingAs(Severity::kError, "no scale")});
  const std::vector<PageFinding> findings = PageFindings(dataset_);
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].finding.found, "no scale");
  EXPECT_EQ(findings[0].where, "map.json of OursP");
  EXPECT_EQ(findings[1].where, "sequence.json of all variants");
  EXPECT_EQ(findings[1].finding, warning);
}

TEST_F(PageFindingsTest, WhatIsNoFindingIsNone) {
  Write("InitP", "sequence.json", {});
  WriteBytes(folder_ / "InitP/initial.json", "[1, 2]");
  WriteBytes(folder_ / "InitP/map.json", "{\"findings\": [");
  WriteBytes(folder_ / "InitP/planes.json", "{}");
  EXPECT_TRUE(PageFindings(dataset_).empty());
  EXPECT_EQ(FindingsHtml({}), "");
}

TEST_F(PageFindingsTest, DamagedFindingsAreNamed) {
  Write("InitP", "planes.json", {});
  WriteBytes(folder_ / "InitP/planes.json", R"({"findings": [{"check": "up"}]})");
  const std::vector<PageFinding> findings = PageFindings(dataset_);
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_THAT(findings[0].finding.found, HasSubstr("severity"));
  EXPECT_EQ(findings[0].where, "planes.json of all variants");
}

TEST_F(PageFindingsTest, TextsAreEscaped) {
  Write("<Init>", "sequence.json", {FindingAs(Severity::kError, "\" onclick=\"x</li><script>")});
  const std::string html = FindingsHtml(PageFindings(dataset_));
  EXPECT_THAT(html, AllOf(HasSubstr("&lt;/li&gt;&lt;script&gt;"), HasSubstr("640 x 480"),
                          HasSubstr("&lt;img onerror=&#39;x&#39;&gt;"), HasSubstr("scale it"),
                          HasSubstr("camera_against_images")));
  EXPECT_THAT(html, AllOf(Not(HasSubstr("<script>")), Not(HasSubstr("\" onclick"))));
}

}  // namespace
}  // namespace soslam
