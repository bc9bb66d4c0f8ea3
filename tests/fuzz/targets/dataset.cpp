// SPDX-License-Identifier: BSD-3-Clause
#include <nlohmann/json.hpp>

#include "fuzz/fuzz_target.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/options_json.h"
#include "soslam/dataset/calibration_file.h"
#include "soslam/dataset/class_names.h"
#include "soslam/dataset/colmap_model.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/dataset_json.h"
#include "soslam/dataset/kitti_label.h"
#include "soslam/dataset/labelled_box.h"
#include "soslam/dataset/nerfstudio.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/dataset/yolo_boxes.h"

namespace soslam {
namespace {

// An import with these settings. What is imported can be written, and what is written can be read.
FuzzTarget::Read Import(const char* settings) {
  return [=](const HostileInput& input) {
    ImportOptions options;
    options.border_px = 0.0;
    options.min_observations = 1;
    OptionsFromJson(nlohmann::json::parse(settings), "import", &options);
    const auto folder = input.AsFolder();
    Sequence sequence;
    if (!IsAccepted(folder, [&] { sequence = ImportDataset(folder, options); })) return;
    const auto file = input.Output("sequence.json");
    WriteSequence(file, sequence, {});
    ReadSequence(file, PlaneNeed::kNotNeeded);
  };
}

const FuzzTarget kImports[] = {
    {"import_soslam", Import("{}")},
    {"import_tum_rgbd", Import(R"({"format": "tum_rgbd", "align_odometry": true})")},
    {"import_icl_nuim", Import(R"({"format": "icl_nuim"})")},
    {"import_kitti_tracking", Import(R"({"format": "kitti_tracking"})")},
    {"import_kitti_detector", Import(R"({"format": "kitti_tracking", "detections": "detector"})")},
    {"import_kitti_object", Import(R"({"format": "kitti_object"})")},
    {"import_slam_synthetic", Import(R"({"format": "slam_synthetic"})")},
    {"import_yolo", Import(R"({"detections_format": "yolo", "detections": "boxes"})")},
    {"import_coco", Import(R"({"detections_format": "coco", "detections": "boxes.json",
                               "class_names": "names.json"})")},
    {"import_kitti_classes", Import(R"({"detections_format": "kitti", "detections": "boxes"})")},
    {"import_nerfstudio", Import(R"({"images": "transforms.json", "odometry": "transforms.json",
                "camera_file": "transforms.json", "trajectory_format": "nerfstudio"})")}};

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
    std::vector<Finding> findings;
    IsAccepted(file, [&] { ReadCameraFile(file, &findings); });
  }
});

// A folder is a model as text, as the files of a folder end with a line.
const FuzzTarget kColmap("colmap", [](const HostileInput& input) {
  ReadBy(input.AsFolder(), ReadColmapModel);
  const auto file = input.AsFile("model.bin");
  ReadBy(file, ReadColmapPoses, ReadColmapPoints);
  std::vector<Finding> findings;
  IsAccepted(file, [&] { ReadColmapCamera(file, &findings); });
});

const FuzzTarget kDatasetJson("dataset_json", [](const HostileInput& input) {
  const auto file = input.AsFile("dataset.json");
  IsAccepted(file, [&] { ReadCamera(file); });
  IsAccepted(file, [&] { ReadCamera(file, CameraYAxis::kUp); });
  ReadBy(file, ReadPlanes, ReadObjects);
});

const FuzzTarget kDetectionsCsv("detections_csv", [](const HostileInput& input) {
  ReadBy(input.AsFile("detections.csv"), ReadDetectionsCsv, ReadLabelFile);
  ReadBy(input.AsFile("data.yaml"), ReadLabelFile);
});

const FuzzTarget kKittiLabels("kitti_labels", [](const HostileInput& input) {
  const auto file = input.AsFile("000000.txt");
  ReadBy(file, ReadKittiCalibration, ReadKittiBoxes);
  for (const bool has_tracks : {true, false}) {
    IsAccepted(file, [&] { ReadKittiLabels(file, has_tracks); });
  }
});

const FuzzTarget kLists("lists", [](const HostileInput& input) {
  const auto file = input.AsFile("rgb.txt");
  IsAccepted(file, [&] { ReadImageList(file); });
  IsAccepted(file, [&] { ReadPairedImageList(file, PairOrder::kImageFirst); });
  IsAccepted(file, [&] { ReadPairedImageList(file, PairOrder::kImageSecond); });
});

const FuzzTarget kTrajectories("trajectories", [](const HostileInput& input) {
  const auto file = input.AsFile("trajectory.txt");
  ReadBy(file, ReadTrajectory, ReadKittiTrajectory, ReadEurocTrajectory, ReadColmapPoses);
  std::vector<Finding> findings;
  IsAccepted(file, [&] { ReadNerfstudioPoses(file, &findings); });
});

}  // namespace
}  // namespace soslam
