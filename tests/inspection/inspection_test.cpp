// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/inspection.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "soslam/appearance/appearance_file.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "soslam/geometry/angles.h"
#include "soslam/inspection/doubts.h"
#include "soslam/model/describe_estimates.h"
#include "support/expect_error.h"
#include "support/head_file.h"
#include "support/random.h"
#include "support/random_estimates.h"
#include "support/temporary_folder.h"

namespace soslam {
// Every kind of artefact as a person reads it, and what is none.
namespace {

using testing::HasSubstr;

class InspectionTest : public testing::Test {
 protected:
  std::filesystem::path File() const { return folder_ / "artefact"; }
  Inspection Read(const std::optional<Sequence>& sequence = std::nullopt) const {
    return Inspect(File(), sequence);
  }
  // What is said under a name.
  static std::string Said(const Inspection& inspection, const std::string& name) {
    const auto found = std::ranges::find(inspection.facts, name, &Fact::name);
    return found == inspection.facts.end() ? "" : found->text;
  }
  static Value At(const Inspection& inspection, const std::string& name, size_t row,
                  const std::string& column) {
    const ValueTable& table = FindTable(inspection, name);
    const auto found = std::ranges::find(table.columns, column, &ValueColumn::name);
    if (found == table.columns.end()) throw std::out_of_range(column);
    return table.rows.at(row).at(found - table.columns.begin());
  }
  // Expects these values in a row, by column.
  static void ExpectRow(const Inspection& inspection, const std::string& table, size_t row,
                        const std::vector<std::pair<std::string, Value>>& values) {
    for (const auto& [column, value] : values) {
      EXPECT_EQ(At(inspection, table, row, column), value) << column << " of row " << row;
    }
  }

  Sequence sequence_ = RandomSequence();

 private:
  TemporaryFolder folder_;
};

TEST_F(InspectionTest, FieldsOfADescriptionAreFactsAndListsOfRecordsTables) {
  WriteSequence(File(), sequence_, {});
  const Inspection inspection = Read();
  EXPECT_THAT(inspection.title, HasSubstr("sequence"));
  EXPECT_EQ(Said(inspection, "name"), sequence_.name);
  EXPECT_EQ(Said(inspection, "rejected_detections"), "duplicate 2, near_border 17");
  EXPECT_EQ(Said(inspection, "camera/width"), std::to_string(sequence_.camera.width));
  EXPECT_EQ(FindTable(inspection, "frames").rows.size(), 5u);
  EXPECT_EQ(FindTable(inspection, "detections").rows.size(), 10u);
  ExpectRow(inspection, "objects", 1, {{"object", 4}, {"plane", 3}, {"is_static", true}});
  const std::string text = FormatInspection(inspection, false);
  EXPECT_THAT(text, HasSubstr("\n  camera\n    width"));
  EXPECT_THAT(text, HasSubstr("frames, 5 rows: images that are used, by ascending id\n"));
  ExpectError<SettingsError>([&] { FindTable(inspection, "sheep"); }, {"sheep", "frames, planes"});
}

// A record of a kind of its own, with all that descriptions have.
struct Inner {
  int id = 0;
  std::vector<double> weights;
};
template <typename Visitor>
void Describe(Visitor& visit, Inner& inner) {
  visit.Field("id", &inner.id, "number");
  visit.Field("weights", &inner.weights, "kilograms");
}
struct Outer {
  std::optional<double> missing;
  double share = 0.0;
  Inner part;
  std::vector<Inner> parts;
  std::map<std::string, Inner> by_name;
  struct Row {
    std::string name;
    std::vector<Inner> parts;
  };
  std::vector<Row> rows;
};
template <typename Visitor>
void Describe(Visitor& visit, Outer::Row& row) {
  visit.Field("name", &row.name, "text");
  visit.Field("parts", &row.parts, "best first");
}
template <typename Visitor>
void Describe(Visitor& visit, Outer& outer) {
  visit.Field("missing", &outer.missing, "nothing");
  visit.Field("share", &outer.share, "of all");
  visit.Field("part", &outer.part, "one");
  visit.Field("parts", &outer.parts, "more");
  visit.Field("by_name", &outer.by_name, "named ones");
  visit.Field("rows", &outer.rows, "with parts");
}

TEST(InspectContents, FollowTheDescription) {
  Outer outer;
  outer.share = 0.12345;
  outer.part = {7, {1.5, 2.25}};
  outer.parts = {{1, {}}, {2, {1, 2, 3, 4, 5, 6, 7, 8}}};
  outer.by_name = {{"a", {3, {}}}};
  outer.rows = {{"x", outer.parts}, {"y", {}}};
  const Inspection contents = InspectContents(SchemaWriter::Of<Outer>(), DescribedToJson(outer));
  std::vector<std::string> facts;
  for (const Fact& fact : contents.facts)
    facts.push_back(fact.name + ": " + fact.text + ", " + fact.doc);
  EXPECT_THAT(facts,
              testing::ElementsAre("missing: -, nothing", "share: 0.123, of all",
                                   "part/id: 7, number", "part/weights: 1.500, 2.250, kilograms"));
  const auto text = [&](const char* name) { return FormatTable(FindTable(contents, name), false); };
  EXPECT_EQ(text("parts"),
            "id                                              weights\n"
            " 1                                                 none\n"
            " 2  1.000, 2.000, 3.000, 4.000, 5.000, 6.000 and 2 more\n");
  EXPECT_EQ(text("by_name"), "name  id  weights\na      3     none\n");
  EXPECT_EQ(text("rows"),
            "             parts/   parts/\n"
            "                 0/       0/\n"
            "name  parts      id  weights\n"
            "x         2       1     none\n"
            "y      none       -        -\n");
  EXPECT_THAT(
      FormatWholeTable(FindTable(contents, "rows"), false),
      testing::AllOf(testing::StartsWith("\nrows, 2 rows: with parts\n"), HasSubstr("best first")));
}

TEST_F(InspectionTest, ObjectsOfEstimatesHaveLabelsYawsAndStandardDeviations) {
  const LandmarkEstimates estimates = RandomLandmarkEstimates();
  WriteLandmarks(File(), estimates, sequence_, {});
  const Inspection inspection = Read(sequence_);
  EXPECT_EQ(Said(inspection, "failures"), "plane_behind_camera 1, too_few_views 1");
  const Landmark& best = estimates.observations[0].hypotheses[0].landmark_in_camera;
  const Eigen::Quaterniond& rotation = best.frame_from_object.rotation;
  ExpectRow(inspection, "observations", 0,
            {{"hypotheses", DescribedToJson(estimates.observations[0].hypotheses)},
             {"hypotheses/0/landmark/half_axes", DescribedToJson(best.half_axes)},
             {"yaw_deg", kDegPerRad * Yaw(rotation * Eigen::Vector3d::UnitZ(), rotation)}});
  ExpectRow(
      inspection, "observations", 1,
      {{"failure", "plane_behind_camera"}, {"hypotheses/0/cost", nullptr}, {"yaw_deg", nullptr}});
  ExpectRow(inspection, "objects", 0, {{"label", "label"}});
  ExpectRow(inspection, "objects", 1, {{"proper_ellipsoid", false}});
  EXPECT_THROW(At(Read(), "objects", 0, "label"), std::out_of_range)
      << "nobody knows it without the sequence";
}

// Yaw, standard deviations and their units of a landmark that stands upright.
TEST_F(InspectionTest, MapsSayHowSureTheyAre) {
  MapEstimate map = RandomMap();
  Landmark upright;
  upright.frame_from_object.rotation = UprightRotation(Eigen::Vector3d::UnitZ(), 0.5);
  Covariance9 covariance = Covariance9::Zero();
  covariance.diagonal() << 9, 9, 4e-4, 1e-2, 1e-2, 2e-2, 1e-2, 4e-2, 4e-2;
  map.objects[0].landmark_in_world = upright;
  map.objects[0].covariance = covariance;
  WriteMap(File(), map, sequence_, {});

  const Inspection inspection = Read();
  const auto at = [&](const char* column) {
    return At(inspection, "objects", 0, column).get<double>();
  };
  EXPECT_NEAR(at("yaw_deg"), kDegPerRad * 0.5, 1e-9);
  EXPECT_NEAR(at("sigma_yaw_deg"), kDegPerRad * 0.02, 1e-9);
  EXPECT_NEAR(at("sigma_centre_m"), 0.2, 1e-9);
  EXPECT_NEAR(at("sigma_size_percent"), 100.0 * std::sqrt(0.03), 1e-9);
  EXPECT_TRUE(At(inspection, "objects", 1, "sigma_yaw_deg").is_null());
  EXPECT_EQ(Said(inspection, "solver/converged"), "yes");
  EXPECT_EQ(Said(inspection, "solver/gated"), "no_plane 1");
  EXPECT_EQ(Said(inspection, "solver/detector_bias_px"), "1.500, -0.250, 0.333, 0.000");
}

TEST_F(InspectionTest, GroupsOfHdf5FilesAreRows) {
  SymmetryRecord record;
  record.frame_id = 10;
  record.object_id = 4;
  record.yaw = {0.0, 1.0};
  record.cost["total"] = {1.0, 2.0};
  record.samples = record.mirrored = {{1.0F, 2.0F}};
  record.refined_yaw = 0.1;
  SymmetryRecord other = record;
  other.frame_id = 15;
  other.true_yaw = 0.25;
  WriteSymmetry(File(), {record, other}, {});
  const Inspection inspection = Read(sequence_);
  ExpectRow(inspection, "observations", 0,
            {{"frame_id", 10},
             {"label", "label"},
             {"refined_yaw", 0.1},
             {"samples", "1 x 2, 1 to 2, mean 1.5"},
             {"cost/total", "2, 1 to 2, mean 1.5"},
             {"true_yaw", nullptr}});
  ExpectRow(inspection, "observations", 1, {{"frame_id", 15}, {"true_yaw", 0.25}});
}

TEST_F(InspectionTest, AppearanceAndHeadsAreTheirNumbersAndTexts) {
  BoxAppearance appearance;
  appearance.azimuth_costs.setConstant(1.0F);
  appearance.direction_correlation_deg = 20.0F;
  WriteAppearance(File(), {{3, 1, appearance, Eigen::Vector2f(0.6F, 0.8F), 1.5F}}, {});
  const Inspection of_boxes = Read(sequence_);
  EXPECT_EQ(Said(of_boxes, "direction_correlation_deg"), "20");
  EXPECT_EQ(Said(of_boxes, "azimuth_cost"), "1 x 36, 1 to 1, mean 1");
  EXPECT_THAT(of_boxes.title, HasSubstr("appearance"));
  HeadFile(3).Write(File());
  const Inspection of_head = Read();
  EXPECT_EQ(Said(of_head, "layers"), "Mul 0, last");
  EXPECT_EQ(Said(of_head, "side_px"), "64");
  EXPECT_THAT(Said(of_head, "groups"), HasSubstr("stool"));
  EXPECT_THAT(Said(of_head, "hidden/weights"), HasSubstr("3 x 102, "));
  const std::string text = FormatInspection(of_head, false);
  EXPECT_THAT(text, HasSubstr("\n  narrow\n    bias"));
}

TEST_F(InspectionTest, DataSetsOfHdf5FilesAreFacts) {
  WritePoints(File(),
              {{{0.0, 1.0, 2.0}, 0.5, {{3, {1.0, 1.0}}, {5, {2.0, 2.0}}}},
               {{0.5, 1.0, 2.0}, 1.5, {{5, {3.0, 3.0}}, {9, {4.0, 4.0}}}}},
              {});
  const Inspection inspection = Read();
  EXPECT_EQ(Said(inspection, "position"), "2 x 3, 0 to 2, mean 1.083");
  EXPECT_EQ(Said(inspection, "reprojection_error_px"), "2, 0.5 to 1.5, mean 1");
  EXPECT_EQ(Said(inspection, "observation_frame"), "4, 3 to 9, mean 5.5");
  EXPECT_TRUE(inspection.tables.empty());
  WriteMatches(File(), ImageMatches{{{{{3, {1.0, 1.0}}, {6, {2.0, 2.0}}}}}}, {});
  EXPECT_THAT(Read().title, HasSubstr("points that several images show"));
  EXPECT_EQ(Said(Read(), "observation_frame"), "2, 3 to 6, mean 4.5");
}

TEST_F(InspectionTest, TheStageAndItsSettingsAreSaid) {
  const auto said = [&](const char* name) { return Said(Inspect(File(), {}, {{"a", 1}}), name); };
  const ArtefactInfo info = {.settings = {{"a", 1}, {"b", 2.5}}, .stage = "ground"};
  WritePoints(File(), {}, info);
  EXPECT_THAT(said("made by"), testing::StartsWith("soslam-ground of soslam "));
  EXPECT_EQ(said("settings"), "b 2.5");
  WriteLandmarks(File(), {}, sequence_, {.settings = {{"a", 1}}});
  EXPECT_THAT(said("made by"), testing::StartsWith("soslam ")) << "older files name no stage";
  EXPECT_EQ(said("settings"), "all as by default");
}

// Every kind is shown, and a field of it is.
TEST_F(InspectionTest, AllKindsAreShown) {
  const auto says = [&](const char* fact, const std::string& text) {
    EXPECT_EQ(Said(Read(), fact), text) << Read().title;
    EXPECT_THAT(FormatInspection(Read(sequence_), true), HasSubstr(text));
  };
  Metrics metrics;
  metrics.summary.iou_mean = 0.5;
  MapQuality& quality = metrics.map_quality.emplace();
  quality.misses[MapReason::kGated] = 1;
  WriteMetrics(File(), metrics, sequence_, {});
  says("summary/iou_mean", "0.500");
  says("map_quality/misses", "gated 1");
  ReconstructionSummary summary;
  summary.images_without_pose = {"a.jpg", "b.jpg"};
  summary.components = {{40, 900}, {12, 80}};
  WriteReconstruction(File(), summary, {});
  says("images_without_pose", "a.jpg, b.jpg");
  PlanesReport planes;
  planes.planes.resize(1);
  WritePlanes(File(), planes, {});
  says("settled", "no");
  WriteAssociations(File(), {.agreement = {.objects = 3}}, {});
  says("agreement/objects", "3");
  SemanticRow cup{"cup", {"mug", "beaker"}, {}, 5, "a test"};
  WriteSemanticRows(File(), {"sizes", std::nullopt, {cup}}, {});
  says("description", "sizes");
  ExpectRow(Read(), "labels", 0, {{"name", "cup"}, {"aliases", {"mug", "beaker"}}});
  cv::Mat grey = cv::Mat::zeros(60, 80, CV_8UC1);
  EdgesWriter writer(File(), {});
  writer.Write(7, ComputeEdgeMaps(grey, {}));
  writer.Commit();
  ExpectRow(Read(), "frames", 0, {{"name", "000007"}, {"edges", "60 x 80, 0 to 0, mean 0"}});
}

TEST_F(InspectionTest, WhatIsNoArtefactIsRefused) {
  const auto refuses = [&](const std::string& bytes, const std::vector<std::string>& words) {
    WriteBytes(File(), bytes);
    ExpectError<InputError>([&] { Read(); }, words);
  };
  refuses(R"({"artefact": {"kind": 3}})", {File().string(), "no artefact header"});
  refuses(R"({"artefact": {"kind": "soup", "schema_version": [1, 0]}})",
          {"\"soup\"", "expected one of appearance, associations, edges, frames"});
  refuses(R"({"artefact": {"kind": "map", "schema_version": [1, 0]}})", {File().string()});
}

ValueTable SmallTable() {
  return {{{"label"}, {"x"}, {"empty"}, {"part/count"}, {"flag"}, {"axes"}},
          {{"b\xc3\xa4r", 1.0 / 3.0, nullptr, 12, true, {1.0, 0.5}},
           {"c", -10.0, "", 3, false, nullptr}}};
}

TEST(ValueTableTest, ColumnsLineUpAndEmptyOnesAreLeftOut) {
  EXPECT_EQ(FormatTable(SmallTable(), false),
            "               part/\n"
            "label       x  count  flag          axes\n"
            "b\xc3\xa4r      0.33     12  yes   1.000, 0.500\n"
            "c      -10.00      3  no               -\n");
}

TEST(ValueTableTest, WideTablesArePrintedInPartsWithTheirFirstColumns) {
  EXPECT_EQ(FormatTable(SmallTable(), false, {.rows = 1, .width = 20}),
            "              part/\n"
            "label      x  count\n"
            "b\xc3\xa4r    0.333     12\n"
            "\n"
            "label      x  flag\n"
            "b\xc3\xa4r    0.333  yes\n"
            "\n"
            "label      x          axes\n"
            "b\xc3\xa4r    0.333  1.000, 0.500\n");
}

TEST(ValueTableTest, CsvHasAllColumnsAndAllDigits) {
  EXPECT_EQ(FormatCsv(SmallTable()),
            "label,x,empty,part/count,flag,axes/0,axes/1\n"
            "b\xc3\xa4r,0.3333333333333333,,12,true,1,0.5\n"
            "c,-10,,3,false,,\n");
}

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

// A sphere of radius 0.5 whose centre and sizes have these standard deviations.
ObjectEstimate Sphere(double sigma_of_centre, double log_sigma_of_sizes) {
  ObjectEstimate estimate;
  estimate.landmark_in_world = Landmark{{}, Eigen::Vector3d::Constant(0.5), 2.0};
  Covariance9 covariance = Covariance9::Zero();
  covariance.block<3, 3>(3, 3).diagonal().setConstant(sigma_of_centre * sigma_of_centre);
  covariance.block<3, 3>(6, 6).diagonal().setConstant(log_sigma_of_sizes * log_sigma_of_sizes);
  estimate.covariance = covariance;
  return estimate;
}

TEST(DoubtsInWords, AreOfPlaceSizesAndSightings) {
  // 1.96 * 0.25 = 0.49, of 0.26: 0.51; exp(1.96 * 0.35) = 1.99, of 0.36: 2.03.
  EXPECT_EQ(DoubtsInWords(Sphere(0.25, 0.35), Sightings{5, 10}, kUp), "");
  EXPECT_EQ(DoubtsInWords(Sphere(0.26, 0.1), {}, kUp), "it may stand beside its outline");
  EXPECT_EQ(DoubtsInWords(Sphere(0.1, 0.36), {}, kUp),
            "its depth and width and height may be half or twice as large");
  EXPECT_EQ(DoubtsInWords(Sphere(0.1, 0.1), Sightings{4, 10}, kUp),
            "detected in only 4 of the 10 images that should show it");
  EXPECT_EQ(
      DoubtsInWords(Sphere(0.26, 0.1), Sightings{1, 3}, kUp),
      "detected in only 1 of the 3 images that should show it; it may stand beside its outline");
}

// Along the thin axis of a board 0.3 m are more than it reaches, along the others they are not;
// that it may be higher or lower by that says nothing of where it stands.
TEST(DoubtsInWords, ComparePlaceAndBodyInTheSameHorizontalDirectionWhateverTheWorld) {
  for (int i = 0; i < 50; ++i) {
    const Rigid3d world_from_object = RandomRigid();
    const Eigen::Matrix3d rotation = world_from_object.rotation.toRotationMatrix();
    for (int axis = 0; axis < 3; ++axis) {
      for (int up = 0; up < 3; ++up) {
        ObjectEstimate estimate = Sphere(0.01, 0.1);
        estimate.landmark_in_world = Landmark{world_from_object, {1.0, 0.1, 1.0}, kCuboidExponent};
        Eigen::Vector3d sigmas(0.01, 0.02, 0.03);
        sigmas[axis] = 0.3 / 1.96;
        estimate.covariance->block<3, 3>(3, 3) =
            rotation * sigmas.cwiseAbs2().asDiagonal() * rotation.transpose();
        EXPECT_EQ(DoubtsInWords(estimate, {}, rotation.col(up)).empty(), axis != 1 || up == 1)
            << axis << " " << up;
      }
    }
  }
}

}  // namespace
}  // namespace soslam
