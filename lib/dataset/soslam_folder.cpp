// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/soslam_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

#include "dataset/dataset_files.h"
#include "dataset/dataset_json.h"
#include "dataset/folder_camera.h"
#include "dataset/folder_detections.h"
#include "dataset/folder_frames.h"
#include "dataset/object_table.h"

namespace soslam {
namespace {

int FirstFreeId(const std::vector<ListedObject>& objects) {
  int id = 0;
  for (const ListedObject& object : objects) id = std::max(id, object.id + 1);
  return id;
}

}  // namespace

DatasetContent ReadSoslamFolder(const std::filesystem::path& folder, const ImportOptions& options) {
  const DatasetFiles files = FindDatasetFiles(folder, options);
  if (files.trajectory_is_fallback) {
    fmt::print(stderr, "warning: {}: no {}.txt; using {} as the trajectory\n", folder.string(),
               kTrajectorySourceNames[static_cast<int>(options.trajectory)],
               files.trajectory.filename().string());
  }
  const FolderCamera camera = ReadFolderCamera(files.camera, options);
  const FolderBoxes boxes = ReadFolderBoxes(files, options, camera.camera);
  const auto images = ListImages(files, options, boxes.boxes);
  const auto listed = files.objects ? ReadObjects(*files.objects) : std::vector<ListedObject>();
  DatasetContent content;
  content.camera = camera.camera;
  content.image_distortion = camera.distortion;
  if (files.planes) content.planes = ReadPlanes(*files.planes);
  content.frames = ReadFolderFrames(folder, files, options, images, &content.findings);
  content.rows = RowsOfBoxes(boxes, files, images, FirstFreeId(listed), &content.rejected);
  content.has_object_ids = !boxes.object_ids.empty();
  if (camera.distortion) {
    content.rows =
        Undistorted(std::move(content.rows), camera.camera, *camera.distortion, &content.rejected);
  }
  content.objects = ListObjects(files, listed, content.rows, content.planes);
  content.has_true_poses = files.groundtruth.has_value();
  content.files = files.All();
  return content;
}

}  // namespace soslam
