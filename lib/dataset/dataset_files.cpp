// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/dataset_files.h"

#include <fmt/format.h>

#include "base/error.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

fs::path Required(const fs::path& path) {
  if (!fs::exists(path)) throw InputError(path.string() + ": is missing");
  return path;
}

std::optional<fs::path> IfPresent(const fs::path& path) {
  return fs::exists(path) ? std::optional(path) : std::nullopt;
}

}  // namespace

std::vector<fs::path> DatasetFiles::All() const {
  std::vector<fs::path> files = {images, camera, planes, detections, trajectory};
  if (groundtruth && *groundtruth != trajectory) files.push_back(*groundtruth);
  if (objects) files.push_back(*objects);
  return files;
}

DatasetFiles FindDatasetFiles(const fs::path& folder, TrajectorySource trajectory) {
  if (!fs::is_directory(folder)) {
    throw InputError(folder.string() + ": is not a folder; expected a dataset folder");
  }
  const auto odometry = IfPresent(folder / "odometry.txt");
  const auto groundtruth = IfPresent(folder / "groundtruth.txt");
  const bool wants_odometry = trajectory == TrajectorySource::kOdometry;
  const auto& wanted = wants_odometry ? odometry : groundtruth;
  const auto& other = wants_odometry ? groundtruth : odometry;
  if (!wanted && !other) {
    throw InputError(
        fmt::format("{}: has neither odometry.txt nor groundtruth.txt; expected a "
                    "trajectory",
                    folder.string()));
  }
  return {Required(folder / "rgb.txt"),
          Required(folder / "camera.json"),
          Required(folder / "planes.json"),
          Required(folder / "detections.csv"),
          wanted ? *wanted : *other,
          !wanted,
          groundtruth,
          IfPresent(folder / "objects.json")};
}

}  // namespace soslam
