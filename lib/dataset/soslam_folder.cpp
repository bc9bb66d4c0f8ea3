// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/soslam_folder.h"

#include <fmt/format.h>

#include <cstdio>

#include "base/error.h"
#include "dataset/dataset_files.h"
#include "dataset/dataset_json.h"
#include "dataset/detections_csv.h"
#include "dataset/object_table.h"
#include "dataset/tum_list.h"

namespace soslam {
namespace {

std::vector<ListedFrame> ReadFrames(const DatasetFiles& files, const ImportOptions& options) {
  const auto images = ReadImageList(files.images);
  const auto trajectory = ReadTrajectory(files.trajectory);
  const auto truth =
      files.groundtruth ? ReadTrajectory(*files.groundtruth) : std::vector<TimedPose>();
  std::vector<ListedFrame> frames;
  for (const ListedImage& image : images) {
    const auto pose = NearestPose(trajectory, image.timestamp, options.max_time_difference_s);
    Frame frame;
    frame.id = static_cast<int>(frames.size());
    frame.timestamp = image.timestamp;
    frame.image = image.image;
    frame.world_from_camera = pose.value_or(Rigid3d());
    frame.true_world_from_camera =
        NearestPose(truth, image.timestamp, options.max_time_difference_s);
    frames.push_back({frame, pose.has_value()});
  }
  return frames;
}

void CheckFrames(const std::vector<DetectionRow>& rows, size_t frames) {
  for (const DetectionRow& row : rows) {
    if (row.frame_id >= 0 && row.frame_id < static_cast<int>(frames)) continue;
    throw InputError(fmt::format("{}: frame is {}; expected a row of rgb.txt, 0 to {}", row.place,
                                 row.frame_id, frames - 1));
  }
}

}  // namespace

DatasetContent ReadSoslamFolder(const std::filesystem::path& folder, const ImportOptions& options) {
  const DatasetFiles files = FindDatasetFiles(folder, options.trajectory);
  if (files.trajectory_is_fallback) {
    fmt::print(stderr, "warning: {}: no {}.txt; using {} as the trajectory\n", folder.string(),
               kTrajectorySourceNames[static_cast<int>(options.trajectory)],
               files.trajectory.filename().string());
  }
  DatasetContent content;
  content.camera = ReadCamera(files.camera);
  content.planes = ReadPlanes(files.planes);
  content.frames = ReadFrames(files, options);
  content.rows = ReadDetections(files.detections);
  CheckFrames(content.rows, content.frames.size());
  content.objects = ListObjects(files, content.rows, content.planes);
  content.has_true_poses = files.groundtruth.has_value();
  content.files = files.All();
  return content;
}

}  // namespace soslam
