// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/distortion.h"
#include "soslam/geometry/image_size.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/model/appearance.h"
#include "soslam/model/edits.h"
#include "soslam/model/finding.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

// Labels of things that move by themselves, as the default of options named moving_labels. Vehicles
// are not among them: most are parked.
inline constexpr const char* kMovingLabels =
    "person, pedestrian, cyclist, dog, cat, bird, horse, sheep, cow";

// Exact values of an object, for evaluation and as a prior where a setting asks for it. For a
// moving object, the landmark at its first observation.
struct GroundTruth {
  Landmark landmark_in_world;
  bool mirror_symmetric = true;
  bool mirror_symmetric_yz = false;
  bool rotationally_symmetric = false;

  // False where its x axis cannot be a front: front and back look alike, or it does not stand.
  bool MayHaveFront() const {
    return !rotationally_symmetric && !mirror_symmetric_yz &&
           landmark_in_world.rests_on == RestingFace::kBottom;
  }
};

// An object known to exist in the scene, independent of detections and of their assignment to
// objects.
struct TrueObject {
  int id = 0;
  std::string label;
  GroundTruth truth;
  int segment = 0;        // segment whose world the landmark is in
  bool is_static = true;  // false: it has no place in a map
  // True if its label is not among those requested at import: a landmark of it is neither right nor
  // wrong, and a missing one is not a miss.
  bool is_ignored = false;

  bool IsWanted() const { return is_static && !is_ignored; }
};

// Exact pose of an object in one frame, also while it moves.
struct TruthInFrame {
  int frame_index = 0;     // index in Sequence::frames
  int true_object_id = 0;  // id in Sequence::true_objects
  Landmark landmark_in_camera;
};

// Objects that exist but were not measured: a landmark of them is neither right nor wrong.
struct IgnoredThings {
  std::optional<std::string> label;         // none: any label
  std::optional<Landmark> volume_in_world;  // none: anywhere
};

// World frame of the odometry, as the dataset's settings give it.
enum class OdometryWorld {
  kOfTruth,       // the frame of the true poses and objects, unless the data contradict
  kOwn,           // another frame, in metres
  kOwnWithScale,  // another frame, of any unit
};
inline constexpr std::array kOdometryWorldNames = {"of_truth", "own", "own_with_scale"};
inline constexpr const auto& NamesOf(OdometryWorld) { return kOdometryWorldNames; }

// Stages that reject detections.
enum class RejectingStage { kImport, kAssociate, kPlanes };
inline constexpr std::array kRejectingStageNames = {"import", "associate", "planes"};
inline constexpr const auto& NamesOf(RejectingStage) { return kRejectingStageNames; }

// A detection that is not used.
struct RejectedDetection {
  int frame_index = 0;  // index in Sequence::frames
  std::string label;
  double score = 1.0;
  Box box;
  std::optional<int> true_object_id = std::nullopt;  // see Detection::true_object_id
  RejectingStage stage = RejectingStage::kImport;
  std::string reason;
};

// One image with its pose. `id` is the 0-based row in the dataset's image list and is used in
// files; the position in Sequence::frames (frame_index) is contiguous and is used in code.
// Consecutive frames of one recording form a segment; each segment has its own world.
struct Frame {
  int id = 0;
  double timestamp = 0.0;     // seconds, within its segment
  std::string image;          // path relative to the dataset folder; empty: there is no image
  Rigid3d world_from_camera;  // the pose estimate: odometry
  std::optional<Rigid3d>
      true_world_from_camera;  // ground truth; see ImportOptions for what else uses it
  int segment = 0;             // frames of a segment are consecutive
  std::optional<Camera> camera = std::nullopt;  // set where it differs from Sequence::camera
  // Boxes of all detections in the frame, used or not, one per object, nearest first. Computed at
  // import.
  std::vector<Box> boxes_in_view = {};
};

// Height of a plane at a point, zero with this standard deviation.
struct HeightPrior {
  Eigen::Vector3d point_in_world;
  double sigma_m;
};

struct SupportPlane {
  int id = 0;
  Plane plane_in_world;
  // Information (1 / rad^2) on the normal n of an estimated plane from camera attitudes alone, as a
  // cost 0.5 n^T information n. None: the plane is given and exact. Estimated planes of one normal
  // are parallel.
  std::optional<Eigen::Matrix3d> attitude_information = std::nullopt;
  // Prior on the height of an estimated plane from other evidence than boxes.
  std::optional<HeightPrior> height_prior = std::nullopt;
  // Unit vector in the plane along which, modulo quarter turns, most straight edges of the scene
  // lie. None: unknown, or there is no such direction.
  std::optional<Eigen::Vector3d> scene_axis_in_world = std::nullopt;
};

// Up and horizontal planes of a world by its points and photos, without the objects in it.
struct PointGround {
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();
  // On up (1 / rad^2), as SupportPlane::attitude_information.
  Eigen::Matrix3d up_information = Eigen::Matrix3d::Zero();
  std::vector<HeightPrior> planes = {};  // horizontal ones
};

// Object::plane_index while the support plane is unknown.
inline constexpr int kNoPlane = -1;

struct LabelProbability {
  std::string label;
  double probability;
};

struct Object {
  int id = 0;
  std::string label;    // the most probable one
  int plane_index = 0;  // index in Sequence::planes of its support plane, or kNoPlane
  std::optional<GroundTruth> ground_truth;
  // False: it moves or is not known to be static; single frames can estimate it, but it has no
  // place in the map.
  bool is_static = true;
  // Alternatives where the label is uncertain, most probable first; empty: it is certain.
  std::vector<LabelProbability> labels = {};
  KnownSize known_size = {};  // what a person measured
};

// A 2D box of one object in one frame. `plane_in_camera` is the object's support plane in that
// camera's frame; undefined where that is unknown.
struct Detection {
  int frame_index = 0;   // index in Sequence::frames
  int object_index = 0;  // index in Sequence::objects
  double score = 1.0;
  Box box;
  Plane plane_in_camera;
  // True for an edge (left, top, right, bottom) beyond which the object may extend, because the
  // image border or a nearer object cuts it off. Computed at import.
  std::array<bool, 4> is_one_sided{};
  // Possible occluders, see BoxesInFront: the first `nearer_in_view` of Frame::boxes_in_view,
  // except `own_in_view`, the box of the object itself, if it is among them. Computed at import.
  int nearer_in_view = 0;
  std::optional<int> own_in_view = std::nullopt;
  // Exact object pose in this frame, also while it moves; where the dataset has it per frame.
  std::optional<Landmark> true_landmark_in_camera = std::nullopt;
  // Id of the object in Sequence::true_objects, where the dataset gives it.
  std::optional<int> true_object_id = std::nullopt;
  // The picture's evidence, where a stage uses it (AddAppearance). Not stored with the sequence.
  std::shared_ptr<const BoxAppearance> appearance = nullptr;
};

// A frame withheld from all estimates, with its detections, to evaluate landmarks. Its boxes pass
// the same gates as detections but are not assigned to objects.
struct HeldOutFrame {
  struct LabelledBox {
    std::string label;
    double score = 1.0;
    Box box;
  };
  Frame frame;
  std::vector<LabelledBox> boxes;
};

// The data that every stage works on: one dataset, checked and gated. Detections are sorted by
// frame, then by object; frames, objects and planes by id.
struct Sequence {
  std::string name;
  Camera camera;
  // Origin of the pose estimates, such as "ORB-SLAM2" or "simulated"; empty: unknown.
  std::string odometry_source = {};
  // Distortion of the image files, when no frame has a camera of its own; boxes are always
  // undistorted. None: the images are undistorted, too.
  std::optional<Distortion> image_distortion = std::nullopt;
  // Orientation that cameras and boxes refer to.
  ImageOrientation image_orientation = ImageOrientation::kUpright;
  std::vector<Frame> frames;
  std::vector<SupportPlane> planes;                  // empty: unknown
  std::optional<PointGround> ground = std::nullopt;  // none: points are not known, or not asked
  std::vector<Object> objects;  // all detected ones have a support plane, or none has
  std::vector<Detection> detections;
  std::vector<HeldOutFrame> held_out;              // sorted by frame id; none of them in `frames`
  std::map<std::string, int> rejected_detections;  // reason -> number of detections
  // Rejected detections that belong to a frame above and have a place in its image.
  std::vector<RejectedDetection> rejected = {};
  std::vector<TrueObject> true_objects = {};       // sorted by id
  std::vector<TruthInFrame> truth_in_frames = {};  // sorted by frame, then by object
  std::vector<IgnoredThings> ignored = {};
  OdometryWorld odometry_world = OdometryWorld::kOfTruth;
  // Labels of things that move (ImportOptions).
  std::string moving_labels = kMovingLabels;
  // Images to which the reconstruction of the poses gave none, by name.
  std::vector<std::string> images_without_pose = {};
  // Findings on the data and on the stages so far.
  std::vector<Finding> findings = {};
  std::optional<AppliedEdits> edits = std::nullopt;  // none: nobody corrected the association

  const Frame& FrameOf(const Detection& detection) const { return frames[detection.frame_index]; }
  const Object& ObjectOf(const Detection& detection) const {
    return objects[detection.object_index];
  }
  // True if it is known on which plane each object stands.
  bool HasSupports() const {
    return !planes.empty() &&
           (detections.empty() || ObjectOf(detections.front()).plane_index != kNoPlane);
  }
  const Camera& CameraOf(const Frame& frame) const { return frame.camera ? *frame.camera : camera; }
  const Camera& CameraOf(const Detection& detection) const { return CameraOf(FrameOf(detection)); }
};

// True if the lengths of a sequence without a world.json are in metres.
inline bool IsInMetresWithoutWorld(const Sequence& sequence) {
  return sequence.odometry_world != OdometryWorld::kOwnWithScale;
}

// The estimated pose of each frame: odometry.
inline std::vector<Rigid3d> PosesOf(const Sequence& sequence) {
  std::vector<Rigid3d> world_from_camera;
  for (const Frame& frame : sequence.frames) world_from_camera.push_back(frame.world_from_camera);
  return world_from_camera;
}

inline std::vector<Plane> PlanesOf(const Sequence& sequence) {
  std::vector<Plane> planes_in_world;
  for (const SupportPlane& plane : sequence.planes) planes_in_world.push_back(plane.plane_in_world);
  return planes_in_world;
}

// Record of a detection that a stage rejects.
inline RejectedDetection Rejected(const Sequence& sequence, const Detection& detection,
                                  RejectingStage stage, std::string reason) {
  return {detection.frame_index, sequence.ObjectOf(detection).label, detection.score,
          detection.box,         detection.true_object_id,           stage,
          std::move(reason)};
}

// Exact landmark of a detection's object in the camera frame: from the labels of its frame, or else
// from the object's landmark in the world, seen from the true pose (the estimated one where there
// is no true pose). None without ground truth.
inline std::optional<Landmark> TrueLandmarkInCamera(const Sequence& sequence,
                                                    const Detection& detection) {
  if (detection.true_landmark_in_camera) return detection.true_landmark_in_camera;
  const auto& truth = sequence.ObjectOf(detection).ground_truth;
  if (!truth) return std::nullopt;
  const Frame& frame = sequence.FrameOf(detection);
  const Rigid3d world_from_camera = frame.true_world_from_camera.value_or(frame.world_from_camera);
  return Transform(world_from_camera.Inverse(), truth->landmark_in_world);
}

// Smallest distance (px) to the image border of all boxes that passed the gates of import.
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

// Indices in sequence.detections of each object's detections, in frame order.
inline std::vector<std::vector<int>> DetectionsByObject(const Sequence& sequence) {
  std::vector<std::vector<int>> by_object(sequence.objects.size());
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    by_object[sequence.detections[i].object_index].push_back(static_cast<int>(i));
  }
  return by_object;
}

// At most `count` of an object's detections, evenly spread, including the first.
inline std::vector<int> SpreadOver(const std::vector<int>& detections, size_t count) {
  const size_t n = std::min(count, detections.size());
  std::vector<int> chosen;
  for (size_t i = 0; i < n; ++i) chosen.push_back(detections[i * detections.size() / n]);
  return chosen;
}

}  // namespace soslam
