// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "geometry/box.h"
#include "geometry/camera.h"
#include "geometry/distortion.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "geometry/rigid3.h"
#include "model/finding.h"
#include "model/image_orientation.h"
#include "model/rejected_detection.h"
#include "model/truth.h"

namespace soslam {

// One image with its pose. `id` is the 0-based row in the dataset's image list and is what files
// say; the position in Sequence::frames (frame_index) is contiguous and is what code uses.
// Frames of one recording, taken one after the other, form a segment; each segment has a world of
// its own.
struct Frame {
  int id = 0;
  double timestamp = 0.0;     // seconds, within its segment
  std::string image;          // path relative to the dataset folder; empty: there is no image
  Rigid3d world_from_camera;  // the pose estimate: odometry
  std::optional<Rigid3d>
      true_world_from_camera;  // ground truth; see ImportOptions for what else uses it
  int segment = 0;             // frames of a segment follow each other
  std::optional<Camera> camera = std::nullopt;  // where it is not Sequence::camera
  // Of what was detected in it, also if it is not used, one box for each object: nearest first.
  // Decided at import.
  std::vector<Box> boxes_in_view = {};
};

struct SupportPlane {
  int id = 0;
  Plane plane_in_world;
  // Of an estimated plane: what is known of its normal n without the boxes that it comes from, as a
  // cost half n^T information n (1 / rad^2). None: the plane is given, and exact. Estimated planes
  // of one normal are parallel.
  std::optional<Eigen::Matrix3d> attitude_information = std::nullopt;
};

// Object::plane_index where nobody has said yet what there is to stand on.
inline constexpr int kNoPlane = -1;

struct Object {
  int id = 0;
  std::string label;
  int plane_index = 0;  // into Sequence::planes: the plane it stands on; kNoPlane without planes
  std::optional<GroundTruth> ground_truth;
  // Otherwise it moves, or is not known to stand still: single frames can estimate it, but it has
  // no place in the map.
  bool is_static = true;
};

// A 2D box of one object in one frame. `plane_in_camera` is the object's support plane as that
// camera sees it; it means nothing in a sequence without planes.
struct Detection {
  int frame_index = 0;   // into Sequence::frames
  int object_index = 0;  // into Sequence::objects
  double score = 1.0;
  Box box;
  Plane plane_in_camera;
  // Left, top, right, bottom: the object may reach farther than this edge of its box, because the
  // image border or a nearer object cuts it off. Decided at import, for all that follows.
  std::array<bool, 4> is_bound{};
  // What may hide this one, see BoxesInFront: as many of Frame::boxes_in_view, but for that of its
  // own object where there is one among them. Decided at import.
  int nearer_in_view = 0;
  std::optional<int> own_in_view = std::nullopt;
  std::vector<Box> nearer_boxes = {};  // those beside, of files before version 1.6
  // Where the dataset says for each frame where the object is: exact, also while it moves.
  std::optional<Landmark> true_landmark_in_camera = std::nullopt;
  // Which of Sequence::true_objects it is of, where the dataset says so.
  std::optional<int> true_object_id = std::nullopt;
};

// A frame that no estimate may use, and what was detected there: to judge landmarks by. Boxes pass
// the same gates as detections; nobody says whose they are.
struct HeldOutFrame {
  struct LabelledBox {
    std::string label;
    double score = 1.0;
    Box box;
  };
  Frame frame;
  std::vector<LabelledBox> boxes;
};

// What every stage works on: one dataset, checked and gated. Detections are sorted by frame, then
// by object; frames, objects and planes by id.
struct Sequence {
  std::string name;
  Camera camera;
  // Whose the pose estimates are, "ORB-SLAM2" or "simulated", say; empty: nobody has said.
  std::string odometry_source = {};
  // Of the image files, whose frames have no cameras of their own; boxes are those of a camera
  // without it. None: the images are, too.
  std::optional<Distortion> image_distortion = std::nullopt;
  ImageOrientation image_orientation = ImageOrientation::kUpright;  // of cameras and boxes
  std::vector<Frame> frames;
  std::vector<SupportPlane> planes;  // empty: not known, nor is any detection's plane
  std::vector<Object> objects;
  std::vector<Detection> detections;
  std::vector<HeldOutFrame> held_out;              // by frame id; none of them in `frames`
  std::map<std::string, int> rejected_detections;  // reason -> how many
  // Those of them that are of a frame above, and have a place in its image.
  std::vector<RejectedDetection> rejected = {};
  std::vector<TrueObject> true_objects = {};       // by id
  std::vector<TruthInFrame> truth_in_frames = {};  // by frame, then by object
  std::vector<IgnoredThings> ignored = {};
  OdometryWorld odometry_world = OdometryWorld::kOfTruth;
  // What does not fit what it should be, of the data and of the stages so far.
  std::vector<Finding> findings = {};

  const Frame& FrameOf(const Detection& detection) const {
    return frames[static_cast<size_t>(detection.frame_index)];
  }
  const Object& ObjectOf(const Detection& detection) const {
    return objects[static_cast<size_t>(detection.object_index)];
  }
  const Camera& CameraOf(const Frame& frame) const { return frame.camera ? *frame.camera : camera; }
  const Camera& CameraOf(const Detection& detection) const { return CameraOf(FrameOf(detection)); }
};

// What becomes of a detection that a stage leaves out.
inline RejectedDetection Rejected(const Sequence& sequence, const Detection& detection,
                                  RejectingStage stage, std::string reason) {
  return {detection.frame_index, sequence.ObjectOf(detection).label, detection.score,
          detection.box,         detection.true_object_id,           stage,
          std::move(reason)};
}

// The exact landmark of a detection's object as its camera sees it: as its frame's labels say, or
// else the object's, seen from the true pose (or the estimated one, where there is no true pose).
// None without ground truth.
inline std::optional<Landmark> TrueLandmarkInCamera(const Sequence& sequence,
                                                    const Detection& detection) {
  if (detection.true_landmark_in_camera) return detection.true_landmark_in_camera;
  const auto& truth = sequence.ObjectOf(detection).ground_truth;
  if (!truth) return std::nullopt;
  const Frame& frame = sequence.FrameOf(detection);
  const Rigid3d world_from_camera = frame.true_world_from_camera.value_or(frame.world_from_camera);
  return Transform(world_from_camera.Inverse(), truth->landmark_in_world);
}

// How close to the image border (px) boxes come that passed the gates of import.
inline double SmallestDistanceToBorder(const Sequence& sequence) {
  double smallest = std::numeric_limits<double>::infinity();
  const auto add = [&](const Camera& camera, const Box& box) {
    smallest = std::min(smallest, DistanceToBorder(box, camera.width, camera.height));
  };
  for (const Detection& detection : sequence.detections) {
    add(sequence.CameraOf(detection), detection.box);
  }
  for (const HeldOutFrame& held_out : sequence.held_out) {
    for (const auto& labelled : held_out.boxes)
      add(sequence.CameraOf(held_out.frame), labelled.box);
  }
  return smallest;
}

// Indices into sequence.detections of each object's detections, in frame order.
inline std::vector<std::vector<int>> DetectionsByObject(const Sequence& sequence) {
  std::vector<std::vector<int>> by_object(sequence.objects.size());
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    by_object[static_cast<size_t>(sequence.detections[i].object_index)].push_back(
        static_cast<int>(i));
  }
  return by_object;
}

// `count` of an object's detections (all, if they are fewer), evenly over all from the first on.
inline std::vector<int> SpreadOver(const std::vector<int>& detections, size_t count) {
  const size_t n = std::min(count, detections.size());
  std::vector<int> chosen;
  for (size_t i = 0; i < n; ++i) chosen.push_back(detections[i * detections.size() / n]);
  return chosen;
}

}  // namespace soslam
