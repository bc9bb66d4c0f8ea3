// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/report/tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/report/results_tree.h"
#include "soslam/system/hash.h"
#include "support/edited_json.h"
#include "support/expect_error.h"
#include "support/random_estimates.h"
#include "support/results_folder.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

Alignments OneAlignment(AlignmentKind kind, double scale, int frames,
                        std::optional<double> rmse_m) {
  return {{{0, {kind, CameraPath::kGeneral, scale, {}, frames, rmse_m}}}};
}

MapScore Score(int found, double f1) {
  MapScore score;
  score.true_objects = 4;
  score.detectable = 3;
  score.landmarks = 5;
  score.ignored = 1;
  score.found = found;
  score.precision = 0.875;
  score.recall = 0.625;
  score.f1 = f1;
  score.average_precision = 0.5625;
  score.recall_of_detectable = 0.75;
  FoundSummary& of_found = score.of_found;
  of_found.iou_mean = 0.5;
  of_found.centre_m_mean = 0.125;
  of_found.centre_relative_mean = 0.25;
  of_found.log_size_abs_mean = {0.1, 0.2, std::nullopt};
  of_found.log_scale_abs_mean = 0.0625;
  of_found.up_error_deg_mean = 1.5;
  of_found.plane_offset_m_abs_mean = 0.01;
  of_found.plane_tilt_deg_mean = 2.5;
  of_found.labels_agree = 2;
  of_found.ids_known = 3;
  of_found.ids_agree = 1;
  return score;
}

LandmarkRow FalseLandmark(int id, const std::string& label, std::optional<int> true_object,
                          MapReason reason) {
  LandmarkRow row;
  row.object_index = id;
  row.label = label;
  row.true_index = true_object;
  row.why_false = Explanation{reason, ""};
  return row;
}

// What tables read of the metrics of a map: a cup that is missed, and a television that is false.
Metrics MapMetrics(const Alignments& alignments) {
  Metrics metrics;
  metrics.odometry_source = "ORB-SLAM2";
  MapQuality& quality = metrics.map_quality.emplace();
  quality.alignments = alignments;
  quality.scores = {Score(3, 0.75), Score(2, 0.5)};
  quality.in_frames.iou_mean = 0.625;
  quality.in_frames.iou_mean_in_world = 0.5;
  quality.objects = {{7, 0, false, {}, Explanation{MapReason::kNotDetected, "0 of 9"}, "cup"},
                     {8, 9, true, {}, {}, "book"}};
  quality.landmarks = {FalseLandmark(2, "tv", {}, MapReason::kBackground)};
  return metrics;
}

using testing::ElementsAre;

TEST(DatasetFacts, AboutIsReadBesideTheSettings) {
  const TemporaryFolder folder;
  WriteBytes(
      folder / "room.json",
      R"({"import": {"labels": "cup"}, "about": {"boxes": "a network", "boxes_of": "detector"}})");
  DatasetFacts facts;
  facts.odometry = "COLMAP";
  ReadAbout(folder / "room.json", &facts);
  EXPECT_TRUE(facts.HasDetectorBoxes());
  EXPECT_EQ(DifferencesInWords(facts), "boxes: a network; odometry: COLMAP");
  ReadAbout(folder / "none.json", &facts);
  EXPECT_EQ(facts.boxes, "a network");
}

TEST(DatasetFacts, RefusesWhatTheSchemaDoesNotAllow) {
  const TemporaryFolder folder;
  WriteBytes(folder / "room.json", R"({"about": {"boxes_of": "hand"}})");
  DatasetFacts facts;
  ExpectError<InputError>([&] { ReadAbout(folder / "room.json", &facts); },
                          {"room.json", "/boxes_of", "hand"});
}

// The settings of the project say of each dataset whose boxes it has.
TEST(DatasetFacts, AllDatasetsOfTheProjectAreDescribed) {
  const std::filesystem::path settings =
      std::filesystem::path(SOSLAM_SOURCE_DIR) / "pipelines" / "datasets";
  for (const auto& file : std::filesystem::directory_iterator(settings)) {
    DatasetFacts facts;
    ReadAbout(file.path(), &facts);
    EXPECT_FALSE(facts.boxes.empty()) << file.path();
    EXPECT_TRUE(facts.boxes_of) << file.path();
  }
}

TEST(DatasetTable, HasTheNumbersOfEachVariantAndOfTheOdometry) {
  Metrics single_frames, map;
  single_frames.summary = map.summary = {8, 247, 0.34678, {}, 7.1016, {}, 22.874, {}};
  single_frames.first_observation.emplace().iou_mean = 0.4053;
  map.trajectory = {0.01234, 0.05678};
  const Table table = DatasetTable({"room", {{"InitP", {}, single_frames}, {"OursS", {}, map}}});
  const std::vector<std::string> rows = CellTexts(table);
  EXPECT_THAT(rows, testing::IsSupersetOf(
                        {"InitP 8 247 0.347 0.405 7.10 - 22.87 -", "Quadric - - - - - - - -"}));
  EXPECT_EQ(rows.back(), "OursS 8 247 0.347 - 7.10 - 22.87 0.0123");
  EXPECT_THAT(table.notes, ElementsAre("ATE of the odometry alone: 0.0568 m"));
}

TEST(SequencesTable, HasARowForEachCountedDataset) {
  DatasetFacts facts;
  facts.counts = DatasetCounts{.frames = 4, .objects = 3, .round_objects = 1};
  facts.boxes = "a network";
  EXPECT_THAT(CellTexts(SequencesTable({{"room", {}, facts}, {"attic", {}}})),
              ElementsAre("room a network - - r 4 3 1"));
}

using testing::IsEmpty;

const Alignments kExact = OneAlignment(AlignmentKind::kNone, 1.0, 3, 0.0);

const WhatIf kWhatIf = {.yaw = 0.75, .quarter_turn = 0.625, .place = 0.875, .size = 1.0};

LandmarkRow FoundLandmark(int true_object, const std::optional<InFrames>& in_frames) {
  LandmarkRow row;
  row.object_index = 5;
  row.label = "bowl";
  row.fate = LandmarkFate::kFound;
  row.true_index = true_object;
  row.in_frames = in_frames;
  row.errors = BodyErrors();
  row.errors->iou = 0.5;
  row.errors->centre_m = 0.25;
  row.errors->log_size = {0.5, -0.25, 0.0};
  return row;
}

std::vector<DatasetResult> OneMap(const Metrics& metrics,
                                  const std::filesystem::path& folder = {}) {
  return {{"room", {{"OursS", folder, metrics}}}};
}

TEST(MapsTable, SaysWhatTheVariantWasGiven) {
  const TemporaryFolder folder;
  WriteBytes(folder / "associations.json", "");
  const Table table = MapsTable(OneMap(MapMetrics(kExact), folder.path()), {"OursSTE", "OursS"});
  EXPECT_THAT(CellTexts(table),
              ElementsAre("room OursS estimated given 4 (3) 5 (1) 0.75 3 0.88 0.62 0.75 0.56 0.500 "
                          "2 0.88 0.62 0.50 0.56 0.500"));
  EXPECT_EQ(table.header.size(), table.rows.front().size());
}

// The landmark of a missed object is not listed again.
TEST(LostTable, JoinsTheObjectsOfAReason) {
  Metrics metrics = MapMetrics(kExact);
  metrics.map_quality->objects.push_back(
      {9, 0, false, {}, Explanation{MapReason::kNotDetected, ""}, "can"});
  metrics.map_quality->landmarks.push_back(FalseLandmark(1, "jar", 7, MapReason::kWrongSize));
  metrics.map_quality->landmarks.push_back(FalseLandmark(3, "jar", 8, MapReason::kDuplicate));
  EXPECT_THAT(CellTexts(LostTable(OneMap(metrics), {"OursS"})),
              ElementsAre("room OursS missed not detected cup 7, can 9",
                          "room OursS false background tv 2", "room OursS false duplicate jar 3"));
}

TEST(LimitsTable, HasTheFoundLandmarks) {
  Metrics metrics = MapMetrics(kExact);
  metrics.map_quality->landmarks.push_back(FoundLandmark(8, InFrames{3, 0.625, 0.0, kWhatIf}));
  metrics.map_quality->landmarks.push_back(FoundLandmark(6, {}));
  const Table table = LimitsTable(OneMap(metrics), {"OursS"});
  EXPECT_THAT(
      CellTexts(table),
      ElementsAre("room OursS bowl 8 0.500 0.625 0.750 0.625 0.875 1.000 0.250 0.50, -0.25, 0.00 -",
                  "room OursS bowl 6 0.500 - - - - - 0.250 0.50, -0.25, 0.00 -"));
  EXPECT_EQ(table.header.size(), table.rows.front().size());
}

TEST(WhatIfTable, HasMapsAndSingleFrames) {
  Metrics map = MapMetrics(kExact);
  map.map_quality->in_frames = {3, 0.625, 0.5, {}, {}, kWhatIf};
  Metrics single_frames, without;
  single_frames.summary.objects = 2;
  single_frames.summary.iou_mean = 0.5;
  single_frames.summary.what_if = kWhatIf;
  const Table table = WhatIfTable(
      {{"room", {{"OursS", {}, map}, {"InitSTE", {}, single_frames}, {"SVD", {}, without}}}},
      {"SVD", "InitSTE", "OursS", "OursSTE"});
  EXPECT_THAT(CellTexts(table), ElementsAre("room InitSTE 2 0.500 0.750 0.625 0.875 1.000",
                                            "room OursS 3 0.625 0.750 0.625 0.875 1.000"));
  EXPECT_EQ(table.header.size(), table.rows.front().size());
}

TEST(QualityTables, HaveARowForEachMap) {
  const auto tables = QualityTables(
      {"room",
       {{"InitP", {}, Metrics()},
        {"OursS", {}, MapMetrics(OneAlignment(AlignmentKind::kRigid, 1.0, 9, 0.25))}}});
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].name, "map_quality_room");
  EXPECT_THAT(
      CellTexts(tables[0]),
      ElementsAre("OursS 4 (3) 5 (1) 0.75 3 0.88 0.62 0.75 0.56 0.500 2 0.88 0.62 0.50 0.56 "
                  "0.500"));
  EXPECT_THAT(tables[0].notes,
              ElementsAre(testing::StartsWith("True objects"), "Odometry: ORB-SLAM2."));
  EXPECT_EQ(tables[1].name, "map_errors_room");
  EXPECT_THAT(CellTexts(tables[1]),
              ElementsAre("OursS 0.125 0.25 0.10, 0.20, - 0.062 - 1.5 0.010 2.5 2 of 3 1 of 3 "
                          "0.625 0.500"));
  for (const Table& table : tables) EXPECT_EQ(table.header.size(), table.rows.front().size());
}

TEST(QualityTables, HaveUpAndScaleOfMapsWithAWorldOfTheirOwn) {
  Alignments own = OneAlignment(AlignmentKind::kSimilarity, 1.25, 9, 0.25);
  own.of_segment[0].up_error_deg = 2.125;
  const Table errors = QualityTables(
      {"room", {{"OursS", {}, MapMetrics(kExact)}, {"OursSP", {}, MapMetrics(own)}}})[1];
  EXPECT_THAT(errors.header, testing::Contains("up of map deg"));
  EXPECT_THAT(CellTexts(errors),
              ElementsAre(testing::EndsWith(" - -"), testing::EndsWith(" 2.1 1.250")));
}

TEST(DatasetTable, HasColumnsOfFrontsWhereThereAreSome) {
  const Metrics without = MapMetrics(kExact);
  Metrics with = without;
  with.summary.fronts = {4, 50.125, 12.0, 0.75, 3, 1};
  with.map_quality->scores[0].of_found.fronts = {2, 5.0, 5.0, 1.0, 0, 0};
  const DatasetResult room = {"room", {{"OursS", {}, without}, {"OursSA", {}, with}}};
  const Table table = DatasetTable(room), errors = QualityTables(room)[1];
  EXPECT_EQ(table.header.size(),
            DatasetTable({"room", {{"OursS", {}, without}}}).header.size() + 5);
  EXPECT_THAT(table.header, testing::Contains("front error deg"));
  EXPECT_THAT(CellTexts(table), testing::Contains(testing::EndsWith(" 50.12 12.00 0.75 3 1")));
  EXPECT_THAT(CellTexts(table), testing::Contains(testing::EndsWith(" - - - - -")));
  EXPECT_THAT(CellTexts(errors), ElementsAre(testing::EndsWith(" - - - - -"),
                                             testing::EndsWith(" 5.00 5.00 1.00 0 0")));
  for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.header.size());
}

TEST(QualityTables, TitlesSayWhatAlignedTheMaps) {
  const auto title = [](const std::vector<Alignments>& alignments) {
    DatasetResult road{"road", {}};
    for (const Alignments& of_map : alignments) {
      road.variants.push_back({"OursS", {}, MapMetrics(of_map)});
    }
    const std::string text = QualityTables(road)[0].title;
    return text.substr(text.find("alignment"));
  };
  Alignments two_segments = OneAlignment(AlignmentKind::kNone, 1.0, 3, 0.1);
  two_segments.of_segment[1] = {AlignmentKind::kNone, CameraPath::kGeneral, 1.0, {}, 1, 0.5};
  // sqrt((3 * 0.01 + 0.25) / 4)
  EXPECT_EQ(title({two_segments}), "alignment none, cameras 0.2646 m from the true ones");
  EXPECT_EQ(title({OneAlignment(AlignmentKind::kSimilarity, 2.5, 9, 0.25),
                   OneAlignment(AlignmentKind::kSimilarity, 2.0, 9, 0.5)}),
            "alignment similarity, scale 2 to 2.5, cameras 0.25 to 0.5 m from the true ones");
  EXPECT_EQ(title({OneAlignment(AlignmentKind::kNone, 1.0, 0, {})}), "alignment none");
}

class TimingTableTest : public testing::Test {
 protected:
  // A variant made of these runs, of which `optimise-4` takes 4 s of wall and 4.5 s of CPU time.
  void Write(const std::string& variant, const std::vector<std::string>& runs,
             bool is_single_frame) {
    results_.WriteMetrics("room", variant, {{.id = 1}, {.id = 2}}, is_single_frame);
    results_.WriteStages("room", variant, runs);
    WriteSequence(results_.VariantFolder("room", variant) / "sequence.json", RandomSequence(), {});
    for (const std::string& run : runs) {
      const double seconds = std::stod(run.substr(run.rfind('-') + 1));
      results_.WriteTiming("room", run, seconds, seconds + 0.5);
    }
  }
  std::vector<DatasetResult> Read() const { return ReadResults(results_.path()); }
  std::optional<LandmarkTime> TimeOf(const std::string& variant) const {
    const DatasetResult dataset = Read().front();
    return TimePerLandmark(*dataset.Evaluated(variant), {.observations = 8, .objects = 2});
  }

  ResultsFolder results_;
};

// Single frames count from edges and tracks to refinement, per observation; initialisation from all
// frames and back ends alone, per object.
TEST_F(TimingTableTest, CountsWhatMadeTheLandmarks) {
  struct Row {
    const char* variant;
    std::vector<std::string> runs;
    bool is_single_frame;
    double wall_s;  // of all landmarks
    double landmarks;
  };
  for (const auto& [variant, runs, is_single_frame, wall_s, landmarks] : std::vector<Row>{
           {"InitPT", {"import-9", "edges-1", "initialise-2", "refine-5"}, true, 1 + 2 + 5, 8},
           {"InitSP", {"import-9", "track-4", "initialise-2"}, true, 4 + 2, 8},
           {"SVD", {"import-9", "initialise-2", "evaluate-9"}, false, 2, 2},
           {"OursPT", {"edges-1", "initialise-2", "refine-5", "optimise-4"}, false, 4, 2}}) {
    Write(variant, runs, is_single_frame);
    const auto time = TimeOf(variant);
    ASSERT_TRUE(time) << variant;
    EXPECT_DOUBLE_EQ(time->wall_ms, 1e3 * wall_s / landmarks) << variant;
    EXPECT_EQ(time->observations, 8 / landmarks) << variant;
  }
}

TEST_F(TimingTableTest, NoTimesWithoutStagesOrTimingOrSequence) {
  results_.WriteMetrics("room", "InitP", {{.id = 1}}, true);
  EXPECT_FALSE(TimeOf("InitP"));
  Write("InitPT", {"initialise-2", "refine-5"}, true);
  std::filesystem::remove(results_.path() / "room/shared/refine-5/timing.json");
  EXPECT_FALSE(TimeOf("InitPT"));
  Write("InitP", {"initialise-2"}, true);
  std::filesystem::remove(results_.path() / "room/InitP/sequence.json");
  EXPECT_THAT(TimeTable(Read(), {}).rows, IsEmpty());
}

// The sequence has ten observations.
TEST_F(TimingTableTest, MeasuredAndPublishedTimesOnTheirMachines) {
  Write("InitP", {"initialise-2"}, true);
  Published published;
  published.times = {"A paper", "desk", "A laptop", {{"InitP", 5.8, 1.4, 1.0}}};
  const Table table = TimeTable(Read(), published);
  EXPECT_THAT(CellTexts(table),
              ElementsAre("room wall ms - - 200.0 - - - - - - - - - - - - - - - -",
                          "room CPU ms - - 250.0 - - - - - - - - - - - - - - - -",
                          "room observations - - 1.0 - - - - - - - - - - - - - - - -",
                          "desk published ms - - 5.8 ± 1.4 - - - - - - - - - - - - - - - -",
                          "desk published observations - - 1.0 - - - - - - - - - - - - - - - -"));
  EXPECT_EQ(table.notes.front(),
            "Measured on: A CPU, 4 cores, 2 threads. Stages that ran side by side have longer wall "
            "times.");
  EXPECT_EQ(table.notes.back(), "Published: A paper, on A laptop.");
}

TEST(CountObservations, ReadsWhatTheSchemaAllows) {
  const TemporaryFolder folder;
  const auto file = folder / "sequence.json";
  WriteSequence(file, RandomSequence(), {});
  EXPECT_EQ(CountObservations(file).observations, 10);
  EXPECT_EQ(CountObservations(file).objects, 4);
  ExpectEditsRefused(file,
                     {{"/detections", nullptr, "the document"},
                      {"/detections/0/object", "\"1\"", "/detections/0/object is \"1\""}},
                     [&] { CountObservations(file); });
}

using testing::HasSubstr;
using testing::StartsWith;

const std::vector<Table> kTables = {
    {"prices", "Prices", {"thing", "price"}, {{"cup", "3"}}, 1, {}}};
const std::string kPage = "# Shop\n\nBefore.\n\n<!-- table: prices -->\n<!-- end -->\n\nAfter.\n";

TEST(ResultsPage, ProseStaysAroundATable) {
  const std::string page = FillPage(kPage, kTables, "shop.md");
  EXPECT_THAT(page, StartsWith("# Shop\n\nBefore.\n\n<!-- table: prices -->\n"));
  const std::string content = "\n#" + ToMarkdown(kTables[0]) + "\n";
  EXPECT_THAT(page, HasSubstr(content + "<!-- end: " + Sha256OfText(content) + " -->\n"));
  EXPECT_TRUE(page.ends_with(" -->\n\nAfter.\n"));
  EXPECT_EQ(FillPage(page, kTables, "shop.md"), page);
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
  const std::string page = FileBytes(SOSLAM_SOURCE_DIR "/docs/results.md");
  const std::string end = "<!-- end: ";
  for (size_t at = page.find("<!-- table:"); at != page.npos; at = page.find("<!-- table:", at)) {
    const size_t content = page.find('\n', at) + 1;
    at = page.find(end, content);
    ASSERT_NE(at, page.npos);
    EXPECT_EQ(page.substr(at + end.size(), 64), Sha256OfText(page.substr(content, at - content)))
        << "make results-page writes it: " << page.substr(content, 80);
  }
}

TEST(ResultsPage, TheDocumentationHasAColumnForEachVariant) {
  const std::string page = FileBytes(SOSLAM_SOURCE_DIR "/docs/results.md");
  for (const std::string variant : kKnownVariants) {
    EXPECT_THAT(page, testing::ContainsRegex("\\| +" + variant + " \\|"));
  }
}

}  // namespace
}  // namespace soslam
