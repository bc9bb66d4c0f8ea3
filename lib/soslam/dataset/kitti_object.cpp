// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <optional>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/image_path.h"
#include "soslam/dataset/kitti_label.h"
#include "soslam/geometry/image_size.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr int kIdsPerFrame = 1000;
constexpr int kMaxFrame = 1000000;

Frame ReadFrame(const fs::path& folder, const NumberedPath& labels) {
  if (labels.number < 0 || labels.number > kMaxFrame) {
    throw InputError(fmt::format("{}: file name is {}; expected a number from 0 to {}",
                                 labels.path.string(), labels.number, kMaxFrame));
  }
  Frame frame;
  frame.id = labels.number;
  frame.segment = labels.number;
  const fs::path image = fs::path("image_2") / (labels.path.stem().string() + ".png");
  if (Exists(ImagePath(folder, image.string(), labels.path.string()))) {
    frame.image = image.string();
  }
  return frame;
}

void AddFrame(const fs::path& folder, const NumberedPath& label_file, ImageOrientation orientation,
              const RecordingValues& image_size, DatasetContent* content) {
  const fs::path calibration_file = RequiredFile(folder / "calib" / label_file.path.filename());
  content->files.insert(content->files.end(), {label_file.path, calibration_file});
  const KittiCalibration calibration = ReadKittiCalibration(calibration_file);
  const std::vector<KittiLabel> labels = ReadKittiLabels(label_file.path, /*has_tracks=*/false);
  if (labels.size() > kIdsPerFrame) {
    throw InputError(fmt::format("{}: has {} labels; expected at most {}", label_file.path.string(),
                                 labels.size(), kIdsPerFrame));
  }
  Frame frame = ReadFrame(folder, label_file);
  const auto image = frame.image.empty() ? std::nullopt : std::optional(folder / frame.image);
  const Camera camera = WithImageSize(calibration.camera, image, orientation, image_size, frame.id);
  if (content->frames.empty()) content->sequence.camera = camera;
  if (camera != content->sequence.camera) frame.camera = camera;
  for (const KittiLabel& label : labels) {
    DetectionRow row = RowOfLabel(label, label.box, label.score, calibration, camera);
    row.frame_id = frame.id;
    row.object_id = frame.id * kIdsPerFrame + label.track;
    Object object{row.object_id, row.label, kNoPlane, GroundTruth()};
    object.ground_truth->landmark_in_world = *row.true_landmark_in_camera;
    AddLabelledObject(std::move(object), frame.id, &content->sequence);
    content->rows.push_back(std::move(row));
  }
  content->frames.push_back({std::move(frame), true});
}

}  // namespace

DatasetContent ReadKittiObject(const fs::path& folder, const ImportOptions& options) {
  const RecordingValues image_size("image_size", options.kitti.image_size);
  DatasetContent content;
  for (const NumberedPath& labels : NumberedFiles(folder / "label_2", ".txt")) {
    AddFrame(folder, labels, options.image_orientation, image_size, &content);
  }
  return content;
}

}  // namespace soslam
