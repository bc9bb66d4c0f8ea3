// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/report/page.h"
#include "soslam/report/page_parts.h"

namespace soslam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

PageVariant VariantOf(const std::string& name, VariantKind kind, double iou) {
  PageVariant variant = {name, {}, kind};
  variant.metrics.summary.objects = 2;
  variant.metrics.summary.observations = 9;
  variant.metrics.summary.iou_mean = iou;
  variant.metrics.objects = {{5, 4, 4, 0.75, {}, {}, {}}, {6, 5, 5, 0.25, {}, 3.0, {}}};
  variant.objects = {{0, 4, Landmark(), {}, ""}, {1, 5, {}, {}, "too_few_views"}};
  return variant;
}

DatasetPage Page() {
  DatasetPage page;
  page.name = "a & b";
  Sequence sequence;
  sequence.frames.resize(2);
  sequence.objects = {{5, "chair", 0, {}}, {6, "<cup>", 0, {}}};
  sequence.detections.resize(1);
  sequence.rejected_detections = {{"near_border", 3}};
  page.sequences.push_back({sequence, {{0, 1}, {0}, {}}, {}});
  page.unfinished = {{"SVD", "failed: <x>", false}};
  page.notes = {"a note"};
  page.has_true_objects = page.has_true_poses = true;
  page.variants = {VariantOf("InitP", VariantKind::kFrames, 0.4),
                   VariantOf("OursP", VariantKind::kMap, 0.5004),
                   VariantOf("OursS", VariantKind::kMap, 0.5)};
  page.variants[1].metrics.trajectory = {0.0123, 0.0};
  SolverSummary& solver = page.variants[1].solver.emplace();
  solver.iterations = 12;
  solver.converged = true;
  solver.residuals = {{"detection", 40}};
  solver.gated = {{"behind_camera", 2}};
  return page;
}

TEST(DatasetTables, HaveTheNumbersOfAllVariantsTheBestBold) {
  const std::string html = DatasetTables(Page());
  EXPECT_THAT(html, AllOf(HasSubstr("<h1>a &amp; b</h1>"),
                          HasSubstr("2 frames, 2 objects, 1 detection used; "
                                    "1 frames are shown; not used: 3 too near the image border")));
  // Both read the same; of single frames there is no trajectory.
  EXPECT_THAT(html, HasSubstr("<td>OursP</td><td>2</td><td>9</td><td class=\"best\">0.500</td><td "
                              "class=\"best\">0.0123</td>"));
  EXPECT_THAT(
      html, HasSubstr("<td>OursS</td><td>2</td><td>9</td><td class=\"best\">0.500</td><td>–</td>"));
  EXPECT_THAT(html,
              HasSubstr("<td>InitP</td><td>2</td><td>9</td><td class=\"best\">0.400</td></tr>"));
}

TEST(DatasetTables, CountTheDetectionsOfTheVariantThatIsShownFirst) {
  DatasetPage page = Page();
  page.sequences.push_back(page.sequences[0]);
  page.sequences[1].sequence.detections.resize(7);
  page.variants[2].sequence = 1;
  EXPECT_EQ(CountsOfDataset(page), "2 frames, 2 objects, 7 detections used by OursS (by others 1)");
  EXPECT_THAT(DatasetTables(page), HasSubstr("7 detections used by OursS (by others 1); 1 frames"));
  EXPECT_EQ(OverviewData({page})["datasets"][0]["counts"], CountsOfDataset(page));
}

// Findings may be of other variants than the map above them; notes are no findings.
TEST(DatasetTables, FindingsHaveTheirPlaceAndNotesAreBelowAll) {
  DatasetPage page = Page();
  page.map_section = "<h2>Map of OursS</h2>";
  page.findings = {{{"degenerate", Severity::kWarning, "thin", "thick", "views", "more"},
                    "map.json of Quadric"}};
  page.notes = {"For lack of room images are small."};
  const std::string html = DatasetTables(page);
  EXPECT_THAT(html, HasSubstr("1 finding</a> below, in map.json of Quadric<"));
  EXPECT_GT(html.find("For lack of room"), html.rfind("</section>"));
}

TEST(DatasetTables, HaveTheObjectsOfEachVariantWorstFirst) {
  const std::string html = DatasetTables(Page());
  EXPECT_THAT(html, HasSubstr("<details open><summary>OursS</summary>"));
  EXPECT_THAT(html, HasSubstr("<tr data-index=\"1\"><td>&lt;cup&gt; 6</td><td>5</td><td>0.250</td>"
                              "<td>3.00</td><td>too few views</td></tr>\n"
                              "<tr data-index=\"0\"><td>chair 5</td><td>4</td><td>0.750</td>"));
  EXPECT_THAT(html, Not(HasSubstr("<cup>")));
}

// The backend's own summary, and what an ablation without a value for some metric shows.
TEST(DatasetTables, HaveStagesAndDifferences) {
  DatasetPage page = Page();
  page.differences = {
      {{"OursS", "OursP"},
       3,
       {PairedDifference{0.25, Interval{0.125, 0.375}}, PairedDifference{-1.5, {}}, std::nullopt}}};
  EXPECT_THAT(DatasetTables(page),
              AllOf(HasSubstr("<td>OursP</td><td>1</td><td>1 too few views</td><td>12</td>"
                              "<td>yes</td><td>40 detection</td><td>2 behind camera</td>"),
                    HasSubstr("<td>OursS – OursP</td><td>3</td><td class=\"best\">+0.250 (+0.125 "
                              "to +0.375)</td><td>-1.50</td><td>–</td>")));
}

TEST(DatasetTables, ObjectsWithoutTruthHaveNoErrorsAndComeLast) {
  DatasetPage page = Page();
  page.variants[2].metrics.objects.erase(page.variants[2].metrics.objects.begin());
  EXPECT_THAT(DatasetTables(page),
              HasSubstr("<tr data-index=\"0\"><td>chair 5</td><td>4</td><td>–</td><td>–</td>"
                        "<td></td></tr>\n</tbody>"));
}

TEST(DatasetTables, FrontsAreShownWhereThereAreSome) {
  DatasetPage page = Page();
  EXPECT_THAT(DatasetTables(page), Not(HasSubstr("front error")));
  page.variants[2].metrics.summary.fronts = {1, 170.0, 170.0, 0.0, 1, 1};
  page.variants[2].metrics.objects[0].front = {170.0, true};
  page.variants[2].objects[0].front_probability = 0.95;
  const std::string html = DatasetTables(page);
  EXPECT_THAT(html, HasSubstr("<th>front error, °</th><th>median front error, °</th>"));
  EXPECT_THAT(html, HasSubstr("<td>170.00</td><td>0.95</td>"));
}

TEST(DetailedVariants, AreThoseWithMostToShowFirst) {
  DatasetPage page = Page();
  EXPECT_EQ(DetailedVariants(page), (std::vector<size_t>{2, 1, 0}));
  PageVariant more = page.variants[2];
  more.name += "A";
  page.variants.push_back(more);
  EXPECT_EQ(DetailedVariants(page), (std::vector<size_t>{3, 2, 1, 0}));
  page.variants.back().name = page.variants[2].name + "-true-ratio";
  EXPECT_EQ(DetailedVariants(page).front(), 2U);
  page.variants.pop_back();
  page.variants[2].numbers_only = true;
  EXPECT_EQ(DetailedVariants(page), (std::vector<size_t>{1, 0}));
}

}  // namespace
}  // namespace soslam
