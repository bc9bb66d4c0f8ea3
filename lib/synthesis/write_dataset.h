// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string_view>

#include "synthesis/scene.h"

namespace soslam {

// Begin of the first line of a synthesised folder's README.md; the line states that the folder may
// be replaced.
inline constexpr std::string_view kSynthesisedMark = "<!-- Written by soslam-synthesise";

// A synthesised folder that appears completely or not at all: fill Temporary(), then Commit().
class DatasetFolder {
 public:
  // Creates the temporary folder beside `folder`. Throws SettingsError when `folder` is not a
  // folder, contains anything but an earlier synthesised dataset, or cannot be written.
  explicit DatasetFolder(const std::filesystem::path& folder);
  // Removes the temporary folder, or the one that it replaced.
  ~DatasetFolder();
  DatasetFolder(const DatasetFolder&) = delete;
  DatasetFolder& operator=(const DatasetFolder&) = delete;

  const std::filesystem::path& Temporary() const { return temporary_; }

  // Moves the temporary folder to the place of `folder`. Throws SettingsError when the disk
  // refuses, InputError as CheckInputsUnchanged.
  void Commit();

 private:
  void Replace();

  std::filesystem::path folder_;
  std::filesystem::path temporary_;
};

// Renders and simulates the scene into a dataset folder: rgb.txt, rgb/*.png, groundtruth.txt,
// odometry.txt, camera.json, planes.json, objects.json, detections.csv, boxes_exact.csv, and a
// README.md that explains them. Numbers are written so that they read back exactly. The same bytes
// for any number of threads. The folder appears whole or not at all; one that an earlier call wrote
// is replaced. Throws SettingsError when the folder holds anything else or cannot be written.
void WriteDataset(const Scene& scene, bool noise, const std::filesystem::path& folder, int threads);

}  // namespace soslam
