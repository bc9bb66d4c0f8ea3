// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "synthesis/scene.h"

namespace soslam {

// Renders and simulates the scene into a dataset folder: rgb.txt, rgb/*.png, groundtruth.txt,
// odometry.txt, camera.json, planes.json, objects.json, detections.csv, boxes_exact.csv, and a
// README.md that explains them. Numbers are written so that they read back exactly. The same bytes
// for any number of threads. The folder appears whole or not at all; one that an earlier call wrote
// is replaced. Throws SettingsError when the folder holds anything else or cannot be written.
void WriteDataset(const Scene& scene, bool noise, const std::filesystem::path& folder, int threads);

}  // namespace soslam
