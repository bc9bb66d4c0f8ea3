// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/files.h"
#include "dataset/calibration_file.h"
#include "dataset/class_names.h"
#include "dataset/colmap_model.h"
#include "dataset/dataset_content.h"
#include "dataset/dataset_json.h"
#include "dataset/kitti_label.h"
#include "dataset/labelled_box.h"
#include "dataset/nerfstudio.h"
#include "dataset/trajectories.h"
#include "dataset/yolo_boxes.h"
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

const FuzzTarget kBoxArchives("box_archives", [](const HostileInput& input) {
  const auto archive = input.AsFile("boxes.zip");
  YoloTexts texts;
  if (!IsAccepted(archive, [&] { texts = ReadYoloTexts(archive); })) return;
  RejectionCounts mended;
  IsAccepted(archive, [&] { ReadNormalisedYoloBoxes(texts, {"cup", "chair"}, 640, 480, &mended); });
  IsAccepted(archive, [&] { ReadPixelYoloBoxes(texts, {"cup", "chair"}); });
});

const FuzzTarget kBoxJson("box_json", [](const HostileInput& input) {
  const auto file = input.AsFile("boxes.json");
  IsAccepted(file, [&] { ReadCocoResults(file); });
  IsAccepted(file, [&] { ReadOaSlamBoxes(file, {"cup", "chair"}); });
});

const FuzzTarget kCameras("cameras", [](const HostileInput& input) {
  for (const char* name : {"camera.json", "camera.yaml", "camera.xml", "cameras.txt"}) {
    const auto file = input.AsFile(name);
    IsAccepted(file, [&] { ReadCameraFile(file); });
  }
});

// A folder is a model as text, as the files of a folder end with a line.
const FuzzTarget kColmap("colmap", [](const HostileInput& input) {
  const auto folder = input.AsFolder();
  IsAccepted(folder, [&] { ReadColmapModel(folder); });
  const auto file = input.AsFile("model.bin");
  IsAccepted(file, [&] { ReadColmapCamera(file); });
  IsAccepted(file, [&] { ReadColmapPoses(file); });
  IsAccepted(file, [&] { ReadColmapPoints(file); });
});

const FuzzTarget kDatasetJson("dataset_json", [](const HostileInput& input) {
  const auto file = input.AsFile("dataset.json");
  IsAccepted(file, [&] { ReadCamera(file); });
  IsAccepted(file, [&] { ReadCamera(file, CameraYAxis::kUp); });
  IsAccepted(file, [&] { ReadPlanes(file); });
  IsAccepted(file, [&] { ReadObjects(file); });
});

const FuzzTarget kDetectionsCsv("detections_csv", [](const HostileInput& input) {
  const auto file = input.AsFile("detections.csv");
  IsAccepted(file, [&] { ReadDetectionsCsv(file); });
  IsAccepted(file, [&] { ReadLabelFile(file); });
  const auto yaml = input.AsFile("data.yaml");
  IsAccepted(yaml, [&] { ReadLabelFile(yaml); });
});

const FuzzTarget kKittiLabels("kitti_labels", [](const HostileInput& input) {
  const auto file = input.AsFile("000000.txt");
  IsAccepted(file, [&] { ReadKittiCalibration(file); });
  IsAccepted(file, [&] { ReadKittiTrackingLabels(file); });
  IsAccepted(file, [&] { ReadKittiObjectLabels(file); });
  IsAccepted(file, [&] { ReadKittiBoxes(file); });
});

const FuzzTarget kLists("lists", [](const HostileInput& input) {
  const auto file = input.AsFile("rgb.txt");
  IsAccepted(file, [&] { ReadImageList(file); });
  IsAccepted(file, [&] { ReadPairedImageList(file, PairOrder::kImageFirst); });
  IsAccepted(file, [&] { ReadPairedImageList(file, PairOrder::kImageSecond); });
});

const FuzzTarget kTrajectories("trajectories", [](const HostileInput& input) {
  const auto file = input.AsFile("trajectory.txt");
  IsAccepted(file, [&] { ReadTrajectory(file); });
  IsAccepted(file, [&] { ReadKittiTrajectory(file); });
  IsAccepted(file, [&] { ReadEurocTrajectory(file); });
  IsAccepted(file, [&] { ReadColmapPoses(file); });
  std::vector<Finding> findings;
  IsAccepted(file, [&] { ReadNerfstudioPoses(file, &findings); });
});

}  // namespace
}  // namespace soslam
