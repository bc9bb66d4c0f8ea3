// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/gate.h"
#include "geometry/camera.h"
#include "model/finding.h"
#include "model/sequence.h"

namespace soslam {

struct ListedFrame {
  Frame frame;
  bool has_pose = true;  // false: frame.world_from_camera is undefined
};

// Content of a dataset as its reader finds it, before anything is left out.
struct DatasetContent {
  Camera camera;                     // of frames without a camera of their own
  std::vector<ListedFrame> frames;   // sorted by id, segment after segment
  std::vector<SupportPlane> planes;  // empty: unknown
  std::vector<Object> objects;
  std::vector<DetectionRow> rows;  // detections of these frames and objects
  Rejections rejected;             // rejections by the reader
  bool has_true_poses = false;     // at least some frames have a true pose
  bool has_object_ids = true;      // false: each row is a separate object
  // True if the poses may be those of another body than the camera.
  bool may_have_poses_of_body = false;
  std::optional<Distortion> image_distortion = std::nullopt;  // see Sequence
  std::vector<std::filesystem::path> files;                   // files that were read
  // Class names of a detector that outputs class numbers, in order, and the file that has them;
  // empty where detections have labels.
  std::vector<std::string> class_names = {};
  std::optional<std::filesystem::path> class_names_file = std::nullopt;
  std::vector<Finding> findings = {};  // findings on the files themselves
  std::vector<TrueObject> true_objects = {};
  struct LabelInFrame {
    int frame_id;
    int true_object_id;
    Landmark landmark_in_camera;
  };
  std::vector<LabelInFrame> labels_in_frames = {};
  std::vector<IgnoredThings> ignored = {};
};

}  // namespace soslam
