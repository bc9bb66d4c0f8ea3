// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace soslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(UrlOf, IsTheSameBytes) {
  EXPECT_EQ(UrlOf("room_a-2"), "room_a-2");
  EXPECT_EQ(UrlOf("a b%.\xe9"), "a%20b%25%2E%E9");
}

TEST(Utf8, ReplacesWhatIsNone) {
  EXPECT_EQ(Utf8("caf\xc3\xa9"), "caf\xc3\xa9");
  EXPECT_EQ(Utf8("caf\xe9!"), "caf\xef\xbf\xbd!");
}

TEST(HtmlText, IsTextWithinElementsAndQuotes) {
  EXPECT_EQ(HtmlText("<b a='1' c=\"2\"> & \xe9"),
            "&lt;b a=&#39;1&#39; c=&quot;2&quot;&gt; &amp; \xef\xbf\xbd");
}

TEST(HtmlTable, HasRowsWithTheirIndices) {
  Table table;
  table.name = "metrics";
  table.header = {"<a>", "b"};
  table.rows = {{"x", {"1.00", true}}, {"&", "2.00"}};
  EXPECT_EQ(HtmlTable(table, {7, 3}),
            "<div class=\"scroll metrics\"><table>\n"
            "<thead><tr><th>&lt;a&gt;</th><th>b</th></tr></thead>\n<tbody>\n"
            "<tr data-index=\"7\"><td>x</td><td class=\"best\">1.00</td></tr>\n"
            "<tr data-index=\"3\"><td>&amp;</td><td>2.00</td></tr>\n"
            "</tbody>\n</table></div>\n");
}

TEST(PageHtml, EndsNoElementBecauseOfWhatItShows) {
  const std::string html = PageHtml("</title> & \xff", "<p>shown</p>",
                                    {{"label", "</script><script>alert(1)"}}, PageScripts::kNone);
  EXPECT_THAT(html, HasSubstr("<title>&lt;/title&gt; &amp; \xef\xbf\xbd"));
  EXPECT_THAT(html, HasSubstr("<p>shown</p>"));
  EXPECT_THAT(html, Not(HasSubstr("alert(1)</script>")));
  EXPECT_THAT(html, Not(HasSubstr("<script>")));
  EXPECT_THAT(html, HasSubstr("\\u003c/script>"));
}

TEST(PageHtml, FillsNothingIntoWhatItShows) {
  const std::string html =
      PageHtml("{{data}}", "{{style}}", {{"label", "{{scripts}}"}}, PageScripts::kNone);
  EXPECT_THAT(html, AllOf(HasSubstr("<title>{{data}}"), HasSubstr("\n{{style}}</main>"),
                          HasSubstr("{\"label\":\"{{scripts}}\"}")));
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

}  // namespace
}  // namespace soslam
