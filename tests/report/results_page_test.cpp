// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"
#include "report/results_tree.h"
#include "report/tables.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const std::vector<Table> kTables = {
    {"prices", "Prices", {"thing", "price"}, {{"cup", "3"}}, 1, {}}};
const std::string kPage = "# Shop\n\nBefore.\n\n<!-- table: prices -->\n<!-- end -->\n\nAfter.\n";

TEST(ResultsPage, ProseStaysAroundATable) {
  const std::string page = FillPage(kPage, kTables, "shop.md");
  EXPECT_THAT(page, StartsWith("# Shop\n\nBefore.\n\n<!-- table: prices -->\n"));
  EXPECT_THAT(page, HasSubstr("\n#" + ToMarkdown(kTables[0]) + "\n<!-- end: "));
  EXPECT_TRUE(page.ends_with(" -->\n\nAfter.\n"));
  EXPECT_EQ(FillPage(page, kTables, "shop.md"), page);
}

TEST(ResultsPage, ATableFollowsTheResults) {
  std::vector<Table> dearer = kTables;
  dearer[0].rows = {{"cup", "4"}};
  const std::string page = FillPage(kPage, kTables, "shop.md");
  EXPECT_EQ(FillPage(page, dearer, "shop.md"), FillPage(kPage, dearer, "shop.md"));
}

TEST(ResultsPage, EditedTablesAreFound) {
  std::string page = FillPage(kPage, kTables, "shop.md");
  EXPECT_THAT(EditedTables(page, "shop.md"), IsEmpty());
  page.replace(page.find('3', page.find("cup")), 1, "2");
  EXPECT_THAT(EditedTables(page, "shop.md"), ElementsAre("prices"));
  EXPECT_THAT(EditedTables(kPage, "shop.md"), ElementsAre("prices"));
}

TEST(ResultsPage, RefusesUnknownTablesAndHalfMarkers) {
  const auto refuses = [](const std::string& page, const std::vector<std::string>& words) {
    ExpectError<InputError>([&] { FillPage(page, kTables, "shop.md"); }, words);
  };
  refuses("<!-- table: names -->\n<!-- end -->\n", {"shop.md", "'names'", "prices"});
  refuses("\n<!-- table: prices -->\n", {"shop.md:2", "prices", "<!-- end"});
  refuses("<!-- table: prices -->\n<!-- table: prices -->\n<!-- end -->\n", {"shop.md:1"});
  refuses("\n\n<!-- end -->\n", {"shop.md:3", "<!-- table:"});
}

TEST(ResultsPage, TablesOfTheDocumentationAreNotEditedByHand) {
  const std::filesystem::path page =
      std::filesystem::path(SOSLAM_SOURCE_DIR) / "docs" / "results.md";
  EXPECT_THAT(EditedTables(FileBytes(page), page.string()), IsEmpty())
      << "make results-page writes them";
}

TEST(ResultsPage, TheDocumentationHasAColumnForEachVariant) {
  const std::string page =
      FileBytes(std::filesystem::path(SOSLAM_SOURCE_DIR) / "docs" / "results.md");
  for (const std::string& variant : KnownVariants()) {
    EXPECT_THAT(page, testing::ContainsRegex("\\| +" + variant + " \\|"));
  }
}

}  // namespace
}  // namespace soslam
