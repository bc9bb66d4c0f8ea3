// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/inspection.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "artefact/files.h"
#include "artefact/hdf5_artefact.h"
#include "association/agreement.h"
#include "base/error.h"
#include "dataset/reconstruct_options.h"
#include "geometry/angles.h"
#include "initialisation/options.h"
#include "inspection/doubts.h"
#include "mapping/options.h"
#include "planes/planes_estimate.h"
#include "stage/stages.h"
#include "support/expect_error.h"
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
  static Value At(const Inspection& inspection, size_t row, const std::string& column) {
    const auto& columns = inspection.table.columns;
    const auto found = std::ranges::find(columns, column, &ValueColumn::name);
    if (found == columns.end()) throw std::out_of_range(column);
    return inspection.table.rows.at(row).at(found - columns.begin());
  }
  // Expects these values in a row, by column.
  static void ExpectRow(const Inspection& inspection, size_t row,
                        const std::vector<std::pair<std::string, Value>>& values) {
    for (const auto& [column, value] : values) {
      EXPECT_EQ(At(inspection, row, column), value) << column << " of row " << row;
    }
  }

  Sequence sequence_ = RandomSequence();

 private:
  TemporaryFolder folder_;
};

TEST_F(InspectionTest, SequencesHaveARowPerObject) {
  WriteSequence(File(), sequence_, {});
  const Inspection inspection = Read();
  EXPECT_THAT(inspection.title, HasSubstr("sequence"));
  EXPECT_EQ(Said(inspection, "dataset"), sequence_.name);
  EXPECT_EQ(Said(inspection, "detections"), "10 used, 19 rejected: 17 near_border, 2 duplicate");
  EXPECT_THAT(Said(inspection, "frames"), HasSubstr("5, ids 10 to 30, segments: 2"));
  ASSERT_EQ(inspection.table.rows.size(), 4u);
  ExpectRow(inspection, 1,
            {{"object", 4}, {"plane", 3}, {"views", 2}, {"first_frame", 15}, {"static", true}});
}

TEST_F(InspectionTest, LandmarksHaveARowPerObservationAndObject) {
  const LandmarkEstimates estimates = RandomLandmarkEstimates();
  WriteLandmarks(File(), estimates, sequence_, {OptionsToJson(InitialiseOptions()), {}});
  const Inspection inspection = Read(sequence_);
  EXPECT_THAT(Said(inspection, "made by"), HasSubstr("soslam-initialise"));
  EXPECT_EQ(Said(inspection, "settings"), "all as by default");
  EXPECT_THAT(Said(inspection, "found"), HasSubstr("2 of 3 observations"));
  EXPECT_EQ(Said(inspection, "failures"), "1 plane_behind_camera, 1 too_few_views");
  ASSERT_EQ(inspection.table.rows.size(), 6u);
  ExpectRow(inspection, 0,
            {{"x", estimates.observations[0].hypotheses[0].landmark_in_camera.Centre().x()},
             {"hypotheses", 2}});
  ExpectRow(inspection, 1, {{"failure", "plane_behind_camera"}, {"x", nullptr}});
  ExpectRow(inspection, 3, {{"label", "label"}});
  ExpectRow(inspection, 4, {{"failure", "not an ellipsoid"}});
  EXPECT_TRUE(At(Read(), 3, "label").is_null()) << "nobody knows it without the sequence";
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
  OptimiseOptions options;
  options.max_iterations += 1;
  map.objects[0].points = {{3, 0.1, 0.5}, {4, 0.0, 0.5}, {9, -2.0, 0.0}};
  WriteMap(File(), map, sequence_, {OptionsToJson(options), {}});

  const Inspection inspection = Read();
  EXPECT_NEAR(At(inspection, 0, "yaw").get<double>(), kDegPerRad * 0.5, 1e-9);
  EXPECT_NEAR(At(inspection, 0, "sigma_yaw").get<double>(), kDegPerRad * 0.02, 1e-9);
  EXPECT_NEAR(At(inspection, 0, "sigma_centre").get<double>(), 0.2, 1e-9);
  EXPECT_NEAR(At(inspection, 0, "sigma_size").get<double>(), 100.0 * std::sqrt(0.03), 1e-9);
  EXPECT_TRUE(At(inspection, 1, "sigma_yaw").is_null());
  EXPECT_EQ(At(inspection, 0, "points"), 3);
  EXPECT_NEAR(At(inspection, 0, "of_object").get<double>(), 1.0, 1e-12);
  EXPECT_NEAR(At(inspection, 0, "rms_distance").get<double>(), 0.1 * std::sqrt(0.5), 1e-12);
  EXPECT_TRUE(At(inspection, 1, "points").is_null());
  EXPECT_EQ(Said(inspection, "settings"), fmt::format("max_iterations {}", options.max_iterations));
  EXPECT_EQ(Said(inspection, "solver"),
            "converged after 3 iterations; cost 12.5 at first, 0.1 at the end");
  EXPECT_EQ(Said(inspection, "left out"), "1 no_plane");
  EXPECT_THAT(Said(inspection, "detector"), HasSubstr("1.50, -0.25, 0.33, 0.00 px"));
}

TEST_F(InspectionTest, MetricsHaveARowPerObject) {
  Metrics metrics;
  metrics.summary = {2, 7, 0.5, 0.625, 3.0, 4.0, std::nullopt, std::nullopt};
  metrics.objects = {{0, 4, 1, 0.75, 0.1, 2.5, 1.25}, {2, 3, 0, 0.0, {}, {}, {}}};
  metrics.trajectory = {0.01, 0.02};
  metrics.held_out = HeldOutMetrics{3, 6, 5, 4, 3, 0.7, 0.8, 0.6, {{2, 4, 3, 5, 0.9}}};
  WriteMetrics(File(), metrics, sequence_, {});
  const Inspection inspection = Read();
  EXPECT_THAT(Said(inspection, "all"), HasSubstr("IoU 0.500 (median 0.625)"));
  EXPECT_THAT(Said(inspection, "all"), HasSubstr("yaw error - (median -) deg"));
  EXPECT_THAT(Said(inspection, "trajectory"), HasSubstr("0.0100 m, of the odometry 0.0200 m"));
  EXPECT_THAT(Said(inspection, "held out"), HasSubstr("in 3 frames: 5 of 6 detections"));
  ExpectRow(inspection, 0, {{"iou", 0.75}, {"held_out_iou", nullptr}});
  ExpectRow(inspection, 1, {{"centre_error", nullptr}, {"held_out_iou", 0.9}});
}

TEST_F(InspectionTest, MetricsWithoutIdsHaveARowPerLandmark) {
  sequence_.true_objects = {{40, "cup", {}, 0, true}, {41, "mouse", {}, 0, true}};
  Metrics metrics;
  MapQuality& quality = metrics.map_quality.emplace();
  quality.alignments.of_segment[0] = {
      AlignmentKind::kSimilarity, CameraPath::kLine, 2.5, {}, 9, 0.0125};
  quality.scores[0].min_iou = 0.25;
  quality.scores[0].true_objects = 2;
  quality.scores[0].landmarks = 3;
  quality.scores[0].ignored = 1;
  quality.scores[0].found = 1;
  quality.scores[0].of_found.log_scale_abs_mean = 0.375;
  quality.scores[1].min_iou = 0.5;
  quality.objects = {{0, 5, true, 0},
                     {1, 4, true, std::nullopt, Explanation{MapReason::kGated, "near_border 4"}}};
  quality.misses[MapReason::kGated] = 1;
  quality.landmarks.resize(3);
  quality.landmarks[0].fate = LandmarkFate::kFound;
  quality.landmarks[0].true_index = 0;
  quality.landmarks[0].errors.emplace().iou = 0.75;
  quality.landmarks[1].object_index = 1;
  quality.landmarks[1].why_false = Explanation{MapReason::kBackground, ""};
  quality.landmarks[2].object_index = 2;
  quality.landmarks[2].fate = LandmarkFate::kIgnored;
  WriteMetrics(File(), metrics, sequence_, {});
  const Inspection inspection = Read();
  EXPECT_EQ(Said(inspection, "alignment"),
            "similarity, scale 2.5; cameras 0.0125 m from the true ones (9 frames, path: line)");
  EXPECT_THAT(Said(inspection, "IoU >= 0.25"),
              HasSubstr("1 of 2 objects found (0 of the 0 detectable), 1 of 2 landmarks right, 1 "
                        "ignored"));
  EXPECT_THAT(Said(inspection, "found"), HasSubstr("log scale 0.375"));
  EXPECT_EQ(Said(inspection, "missed"), "41 (mouse): gated; near_border 4");
  EXPECT_THAT(Said(inspection, "false"), HasSubstr("background"));
  ASSERT_EQ(inspection.table.rows.size(), 3u);
  ExpectRow(inspection, 0, {{"true_object", 40}, {"iou", 0.75}});
  ExpectRow(inspection, 1, {{"reason", "background"}});
  ExpectRow(inspection, 2, {{"fate", "ignored"}});
}

TEST_F(InspectionTest, PlanesSayWhatStandsOnThem) {
  PlanesEstimate estimate;
  estimate.planes.resize(2);
  estimate.planes[1].covariance = Eigen::Vector3d(0.0, 1e-4, 4e-4).asDiagonal();
  for (int i = 0; i < 4; ++i)
    estimate.objects.push_back({1, SupportReason::kOwnHeight, {}, {}, {}});
  estimate.objects[2].reason = SupportReason::kLowestCost;
  WritePlanes(File(), ReportOf(estimate, sequence_), {});
  const Inspection inspection = Read();
  EXPECT_EQ(Said(inspection, "decided by"), "3 own_height, 1 lowest_cost");
  EXPECT_THAT(Said(inspection, "found"), HasSubstr("NOT settled"));
  EXPECT_EQ(At(inspection, 0, "objects"), "none");
  EXPECT_EQ(At(inspection, 1, "objects"), "-3 label, 4 label, 11 label (lowest_cost), 18 label");
  EXPECT_NEAR(At(inspection, 1, "sigma_height").get<double>(), 0.02, 1e-12);
}

TEST_F(InspectionTest, AssociationsHaveARowPerObject) {
  Association association;
  association.detections.resize(sequence_.detections.size());
  Track track;
  track.detections = {0, 1};
  track.linked = 2;
  track.votes = {{"cup", 3}, {"mug", 1}};
  track.labels = {{"cup", 0.8}, {"mug", 0.2}};
  association.tracks = {track};
  association.objects = {0};
  Agreement agreement;
  agreement.given_of_object = {1};
  agreement.given_objects = 2;
  agreement.matched = 1;
  WriteAssociations(File(), ReportOf(sequence_, association, agreement), {});
  const Inspection inspection = Read();
  EXPECT_THAT(Said(inspection, "agreement"), HasSubstr("precision 1.000, recall 0.500"));
  EXPECT_EQ(Said(inspection, "detections"), "10: 10 new_track");
  ExpectRow(inspection, 0, {{"given_object", 4}, {"label_votes", "3 cup, 1 mug"}});
}

TEST_F(InspectionTest, SemanticTablesHaveARowPerLabel) {
  SemanticRow cup{"cup", {"mug", "beaker"}, {}, 5, "a test"};
  cup.prior.height_m = LogNormal{0.1, 0.2};
  cup.prior.shape_exponents = {2.0, 1.25};
  WriteSemanticRows(File(), {"sizes", std::nullopt, {cup}}, {});
  const Inspection inspection = Read();
  EXPECT_EQ(Said(inspection, "what"), "sizes");
  ExpectRow(inspection, 0,
            {{"aliases", "mug, beaker"}, {"height", 0.1}, {"p", 2.0}, {"p_vertical", 1.25}});
}

TEST_F(InspectionTest, PointsHaveARowPerFrame) {
  WritePoints(File(),
              {{{0.0, 1.0, 2.0}, 0.5, {{3, {1.0, 1.0}}, {5, {2.0, 2.0}}}},
               {{0.5, 1.0, 2.0}, 1.5, {{5, {3.0, 3.0}}, {9, {4.0, 4.0}}}}},
              {});
  const Inspection inspection = Read();
  EXPECT_EQ(Said(inspection, "points"), "2, 4 observations in 3 frames");
  EXPECT_EQ(Said(inspection, "reprojection error"), "median 1.00 px");
  EXPECT_THAT(Said(inspection, "98 % lie within"), HasSubstr("x 0.000 to 0.500"));
  ASSERT_EQ(inspection.table.rows.size(), 3u);
  ExpectRow(inspection, 1, {{"frame", 5}, {"points", 2}, {"median_error", 1.0}});
}

TEST_F(InspectionTest, ReconstructionsHaveARowPerComponent) {
  ReconstructionSummary summary;
  summary.images = 60;
  summary.registered = 40;
  summary.components = {{40, 900}, {12, 80}};
  summary.median_triangulation_angle_deg = 3.5;
  WriteReconstruction(File(), summary, {OptionsToJson(ReconstructOptions()), {}});
  const Inspection inspection = Read();
  EXPECT_THAT(Said(inspection, "made by"), HasSubstr("soslam-reconstruct"));
  EXPECT_EQ(Said(inspection, "registered"), "40 of 60 images");
  EXPECT_EQ(Said(inspection, "medians"),
            "reprojection error unknown, triangulation angle 3.50 degrees");
  ASSERT_EQ(inspection.table.rows.size(), 2u);
  EXPECT_EQ(At(inspection, 1, "images"), 12);
}

TEST_F(InspectionTest, EdgesHaveARowPerFrame) {
  cv::Mat grey = cv::Mat::zeros(60, 80, CV_8UC1);
  grey(cv::Rect(20, 10, 30, 30)).setTo(200);
  EdgesWriter writer(File(), {});
  writer.Write(7, ComputeEdgeMaps(grey, {}));
  writer.Write(1234567, ComputeEdgeMaps(cv::Mat::zeros(60, 80, CV_8UC1), {}));
  writer.Commit();
  const Inspection inspection = Read();
  EXPECT_EQ(At(inspection, 0, "frame"), 7);
  EXPECT_GT(At(inspection, 0, "edges").get<int>(), 60);
  EXPECT_GT(At(inspection, 0, "mean_distance").get<double>(), 1.0);
  // There is no edge.
  ExpectRow(inspection, 1, {{"frame", 1234567}, {"edges", 0}, {"mean_distance", nullptr}});
}

TEST_F(InspectionTest, SymmetryHasARowPerObservation) {
  SymmetryRecord record;
  record.frame_id = 10;
  record.object_id = 4;
  record.yaw = {0.0, 1.0};
  record.cost["total"] = {1.0, 2.0};
  record.samples = record.mirrored = {{1.0F, 2.0F}};
  record.refined_yaw = 0.1;
  record.true_yaw = 0.2 + std::numbers::pi;
  WriteSymmetry(File(), {record}, {});
  const Inspection inspection = Read(sequence_);
  EXPECT_EQ(Said(inspection, "curves"), "1 total; up to 2 yaws each");
  ExpectRow(inspection, 0, {{"label", "label"}, {"pairs", 1}, {"initial_yaw", nullptr}});
  EXPECT_NEAR(At(inspection, 0, "yaw_error").get<double>(), 18.0 / std::numbers::pi, 1e-9);
}

TEST_F(InspectionTest, WhatIsNoArtefactIsRefused) {
  const auto refuses = [&](const std::string& bytes, const std::vector<std::string>& words) {
    WriteBytes(File(), bytes);
    ExpectError<InputError>([&] { Read(); }, words);
  };
  refuses(R"({"artefact": {"kind": 3}})", {File().string(), "no artefact header"});
  refuses(R"({"artefact": {"kind": "soup", "schema_version": [1, 0]}})",
          {"\"soup\"", "expected one of associations, edges"});
  refuses(R"({"artefact": {"kind": "map", "schema_version": [1, 0]}})", {File().string()});
}

ValueTable SmallTable() {
  return {{{"label", ""}, {"x", "m", 2}, {"share", "%", 1}, {"count", ""}, {"flag", ""}},
          {{"b\xc3\xa4r", 1.0 / 3.0, nullptr, 12, true}, {"c", -10.0, nullptr, 3, false}}};
}

TEST(ValueTableTest, ColumnsLineUpAndEmptyOnesAreLeftOut) {
  EXPECT_EQ(FormatTable(SmallTable(), false),
            "label       x  count  flag\n"
            "            m\n"
            "b\xc3\xa4r      0.33     12  yes\n"
            "c      -10.00      3  no\n");
}

TEST(ValueTableTest, CsvHasAllColumnsAndAllDigits) {
  EXPECT_EQ(FormatCsv(SmallTable()),
            "label,x_m,share_percent,count,flag\n"
            "b\xc3\xa4r,0.3333333333333333,,12,true\n"
            "c,-10,,3,false\n");
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
