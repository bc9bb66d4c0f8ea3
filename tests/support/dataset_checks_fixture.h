// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.h"
#include "dataset/import.h"
#include "geometry/angles.h"
#include "support/dataset_fixture.h"
#include "support/image_files.h"
#include "support/plausible_dataset.h"

namespace soslam {

inline Rigid3d TurnedAboutOpticalAxis(const Rigid3d& world_from_camera, double degrees) {
  const Eigen::AngleAxisd turn(degrees * kRadPerDeg, Eigen::Vector3d::UnitZ());
  return {world_from_camera.rotation * turn, world_from_camera.translation};
}

// A dataset that is right, in which each test makes one of the usual mistakes.
class DatasetChecksTest : public testing::Test {
 protected:
  DatasetChecksTest() { options.border_px = 0; }

  // The warnings, each as "check: in words".
  std::vector<std::string> Warnings() {
    dataset.Write(folder);
    std::vector<std::string> warnings;
    for (const Finding& finding : ImportDataset(folder, options).findings) {
      warnings.push_back(finding.check + ": " + InWords(finding));
    }
    return warnings;
  }

  // What import says when it refuses the dataset.
  std::string Refusal() {
    dataset.Write(folder);
    try {
      ImportDataset(folder, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  // Expects one warning, or a refusal, with these words.
  void ExpectWarning(const std::vector<std::string>& words) {
    const std::vector<std::string> warnings = Warnings();
    ASSERT_EQ(warnings.size(), 1u) << testing::PrintToString(warnings);
    for (const std::string& word : words) EXPECT_THAT(warnings[0], testing::HasSubstr(word));
  }
  void ExpectRefusal(const std::vector<std::string>& words) {
    const std::string refusal = Refusal();
    for (const std::string& word : words) EXPECT_THAT(refusal, testing::HasSubstr(word));
  }

  // Images that store width x height pixels.
  void WriteImages(int width, int height, int exif_orientation = 1) {
    std::filesystem::create_directories(folder / "rgb");
    const cv::Mat image(height, width, CV_8UC1, cv::Scalar(128));
    const std::string bytes = PngWithExif(EncodedImage(".png", image), ExifOf(exif_orientation),
                                          /*is_after_pixels=*/false);
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      std::ofstream(folder / fmt::format("rgb/{:06}.png", frame), std::ios::binary) << bytes;
    }
  }

  // Boxes in a file of COCO's results.
  void WriteCoco(const std::function<std::array<double, 4>(const Box&)>& numbers) {
    nlohmann::json results = nlohmann::json::array();
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      for (size_t ball = 0; ball < PlausibleDataset::Labels().size(); ++ball) {
        results.push_back({{"image_id", frame},
                           {"category_id", 62},
                           {"score", 0.9},
                           {"bbox", numbers(dataset.BoxOf(ball, frame))}});
      }
    }
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "boxes.json") << results.dump();
    options.detections = "boxes.json";
    options.folder.detections_format = DetectionsFormat::kCoco;
  }

  // Poses in EuRoC's format, by default those of the camera.
  void WriteEuroc(const std::function<Rigid3d(const Rigid3d&)>& written = std::identity()) {
    std::filesystem::create_directories(folder);
    std::ofstream file(folder / "data.csv");
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      const Rigid3d pose = written(dataset.WorldFromCamera(frame));
      const Eigen::Quaterniond& q = pose.rotation;
      file << fmt::format("{}00000000,{},{},{},{},{},{},{}\n", 1000 + 5 * frame,
                          pose.translation.x(), pose.translation.y(), pose.translation.z(), q.w(),
                          q.x(), q.y(), q.z());
    }
    options.folder.odometry = "data.csv";
    options.folder.trajectory_format = TrajectoryFormat::kEuroc;
  }

  void WriteColmap() {
    std::filesystem::create_directories(folder);
    std::ofstream file(folder / "images.txt");
    for (int frame = 0; frame < PlausibleDataset::kFrames; ++frame) {
      const Rigid3d pose = dataset.WorldFromCamera(frame).Inverse();
      const Eigen::Quaterniond& q = pose.rotation;
      file << fmt::format("{} {} {} {} {} {} {} {} 1 {:06}.png\n\n", frame + 1, q.w(), q.x(), q.y(),
                          q.z(), pose.translation.x(), pose.translation.y(), pose.translation.z(),
                          frame);
    }
    options.folder.odometry = "images.txt";
    options.folder.trajectory_format = TrajectoryFormat::kColmap;
  }

  PlausibleDataset dataset;
  ImportOptions options;
  std::filesystem::path folder = FreshTestFolder() / "small";
};

}  // namespace soslam
