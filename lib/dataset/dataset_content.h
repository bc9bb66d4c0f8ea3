// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "dataset/detection_row.h"
#include "dataset/gate.h"
#include "geometry/camera.h"
#include "model/finding.h"
#include "model/sequence.h"

namespace soslam {

struct ListedFrame {
  Frame frame;
  bool has_pose = true;  // false: frame.world_from_camera means nothing
};

// What the reader of a dataset's format finds there, before anything of it is left out.
struct DatasetContent {
  Camera camera;                     // of the frames that do not have one of their own
  std::vector<ListedFrame> frames;   // by ascending id, segment after segment
  std::vector<SupportPlane> planes;  // none: not known
  std::vector<Object> objects;
  std::vector<DetectionRow> rows;  // of these frames and objects
  Rejections rejected;             // by the reader
  bool has_true_poses = false;     // of some frames at least
  bool has_object_ids = true;      // otherwise each row is of an object of its own
  // Poses are those of the camera only if the body that they are of is the camera.
  bool may_have_poses_of_body = false;
  std::optional<Distortion> image_distortion = std::nullopt;  // see Sequence
  std::vector<std::filesystem::path> files;                   // that were read
  // Of the detector that numbers its classes, by class, and the file that has them; empty where
  // detections name their labels.
  std::vector<std::string> class_names = {};
  std::optional<std::filesystem::path> class_names_file = std::nullopt;
  std::vector<Finding> findings = {};  // of the files themselves
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
