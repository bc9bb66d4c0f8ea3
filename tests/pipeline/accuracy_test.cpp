// SPDX-License-Identifier: BSD-3-Clause
// The sequence that comes with the project through all variants, beside what they reached when
// expected/room_a.json was written: cells of tables, and final costs of back ends. Init1-1 and
// Quadric have no yaw there: where bodies are as long as wide, or collapse to discs, rounding
// decides it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "artefact/json_file.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

using nlohmann::json;

// How far a cell may move: IoU, degrees, metres.
constexpr double kIouTolerance = 0.01;
constexpr double kAngleToleranceDeg = 1.0;
constexpr double kDistanceToleranceM = 0.001;
// How much higher a final cost may be, as a share.
constexpr double kCostTolerance = 1e-4;

// Adds a cell where there is a value.
void Put(const std::string& name, const json& value, json* cells) {
  if (!value.is_null()) (*cells)[name] = value;
}

json Cells(const std::filesystem::path& variant) {
  const json metrics = ParseJsonFile(variant / "metrics.json");
  json cells;
  Put("iou", metrics["summary"]["iou_mean"], &cells);
  Put("rot_deg", metrics["summary"]["rotation_deg_mean"], &cells);
  Put("yaw_deg", metrics["summary"]["yaw_error_deg_mean"], &cells);
  if (!metrics["first_observation"].is_null()) {
    Put("iou_first", metrics["first_observation"]["iou_mean"], &cells);
    Put("rot_first_deg", metrics["first_observation"]["rotation_deg_mean"], &cells);
  }
  if (!metrics["trajectory"].is_null()) {
    Put("ate_m", metrics["trajectory"]["ate_rmse_m"], &cells);
  }
  if (metrics.contains("map_quality")) {
    const json& quality = metrics["map_quality"];
    const json& found = quality["scores"][0]["of_found"];
    Put("found_at_0.25", quality["scores"][0]["found"], &cells);
    Put("found_at_0.5", quality["scores"][1]["found"], &cells);
    Put("found_iou", found["iou_mean"], &cells);
    Put("in_frames_iou", quality["in_frames"]["iou_mean"], &cells);
    Put("found_yaw_deg", found["yaw_error_deg_mean"], &cells);
  }
  const auto map = variant / "map.json";
  if (std::filesystem::exists(map)) {
    Put("cost", ParseJsonFile(map)["solver"]["final_cost"], &cells);
  }
  return cells;
}

void ExpectNear(const std::string& name, double expected, double cell) {
  if (name == "cost") {
    EXPECT_LE(cell, expected * (1.0 + kCostTolerance));
  } else if (name.ends_with("_deg")) {
    EXPECT_NEAR(cell, expected, kAngleToleranceDeg);
  } else if (name.ends_with("_m")) {
    EXPECT_NEAR(cell, expected, kDistanceToleranceM);
  } else if (name.starts_with("found_at")) {
    EXPECT_EQ(cell, expected);
  } else {
    EXPECT_NEAR(cell, expected, kIouTolerance);
  }
}

TEST(AccuracyTest, TablesOfRoomAStayWhereTheyAre) {
  const json expected = ParseJsonFile(SOSLAM_SOURCE_DIR "/tests/pipeline/expected/room_a.json");
  const TemporaryFolder folder;
  const auto build = std::filesystem::path(SOSLAM_BINARY_DIR).parent_path();
  const CommandResult run =
      RunMake({"-C", SOSLAM_SOURCE_DIR, "run-built", "BUILD=" + build.string(), "DATASET=room_a",
               "DATA_ROOT=data", "RESULTS=" + folder.path().string(), "VARIANT=all"});
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const auto& [variant, cells] : expected.items()) {
    const json found = Cells(folder / "room_a" / variant);
    SCOPED_TRACE(fmt::format("{}: {}", variant, found.dump()));
    for (const auto& [name, cell] : cells.items()) {
      SCOPED_TRACE(name);
      ASSERT_TRUE(found.contains(name));
      ExpectNear(name, cell.get<double>(), found[name].get<double>());
    }
  }
}

}  // namespace
}  // namespace soslam
