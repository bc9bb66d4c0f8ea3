// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_html.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace soslam {
namespace {

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

TEST(PageHtml, EndsNoElementBecauseOfWhatItShows) {
  const std::string html =
      PageHtml("</title> & \xff", "showDataset", {{"label", "</script><script>alert(1)"}});
  EXPECT_THAT(html, HasSubstr("<title>&lt;/title> &amp; \xef\xbf\xbd"));
  EXPECT_THAT(html, Not(HasSubstr("alert(1)</script>")));
  EXPECT_THAT(html, Not(HasSubstr("<script>alert(1)")));
  EXPECT_THAT(html, HasSubstr("\\u003c/script>"));
}

}  // namespace
}  // namespace soslam
