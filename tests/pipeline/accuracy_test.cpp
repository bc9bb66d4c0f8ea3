// SPDX-License-Identifier: BSD-3-Clause
// The sequence that comes with the project through all variants, beside what they reached when
// expected/room_a.json was written: cells of tables, and final costs of back ends. Init1-1 and
// Quadric have no yaw there: where bodies are as long as wide, or collapse to discs, rounding
// decides it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "soslam/artefact/json_file.h"
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

// Cells, and where metrics.json has them.
constexpr std::pair<const char*, const char*> kCells[] = {
    {"iou", "/summary/iou_mean"},
    {"rot_deg", "/summary/rotation_deg_mean"},
    {"yaw_deg", "/summary/yaw_error_deg_mean"},
    {"iou_first", "/first_observation/iou_mean"},
    {"rot_first_deg", "/first_observation/rotation_deg_mean"},
    {"ate_m", "/trajectory/ate_rmse_m"},
    {"found_at_0.25", "/map_quality/scores/0/found"},
    {"found_at_0.5", "/map_quality/scores/1/found"},
    {"found_iou", "/map_quality/scores/0/of_found/iou_mean"},
    {"in_frames_iou", "/map_quality/in_frames/iou_mean"},
    {"found_yaw_deg", "/map_quality/scores/0/of_found/yaw_error_deg_mean"}};

json Cells(const std::filesystem::path& variant) {
  const json metrics = ParseJsonFile(variant / "metrics.json");
  json cells;
  for (const auto& [name, place] : kCells) {
    const json cell = metrics.value(json::json_pointer(place), json());
    if (!cell.is_null()) cells[name] = cell;
  }
  const auto map = variant / "map.json";
  if (std::filesystem::exists(map)) {
    cells["cost"] = ParseJsonFile(map)["solver"]["final_cost"];
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
  ExpectSuccess(
      RunMake({"-C", SOSLAM_SOURCE_DIR, "run-built", "BUILD=" + build.string(), "DATASET=room_a",
               "DATA_ROOT=data", "RESULTS=" + folder.path().string(), "VARIANT=all"}));
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
