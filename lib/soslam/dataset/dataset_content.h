// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "soslam/dataset/gate.h"
#include "soslam/dataset/import_options.h"
#include "soslam/model/finding.h"
#include "soslam/model/sequence.h"

namespace soslam {

struct ListedFrame {
  Frame frame;
  bool has_pose = true;  // false: frame.world_from_camera is undefined
  // Time stamp of the pose in its file, seconds; that of the frame where poses have none.
  std::optional<double> pose_timestamp = std::nullopt;

  std::optional<Rigid3d> Pose() const {
    return has_pose ? std::optional(frame.world_from_camera) : std::nullopt;
  }
};

// Content of a dataset as its reader finds it, before anything is left out.
struct DatasetContent {
  // Camera, distortion, planes, objects, true objects in any order, and ignored things alone.
  Sequence sequence;
  std::vector<ListedFrame> frames;  // sorted by id, segment after segment
  std::vector<DetectionRow> rows;   // detections of these frames and objects
  Rejections rejected;              // rejections by the reader
  bool has_true_poses = false;      // at least some frames have a true pose
  bool has_object_ids = true;       // false: each row is a separate object
  // True if the poses may be those of another body than the camera.
  bool may_have_poses_of_body = false;
  std::vector<std::filesystem::path> files;  // files that were read
  // Class names of a detector that outputs class numbers, in order, and the file that has them;
  // empty where detections have labels.
  std::vector<std::string> class_names = {};
  std::optional<std::filesystem::path> class_names_file = std::nullopt;
  std::vector<Finding> findings = {};  // findings on the files themselves
  struct LabelInFrame {
    int frame_id;
    int true_object_id;
    Landmark landmark_in_camera;
  };
  std::vector<LabelInFrame> labels_in_frames = {};

  // Adds a frame that has a pose. The camera of the first frame is that of the sequence.
  void AddFrame(Frame frame, const Camera& camera) {
    if (frames.empty()) sequence.camera = camera;
    if (camera != sequence.camera) frame.camera = camera;
    frames.push_back({std::move(frame), true});
  }
};

// Reads a folder of images: the project's own format, TUM RGB-D or ICL-NUIM. All three have a list
// of images, trajectories (pose estimates and true poses; at least one of the two), a camera and
// detections, in files and formats given by the options, and optionally planes.json and
// objects.json. Differences:
//
//   soslam    the listed images must exist when a stage reads them
//   tum_rgbd  images may be absent; lists may be pairs, colour images first
//   icl_nuim  like tum_rgbd, but depth images first; times are frame numbers; camera and world
//             have y up, and are mirrored (see FromIclNuim)
//
// Without planes.json no plane is known. Each detection without object id is a separate object.
// Ground truth, if present, is stored in the sequence for evaluation. Throws InputError,
// SettingsError.
DatasetContent ReadSoslamFolder(const std::filesystem::path& folder, const ImportOptions& options);

// Reads the tracking benchmark of KITTI, all recordings or those of the option `sequences`, as one
// dataset with a segment per recording (SSSS: its number):
//   label_02/SSSS.txt                 tracks with 2D and 3D boxes
//   calib/SSSS.txt                    P2
//   <poses>/SSSS.txt                  world_from_camera of each frame, format of KITTI's odometry
//   image_02/SSSS/FFFFFF.png          images, if present
//   <detector>/<type>/SSSS.txt        frame,x1,y1,x2,y2,score; only with option `detections`
// A frame's id is 10000 times its recording plus its own number; an object's id is 10000 times its
// recording plus its track. Each object has its own support plane with the object's id: the bottom
// face of its labelled box. Frames are 0.1 s apart. Throws InputError, SettingsError.
DatasetContent ReadKittiTracking(const std::filesystem::path& folder, const ImportOptions& options);

// Reads the object benchmark of KITTI: label_2/NNNNNN.txt, calib/NNNNNN.txt (P2) and, if present,
// image_2/NNNNNN.png. Frames are independent views, so each is its own segment with the camera's
// frame as its world. A frame's id is its number; an object's id is 1000 times that plus the index
// of its label. Each object has its own support plane with the object's id: the bottom face of its
// labelled box. Throws InputError, SettingsError.
DatasetContent ReadKittiObject(const std::filesystem::path& folder, const ImportOptions& options);

// Reads synthetic problems for back ends, one JSON file each, all or those of the option
// `sequences` ("K10N100 K40N200"), as one dataset with a segment per problem:
//   camera               width, height, fx, fy, cx, cy
//   support_plane_world  nx, ny, nz, d
//   objects              true ellipsoids: center, half (axes), yaw about the world's z axis
//   T_wc, init_T_wc      true poses and dead reckoning, world_from_camera, 4 x 4, per frame
//   boxes                frame, object, box [x1, y1, x2, y2]
// A frame's or object's id is 10000 times the index of its file, sorted by name, plus its own
// number; frames are 1 s apart, and all objects have the label "ellipsoid". Throws InputError with
// file and JSON pointer; SettingsError for a problem that does not exist.
DatasetContent ReadSlamSynthetic(const std::filesystem::path& folder, const ImportOptions& options);

// Reads a dataset folder in the format given by the options, checks it completely and drops the
// detections that the options exclude, each with a counted reason. The defaults follow the protocol
// of the paper's experiments. Frames without a pose estimate are left out.
//
// Formats: soslam, tum_rgbd, icl_nuim (ReadSoslamFolder), kitti_tracking (ReadKittiTracking),
// kitti_object (ReadKittiObject), slam_synthetic (ReadSlamSynthetic).
//
// `files_read`, if not null, becomes the list of the files that were read. Throws InputError,
// naming file and line or field, for data that are missing, malformed, contradictory or certainly
// wrong (see CheckDataset); SettingsError for invalid options; NothingUsableError when no detection
// is left.
Sequence ImportDataset(const std::filesystem::path& folder, const ImportOptions& options,
                       std::vector<std::filesystem::path>* files_read = nullptr);

}  // namespace soslam
