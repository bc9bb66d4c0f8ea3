// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/soslam_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "dataset/dataset_files.h"
#include "dataset/dataset_json.h"
#include "dataset/folder_camera.h"
#include "dataset/folder_detections.h"
#include "dataset/folder_frames.h"
#include "dataset/object_ids.h"
#include "dataset/object_table.h"
#include "dataset/track_labels.h"

namespace soslam {
namespace {

int FirstFreeId(const std::vector<ListedObject>& objects) {
  int id = 0;
  for (const ListedObject& object : objects) id = std::max(id, object.id + 1);
  return id;
}

const Finding kCut = {"boxes_cut",
                      Severity::kWarning,
                      "reach a little beyond the image and are cut to it",
                      "boxes in the image",
                      "boxes of whole objects, or of images of another size",
                      "give boxes as fractions of the image that the camera takes"};
const Finding kRelabelled = {
    "labels_of_objects",
    Severity::kWarning,
    "have another label than their object has, and get that",
    "one label for each object",
    "ids that are of several things, or a detector that calls one thing by several names",
    "give each thing an id of its own, or no ids and estimated association"};

// Rejects boxes without a track. All are counted; rows are kept for boxes of listed images that
// have an undistorted counterpart.
void RejectBoxesOfNoTrack(const std::vector<LabelledBox>& boxes,
                          const std::vector<ListedImage>& images, const LensCamera& camera,
                          Rejections* rejected) {
  if (boxes.empty()) return;
  std::vector<DetectionRow> rows = RowsWithoutObject(boxes, images);
  if (camera.distortion) {
    RejectionCounts beyond_lens_model;
    rows = Undistorted(std::move(rows), camera.camera, *camera.distortion, &beyond_lens_model);
  }
  for (const DetectionRow& row : rows) rejected->Add(row, RejectReason::kWithoutObjectId);
  rejected->counts[RejectReasonName(RejectReason::kWithoutObjectId)] =
      static_cast<int>(boxes.size());
}

std::vector<TrueObject> TrueObjects(const std::vector<ListedObject>& listed) {
  std::vector<TrueObject> objects;
  for (const ListedObject& object : listed) {
    if (object.ground_truth) objects.push_back({object.id, object.label, *object.ground_truth});
  }
  return objects;
}

// Reports that `count` boxes were changed on reading: on stdout, and as a finding when more than a
// third.
void ReportMended(const DatasetFiles& files, int count, size_t boxes, Finding finding,
                  std::vector<Finding>* findings) {
  constexpr size_t kFewest = 10;
  if (count == 0) return;
  finding.found = fmt::format("{}: {} of {} boxes {}", files.detections.filename().string(), count,
                              boxes, finding.found);
  if (boxes < kFewest || 3 * static_cast<size_t>(count) <= boxes) {
    fmt::print("{}\n", finding.found);
  } else {
    findings->push_back(std::move(finding));
  }
}

}  // namespace

DatasetContent ReadSoslamFolder(const std::filesystem::path& folder, const ImportOptions& options) {
  DatasetFiles files = FindDatasetFiles(folder, options);
  if (files.trajectory_is_fallback) {
    fmt::print("{}: no {}.txt; using {} as the trajectory\n", folder.string(),
               kTrajectorySourceNames[static_cast<int>(options.trajectory)],
               files.trajectory.filename().string());
  }
  const Calibration calibration = ReadFolderCamera(files.camera, options);
  const LensCamera& camera = calibration.camera;
  const ListedObjects given = files.objects ? ReadObjects(*files.objects) : ListedObjects();
  const std::vector<ListedObject>& listed = given.objects;
  DatasetContent content;
  RejectionCounts corrected;
  FolderBoxes read = ReadFolderBoxes(folder, options, camera.camera, &files, &corrected);
  ReportMended(files, corrected["cut_to_image"], read.boxes.size(), kCut, &content.findings);
  std::vector<LabelledBox> of_no_track;
  const std::vector<LabelledBox> boxes = WithoutIdsOfNoTrack(
      std::move(read.boxes), listed, files.detections, &of_no_track, &content.findings);
  const auto images = ListImages(folder, files, options, boxes);
  content.class_names = std::move(read.class_names);
  if (!content.class_names.empty()) content.class_names_file = files.class_names;
  content.camera = camera.camera;
  content.image_distortion = camera.distortion;
  if (files.planes) content.planes = ReadPlanes(*files.planes);
  content.frames = ReadFolderFrames(folder, files, options, images, calibration.body_from_camera,
                                    &content.findings);
  content.rows = RowsOfBoxes(boxes, files, images, FirstFreeId(listed), &content.rejected.counts);
  content.has_object_ids = HaveObjectIds(boxes);
  if (content.has_object_ids) {
    ReportMended(files, UnifyLabels(listed, &content.rows), boxes.size(), kRelabelled,
                 &content.findings);
  }
  if (camera.distortion) {
    content.rows = Undistorted(std::move(content.rows), camera.camera, *camera.distortion,
                               &content.rejected.counts);
  }
  RejectBoxesOfNoTrack(of_no_track, images, camera, &content.rejected);
  content.true_objects = TrueObjects(listed);
  content.ignored = given.ignored;
  content.objects = ListObjects(files, listed, content.rows, content.planes);
  content.has_true_poses = files.groundtruth.has_value();
  content.may_have_poses_of_body =
      !calibration.body_from_camera && options.folder.trajectory_format == TrajectoryFormat::kEuroc;
  content.files = files.All();
  return content;
}

}  // namespace soslam
