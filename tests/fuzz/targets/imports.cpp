// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/sequence_file.h"
#include "dataset/import.h"
#include "fuzz/fuzz_target.h"

namespace soslam {
namespace {

// What is imported can be written, and what is written can be read.
void Import(const HostileInput& input, const ImportOptions& options) {
  const auto folder = input.AsFolder();
  Sequence sequence;
  if (!IsAccepted(folder, [&] { sequence = ImportDataset(folder, options); })) return;
  const auto file = input.Output("sequence.json");
  WriteSequence(file, sequence, {});
  ReadSequence(file, PlaneNeed::kNotNeeded);
}

ImportOptions OfFormat(DatasetFormat format) {
  ImportOptions options;
  options.format = format;
  options.border_px = 0.0;
  options.min_observations = 1;
  return options;
}

ImportOptions OfDetections(DetectionsFormat format, const std::string& detections) {
  ImportOptions options = OfFormat(DatasetFormat::kSoslam);
  options.detections = detections;
  options.folder.detections_format = format;
  return options;
}

const FuzzTarget kSoslam("import_soslam", [](const HostileInput& input) {
  Import(input, OfFormat(DatasetFormat::kSoslam));
});
const FuzzTarget kTumRgbd("import_tum_rgbd", [](const HostileInput& input) {
  ImportOptions options = OfFormat(DatasetFormat::kTumRgbd);
  options.folder.align_odometry = true;
  Import(input, options);
});
const FuzzTarget kIclNuim("import_icl_nuim", [](const HostileInput& input) {
  Import(input, OfFormat(DatasetFormat::kIclNuim));
});
const FuzzTarget kKittiTracking("import_kitti_tracking", [](const HostileInput& input) {
  Import(input, OfFormat(DatasetFormat::kKittiTracking));
});
const FuzzTarget kKittiDetector("import_kitti_detector", [](const HostileInput& input) {
  ImportOptions options = OfFormat(DatasetFormat::kKittiTracking);
  options.detections = "detector";
  Import(input, options);
});
const FuzzTarget kKittiObject("import_kitti_object", [](const HostileInput& input) {
  Import(input, OfFormat(DatasetFormat::kKittiObject));
});
const FuzzTarget kSlamSynthetic("import_slam_synthetic", [](const HostileInput& input) {
  Import(input, OfFormat(DatasetFormat::kSlamSynthetic));
});
const FuzzTarget kYolo("import_yolo", [](const HostileInput& input) {
  Import(input, OfDetections(DetectionsFormat::kYolo, "boxes"));
});
const FuzzTarget kCoco("import_coco", [](const HostileInput& input) {
  ImportOptions options = OfDetections(DetectionsFormat::kCoco, "boxes.json");
  options.folder.class_names = "names.json";
  Import(input, options);
});
const FuzzTarget kNerfstudio("import_nerfstudio", [](const HostileInput& input) {
  ImportOptions options = OfFormat(DatasetFormat::kSoslam);
  options.folder.images = options.folder.odometry = options.folder.camera_file = "transforms.json";
  options.folder.trajectory_format = TrajectoryFormat::kNerfstudio;
  Import(input, options);
});
const FuzzTarget kKittiClasses("import_kitti_classes", [](const HostileInput& input) {
  Import(input, OfDetections(DetectionsFormat::kKitti, "boxes"));
});

}  // namespace
}  // namespace soslam
