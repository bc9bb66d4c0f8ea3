// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/soslam_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/dataset/calibration_file.h"
#include "soslam/dataset/text_file.h"
#include "soslam/geometry/image_size.h"

namespace soslam {
namespace {

// The camera of a folder of images, from the options, otherwise from the camera file. ICL-NUIM's
// camera is converted to the one with y down that gives the same images. Throws SettingsError for
// invalid options; InputError naming the field.
Calibration ReadFolderCamera(const std::optional<std::filesystem::path>& camera_file,
                             const ImportOptions& options, std::vector<Finding>* findings) {
  const bool y_is_up = options.format == DatasetFormat::kIclNuim;
  if (!options.folder.camera.empty() && !options.folder.camera_file.empty()) {
    throw SettingsError("camera, camera_file: found both; expected one of them");
  }
  Calibration read;
  if (!camera_file) {
    constexpr const char* kExpected = "\"width height fx fy cx cy\", pixels";
    const std::string& text = options.folder.camera;
    const auto numbers = ParseNumbers(text);
    if (!numbers || numbers->size() != 6) RefuseSetting("camera", text, kExpected);
    const double width = (*numbers)[0], height = (*numbers)[1];
    const double fx = (*numbers)[2], fy = (*numbers)[3], cx = (*numbers)[4], cy = (*numbers)[5];
    if (!IsWholeImageSize(width, height) || !(fx > 0.0) || !(y_is_up ? fy < 0.0 : fy > 0.0)) {
      RefuseSetting("camera", text,
                    fmt::format("{}, fy {} 0", kExpected, y_is_up ? "below" : "above"));
    }
    read.camera.camera = {
        static_cast<int>(width), static_cast<int>(height), fx, std::abs(fy), cx, cy};
  } else if (y_is_up) {
    read.camera = ReadCamera(*camera_file, CameraYAxis::kUp);
  } else {
    read = ReadCameraFile(*camera_file, findings);
  }
  std::optional<Distortion>& distortion = read.camera.distortion;
  if (const std::string& text = options.folder.distortion; !text.empty()) {
    const auto numbers = ParseNumbers(text);
    distortion = numbers ? DistortionOfCoefficients(*numbers) : std::nullopt;
    if (!distortion) {
      RefuseSetting("distortion", text,
                    "\"k1 k2 p1 p2 k3\" as OpenCV has them, or 4, 8, 12 or 14 of its numbers");
    }
  }
  if (distortion == Distortion()) distortion.reset();
  if (distortion && y_is_up) {
    throw SettingsError(
        "distortion: found one for format icl_nuim; expected none, as its images "
        "are renders of a pinhole camera");
  }
  return read;
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
void RejectUntrackedBoxes(const std::vector<LabelledBox>& boxes,
                          const std::vector<ListedImage>& images, const LensCamera& camera,
                          Rejections* rejected) {
  if (boxes.empty()) return;
  std::vector<DetectionRow> rows = RowsWithoutObject(boxes, images);
  if (camera.distortion) {
    RejectionCounts beyond_lens_model;
    rows = Undistorted(std::move(rows), camera.camera, *camera.distortion, &beyond_lens_model);
  }
  for (const DetectionRow& row : rows) rejected->Add(row, RejectReason::kWithoutObjectId);
  rejected->counts[NameOf(RejectReason::kWithoutObjectId)] = static_cast<int>(boxes.size());
}

// Reports that `count` boxes were changed on reading: on stdout, and as a finding when more than a
// third.
void ReportCorrections(const DatasetFiles& files, int count, size_t boxes, Finding finding,
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
  DatasetContent content;
  const Calibration calibration = ReadFolderCamera(files.camera, options, &content.findings);
  const LensCamera& camera = calibration.camera;
  const ListedObjects given = files.objects ? ReadObjects(*files.objects) : ListedObjects();
  const std::vector<ListedObject>& listed = given.objects;
  FolderBoxes read = ReadFolderBoxes(folder, options, camera.camera, &files);
  std::ranges::move(read.findings, std::back_inserter(content.findings));
  content.rejected.counts = std::move(read.left_out);
  ReportCorrections(files, read.corrected["cut_to_image"], read.boxes.size(), kCut,
                    &content.findings);
  std::vector<LabelledBox> of_no_track;
  const std::vector<LabelledBox> boxes = SeparateUntrackedBoxes(
      std::move(read.boxes), listed, files.detections, &of_no_track, &content.findings);
  const auto images = ListImages(folder, files, options, boxes);
  content.class_names = std::move(read.class_names);
  if (!content.class_names.empty()) content.class_names_file = files.class_names;
  content.sequence.camera = camera.camera;
  content.sequence.image_distortion = camera.distortion;
  if (files.planes) content.sequence.planes = ReadPlanes(*files.planes);
  content.frames = ReadFolderFrames(folder, files, options, images, calibration.body_from_camera,
                                    &content.findings);
  const std::int64_t first_free_id =
      listed.empty() ? 0 : std::max(std::int64_t{0}, std::int64_t{listed.back().id} + 1);
  content.rows = RowsOfBoxes(boxes, files, images, first_free_id, &content.rejected.counts);
  content.has_object_ids = HaveObjectIds(boxes);
  if (content.has_object_ids) {
    ReportCorrections(files, UnifyLabels(listed, &content.rows), boxes.size(), kRelabelled,
                      &content.findings);
  }
  if (camera.distortion) {
    content.rows = Undistorted(std::move(content.rows), camera.camera, *camera.distortion,
                               &content.rejected.counts);
  }
  RejectUntrackedBoxes(of_no_track, images, camera, &content.rejected);
  for (const auto& [id, label, plane_id, truth] : listed) {
    if (truth) content.sequence.true_objects.push_back({id, label, *truth});
  }
  content.sequence.ignored = given.ignored;
  content.sequence.objects =
      ListObjects(files, listed, content.rows, content.sequence.planes, content.has_object_ids);
  content.has_true_poses = files.groundtruth.has_value();
  content.may_have_poses_of_body =
      !calibration.body_from_camera && options.folder.trajectory_format == TrajectoryFormat::kEuroc;
  content.files = files.All();
  return content;
}

}  // namespace soslam
