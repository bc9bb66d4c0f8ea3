// SPDX-License-Identifier: BSD-3-Clause
// The import of datasets as their publishers made them, where these are present. The expected
// counts are those of their READMEs, or were taken with a few lines of another language.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>
#include <vector>

#include "soslam/artefact/options_json.h"
#include "soslam/dataset/dataset_content.h"
#include "support/real_data.h"

namespace soslam {
namespace {

using nlohmann::json;

struct PublishedDataset {
  std::string name;
  size_t frames;
  std::ptrdiff_t static_cars;  // with ground truth
  size_t boxes_used;
  size_t boxes;
  const char* settings;  // JSON; empty: those of the project
};

void PrintTo(const PublishedDataset& dataset, std::ostream* stream) { *stream << dataset.name; }

// 2225 of fr2_desk's 2893 images have a pose, as motion capture has gaps. KITTI's README counts 263
// static cars in another way.
const std::vector<PublishedDataset> kPublishedDatasets = {
    {"fr2_desk", 2225, 0, 23969, 34331, ""},
    {"fr3_long_office", 2486, 0, 16566, 17225, ""},
    {"kitti_object", 23, 54, 54, 74,
     R"({"format": "kitti_object", "min_observations": 1, "labels": "car"})"},
    {"kitti_tracking", 4937, 265, 7459, 23298,
     R"({"format": "kitti_tracking", "min_observations": 1, "labels": "car", "max_truncation": 0,
         "max_occlusion": 0, "poses": "poses_orbslam3_stereo", "translation_scale": "1"})"},
    {"slam_synthetic", 300, 0, 949 + 6495, 949 + 6495, R"({"format": "slam_synthetic"})"}};

// The settings that the project has for a dataset.
json SettingsOfProject(const std::string& name) {
  std::ifstream file(SOSLAM_SOURCE_DIR "/pipelines/datasets/" + name + ".json");
  return json::parse(file).at("import");
}

class PublishedFilesTest : public testing::TestWithParam<PublishedDataset> {};

TEST_P(PublishedFilesTest, AllFramesAndBoxesAreRead) {
  const auto& [name, frames, static_cars, boxes_used, boxes, settings] = GetParam();
  const std::filesystem::path folder = RealDataset(name);
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  ImportOptions options;
  OptionsFromJson(*settings == '\0' ? SettingsOfProject(name) : json::parse(settings), name,
                  &options);
  options.border_px = 0.0;
  options.frame_stride = 1;
  options.min_score = 0.0;
  options.held_out = HeldOutFrames::kNone;
  const Sequence sequence = ImportDataset(folder, options);
  EXPECT_EQ(sequence.frames.size(), frames);
  const auto are_static_cars = [](const Object& object) {
    return object.label == "car" && object.is_static && object.ground_truth;
  };
  EXPECT_EQ(std::ranges::count_if(sequence.objects, are_static_cars), static_cars);
  EXPECT_EQ(sequence.detections.size(), boxes_used);
  size_t all = sequence.detections.size();
  for (const auto& [reason, count] : sequence.rejected_detections) all += count;
  EXPECT_EQ(all, boxes);
}

INSTANTIATE_TEST_SUITE_P(All, PublishedFilesTest, testing::ValuesIn(kPublishedDatasets),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace soslam
