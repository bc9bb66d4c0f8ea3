// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/page.h"
#include "report/page_parts.h"

namespace soslam {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

json MetricsOfPage(double iou, const json& ate) {
  return {{"summary", {{"objects", 2}, {"observations", 9}, {"iou_mean", iou}}},
          {"first_observation", nullptr},
          {"trajectory", {{"ate_rmse_m", ate}}},
          {"objects",
           {{{"object", 5}, {"observations", 4}, {"iou", 0.75}, {"rotation_deg", nullptr}},
            {{"object", 6}, {"observations", 5}, {"iou", 0.25}, {"rotation_deg", 3.0}}}}};
}

json Variant(const std::string& name, const std::string& kind, double iou, const json& ate) {
  const json objects = {{{"landmark", {1}}, {"failure", ""}, {"observations", 4}},
                        {{"landmark", nullptr}, {"failure", "too_few_views"}, {"observations", 5}}};
  return {{"name", name},
          {"kind", kind},
          {"numbers_only", false},
          {"sequence", 0},
          {"solver", nullptr},
          {"objects", objects},
          {"metrics", MetricsOfPage(iou, ate)}};
}

json Page() {
  const json objects = {{{"id", 5}, {"label", "chair"}}, {{"id", 6}, {"label", "<cup>"}}};
  const json sequence = {{"counts", {{"frames", 2}, {"objects", 2}, {"detections", 1}}},
                         {"frames", {{{"shown", true}}, {{"shown", false}}}},
                         {"objects", objects},
                         {"rejected", {{"near_border", 3}}}};
  json ours = Variant("OursP", "map", 0.5004, 0.0123);
  ours["solver"] = {{"iterations", 12},
                    {"converged", true},
                    {"residuals", {{"detection", 40}}},
                    {"gated", {{"behind_camera", 2}}}};
  return {
      {"dataset", "a & b"},
      {"url", "a%20b"},
      {"findings", json::array()},
      {"unfinished", {{{"name", "SVD"}, {"state", "failed: <x>"}, {"is_shown", false}}}},
      {"notes", {"a note"}},
      {"problems", json::array()},
      {"differences", json::array()},
      {"map_section", ""},
      {"has_true_objects", true},
      {"has_true_poses", true},
      {"sequences", {sequence}},
      {"variants",
       {Variant("InitP", "frames", 0.4, nullptr), ours, Variant("OursS", "map", 0.5, nullptr)}}};
}

TEST(DatasetTables, HaveTheNumbersOfAllVariantsTheBestBold) {
  const std::string html = DatasetTables(Page());
  EXPECT_THAT(html, AllOf(HasSubstr("<h1>a &amp; b</h1>"),
                          HasSubstr("2 frames, 2 objects, 1 detection used; "
                                    "1 frames are shown; not used: 3 near border")));
  // Both read the same; of single frames there is no trajectory.
  EXPECT_THAT(html, HasSubstr("<td>OursP</td><td>2</td><td>9</td><td class=\"best\">0.500</td><td "
                              "class=\"best\">0.0123</td>"));
  EXPECT_THAT(
      html, HasSubstr("<td>OursS</td><td>2</td><td>9</td><td class=\"best\">0.500</td><td>–</td>"));
  EXPECT_THAT(html,
              HasSubstr("<td>InitP</td><td>2</td><td>9</td><td class=\"best\">0.400</td></tr>"));
}

TEST(DatasetTables, CountTheDetectionsOfTheVariantThatIsShownFirst) {
  json page = Page();
  json others = page["sequences"][0];
  others["counts"]["detections"] = 7;
  page["sequences"].push_back(others);
  page["variants"][2]["sequence"] = 1;
  EXPECT_EQ(CountsOfDataset(page), "2 frames, 2 objects, 7 detections used by OursS (by others 1)");
  EXPECT_THAT(DatasetTables(page), HasSubstr("7 detections used by OursS (by others 1); 1 frames"));
  EXPECT_EQ(OverviewData({page})["datasets"][0]["counts"], CountsOfDataset(page));
}

// Findings may be of other variants than the map above them; notes are no findings.
TEST(DatasetTables, FindingsHaveTheirPlaceAndNotesAreBelowAll) {
  json page = Page();
  page["map_section"] = "<h2>Map of OursS</h2>";
  page["findings"] = {{{"severity", "warning"},
                       {"check", "degenerate"},
                       {"found", "thin"},
                       {"expected", "thick"},
                       {"cause", "views"},
                       {"remedy", "more"},
                       {"where", "map.json of Quadric"}}};
  page["notes"] = {"For lack of room images are small."};
  const std::string html = DatasetTables(page);
  EXPECT_THAT(html, HasSubstr("1 finding</a> below, in map.json of Quadric<"));
  EXPECT_GT(html.find("For lack of room"), html.rfind("</section>"));
}

TEST(DatasetTables, HaveTheObjectsOfEachVariantWorstFirst) {
  const std::string html = DatasetTables(Page());
  EXPECT_THAT(html, HasSubstr("<details open><summary>OursS</summary>"));
  EXPECT_THAT(
      html,
      HasSubstr("<tr data-index=\"1\"><td>&lt;cup&gt; 6</td><td>5</td><td>0.250</td><td>–</td>"
                "<td>3.00</td><td>–</td><td>–</td><td>too few views</td></tr>\n"
                "<tr data-index=\"0\"><td>chair 5</td><td>4</td><td>0.750</td>"));
  EXPECT_THAT(html, Not(HasSubstr("<cup>")));
}

TEST(DetailedVariants, AreThoseWithMostToShowFirst) {
  json page = Page();
  EXPECT_EQ(DetailedVariants(page), (std::vector<size_t>{2, 1, 0}));
  page["variants"][2]["numbers_only"] = true;
  EXPECT_EQ(DetailedVariants(page), (std::vector<size_t>{1, 0}));
}

}  // namespace
}  // namespace soslam
