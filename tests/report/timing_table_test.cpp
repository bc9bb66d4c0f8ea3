// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/tables.h"
#include "support/expect_error.h"
#include "support/results_folder.h"
#include "support/table_cells.h"

namespace soslam {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// Eight observations of two objects.
constexpr const char* kSequence = R"({"detections": [
  {"object": 1}, {"object": 1}, {"object": 2}, {"object": 1},
  {"object": 2}, {"object": 2}, {"object": 2}, {"object": 2}]})";

class TimingTableTest : public testing::Test {
 protected:
  // A variant made of these runs, of which `optimise-4` takes 4 s of wall and 4.5 s of CPU time.
  void Write(const std::string& variant, const std::vector<std::string>& runs,
             bool is_single_frame) {
    results_.WriteMetrics("room", variant, {{.id = 1}, {.id = 2}}, is_single_frame);
    results_.WriteStages("room", variant, runs);
    WriteBytes(results_.VariantFolder("room", variant) / "sequence.json", kSequence);
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

TEST_F(TimingTableTest, SingleFramesCountPerObservationFromEdgesToRefinement) {
  Write("InitPT", {"import-9", "edges-1", "initialise-2", "refine-5", "evaluate-9"}, true);
  const auto time = TimeOf("InitPT");
  ASSERT_TRUE(time);
  EXPECT_DOUBLE_EQ(time->wall_ms, 1e3 * (1 + 2 + 5) / 8);
  EXPECT_DOUBLE_EQ(time->cpu_ms, 1e3 * (1.5 + 2.5 + 5.5) / 8);
  EXPECT_EQ(time->observations, 1.0);
}

TEST_F(TimingTableTest, InitialisationFromAllFramesCountsPerObject) {
  Write("SVD", {"import-9", "initialise-2", "evaluate-9"}, false);
  const auto time = TimeOf("SVD");
  ASSERT_TRUE(time);
  EXPECT_DOUBLE_EQ(time->wall_ms, 1e3 * 2 / 2);
  EXPECT_EQ(time->observations, 4.0);
}

TEST_F(TimingTableTest, MapsCountTheBackEndPerObject) {
  Write("OursPT", {"edges-1", "initialise-2", "refine-5", "optimise-4", "evaluate-9"}, false);
  const auto time = TimeOf("OursPT");
  ASSERT_TRUE(time);
  EXPECT_DOUBLE_EQ(time->wall_ms, 1e3 * 4 / 2);
  EXPECT_DOUBLE_EQ(time->cpu_ms, 1e3 * 4.5 / 2);
}

TEST_F(TimingTableTest, MissingTimingIsNoValue) {
  Write("InitPT", {"initialise-2", "refine-5"}, true);
  std::filesystem::remove(results_.path() / "room/shared/refine-5/timing.json");
  EXPECT_FALSE(TimeOf("InitPT"));
  EXPECT_THAT(TimeTable(Read(), {}).rows, IsEmpty());
}

TEST_F(TimingTableTest, NoStagesOrNoSequenceNoTimes) {
  results_.WriteMetrics("room", "InitP", {{.id = 1}}, true);
  EXPECT_FALSE(TimeOf("InitP"));
  Write("InitP", {"initialise-2"}, true);
  std::filesystem::remove(results_.path() / "room/InitP/sequence.json");
  EXPECT_THAT(TimeTable(Read(), {}).rows, IsEmpty());
}

TEST_F(TimingTableTest, MeasuredAndPublishedTimesOnTheirMachines) {
  Write("InitP", {"initialise-2"}, true);
  Published published;
  published.times = {"A paper", "desk", "A laptop", {{"InitP", 5.8, 1.4, 1.0}}};
  const Table table = TimeTable(Read(), published);
  EXPECT_THAT(CellTexts(table),
              ElementsAre("room wall ms - - 250.0 - - - - - - - - - - - - - -",
                          "room CPU ms - - 312.5 - - - - - - - - - - - - - -",
                          "room observations - - 1.0 - - - - - - - - - - - - - -",
                          "desk published ms - - 5.8 ± 1.4 - - - - - - - - - - - - - -",
                          "desk published observations - - 1.0 - - - - - - - - - - - - - -"));
  EXPECT_EQ(table.notes.front(), "Measured on: A CPU, 4 cores, 2 threads.");
  EXPECT_EQ(table.notes.back(), "Published: A paper, on A laptop.");
}

TEST(CountObservations, CountsDetectionsAndTheirObjects) {
  const TemporaryFolder folder;
  WriteBytes(folder / "sequence.json", kSequence);
  const SequenceCounts counts = CountObservations(folder / "sequence.json");
  EXPECT_EQ(counts.observations, 8);
  EXPECT_EQ(counts.objects, 2);
}

TEST(CountObservations, RefusesASequenceWithoutDetectionsByName) {
  const TemporaryFolder folder;
  WriteBytes(folder / "sequence.json", R"({"frames": []})");
  ExpectError<InputError>([&] { CountObservations(folder / "sequence.json"); },
                          {"sequence.json", "detections"});
}

}  // namespace
}  // namespace soslam
