// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <optional>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/kitti_label.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr int kIdsPerFrame = 1000;
constexpr int kMaxFrame = 1000000;

}  // namespace

DatasetContent ReadKittiObject(const fs::path& folder, const ImportOptions& options) {
  const RecordingValues image_size("image_size", options.kitti.image_size);
  DatasetContent content;
  for (const auto& [number, label_file] : NumberedFiles(folder / "label_2", ".txt")) {
    const fs::path calibration_file = RequiredFile(folder / "calib" / label_file.filename());
    content.files.insert(content.files.end(), {label_file, calibration_file});
    const KittiCalibration calibration = ReadKittiCalibration(calibration_file);
    const std::vector<KittiLabel> labels = ReadKittiLabels(label_file, /*has_tracks=*/false);
    if (labels.size() > kIdsPerFrame) {
      throw InputError(fmt::format("{}: has {} labels; expected at most {}", label_file.string(),
                                   labels.size(), kIdsPerFrame));
    }
    if (number < 0 || number > kMaxFrame) {
      throw InputError(fmt::format("{}: file name is {}; expected a number from 0 to {}",
                                   label_file.string(), number, kMaxFrame));
    }
    Frame frame;
    frame.id = number;
    frame.segment = number;
    const fs::path image = fs::path("image_2") / (label_file.stem().string() + ".png");
    std::optional<fs::path> image_file;
    if (Exists(ImagePath(folder, image.string(), label_file.string()))) {
      frame.image = image.string();
      image_file = folder / image;
    }
    const Camera camera = WithImageSize(calibration.camera, image_file, options.image_orientation,
                                        image_size, frame.id);
    for (const KittiLabel& label : labels) {
      DetectionRow row = RowOfLabel(label, label.box, label.score, calibration, camera);
      row.frame_id = frame.id;
      row.object_id = frame.id * kIdsPerFrame + label.track;
      Object object{row.object_id, row.label, kNoPlane, GroundTruth()};
      object.ground_truth->landmark_in_world = *row.true_landmark_in_camera;
      AddLabelledObject(std::move(object), frame.id, &content.sequence);
      content.rows.push_back(std::move(row));
    }
    content.AddFrame(std::move(frame), camera);
  }
  return content;
}

}  // namespace soslam
