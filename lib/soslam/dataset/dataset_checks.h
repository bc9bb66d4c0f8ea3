// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/import_options.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/model/finding.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Input of the checks of a dataset: the content that its reader found, and the sequence left after
// the gates.
struct ImportView {
  const std::filesystem::path& folder;
  const ImportOptions& options;
  const DatasetContent& content;
  const Sequence& sequence;
};

// The likely cause of a finding, and what to do.
struct Advice {
  std::string cause;
  std::string remedy;
};

// Checks for common mistakes in datasets. They return their findings and throw nothing.

// Plausibility of the intrinsics: normalised, in millimetres, of another image size; and of the
// lens.
std::vector<Finding> CheckCamera(const ImportView& view);
// The camera's image size against the headers of the image files, and images with an EXIF rotation.
std::vector<Finding> CheckImages(const ImportView& view);
// Boxes in another convention or of another image size.
std::vector<Finding> CheckBoxes(const ImportView& view);
// Scores outside 0 to 1.
std::vector<Finding> CheckScores(const ImportView& view);
// Class numbers that count from 1 where the list of names counts from 0, or the reverse.
std::vector<Finding> CheckClassNumbers(const ImportView& view);

// Labels of the setting `labels` that nothing in the dataset has.
std::vector<Finding> CheckLabels(const ImportView& view);
// Blank lines between names, which count as classes for programs that identify names by line.
std::vector<Finding> CheckBlankLines(const ImportView& view);
// Gates that reject more than a third of the detections.
std::vector<Finding> CheckRejections(const ImportView& view);
// The trajectory against the true one: inverse, another world, another order of the quaternion.
std::vector<Finding> CheckTruth(const ImportView& view);
// The poses against the boxes: another pose convention, or mirrored boxes (kPoseConvention), frames
// in another order (kFrameOrder), poses of an IMU, poses of other times (CheckLag); or poses,
// frames or ids that contradict the boxes in another way (kBoxesAgainstPoses).
inline constexpr const char* kPoseConvention = "pose_convention";
inline constexpr const char* kFrameOrder = "frame_order";
inline constexpr const char* kPoseLag = "pose_lag";
inline constexpr const char* kRepeatedPoses = "repeated_poses";
inline constexpr const char* kBoxesAgainstPoses = "boxes_against_poses";
std::vector<Finding> CheckPoses(const ImportView& view);
// True if a frame has exactly the pose of that before in its segment.
bool RepeatsPose(const std::vector<ListedFrame>& frames, size_t i);
// Consecutive frames with exactly the same pose whose images or boxes move.
std::vector<Finding> CheckRepeatedPoses(const ImportView& view);
// True objects against the boxes with their ids, and against their planes: another world, ids
// counted from 1, full sizes instead of half axes; quaternions with qw first.
std::vector<Finding> CheckObjects(const ImportView& view);
std::vector<Finding> CheckObjectAxes(const ImportView& view);
// The support plane of most objects against cameras and objects.
std::vector<Finding> CheckPlanes(const ImportView& view);

// Time stamps of images against those of a trajectory, which is not empty.
std::vector<Finding> CheckTimestamps(const std::vector<ListedImage>& images,
                                     const std::vector<TimedPose>& trajectory,
                                     const std::string& trajectory_file, double max_difference_s);

// Viewing ray through the centre of a box.
struct TrackedRay {
  size_t frame = 0;  // index in DatasetContent::frames
  Eigen::Vector3d ray_in_camera;
  double half_diagonal_deg = 0.0;  // of the box
};

// An object seen in several boxes.
struct TrackedObject {
  std::optional<int> object_id;  // none: the only object with its label
  std::vector<TrackedRay> rays;
};

// Objects that are identified by object id or, without ids, by a label that occurs at most once per
// frame. Without boxes that the image cuts or below min_score, moving objects, and objects with
// fewer than four boxes.
std::vector<TrackedObject> TrackedObjects(const ImportView& view);

// Pose of a frame, by index in DatasetContent::frames; none where there is none.
using PoseOfFrame = std::function<std::optional<Rigid3d>(size_t frame)>;
// Pose of another frame in the list, if there is one of the same segment.
std::optional<Rigid3d> PoseOfOther(const ImportView& view, size_t frame, size_t other);

// Triangulates the point nearest to the rays of an object from these poses (least squares); none
// where the rays are too few or too parallel.
std::optional<Eigen::Vector3d> NearestPointInWorld(const std::vector<TrackedRay>& rays,
                                                   const PoseOfFrame& world_from_camera);

// Disagreement of poses and boxes: angles between rays and triangulated points.
struct RayError {
  double median_deg = 0.0;
  double median_share = 0.0;  // relative to the half diagonals of the boxes
  size_t rays = 0;            // of the objects with a triangulated point
  size_t objects = 0;         // with such a point
};
// Median error over all objects; none when no object can be triangulated.
std::optional<RayError> MedianRayError(const std::vector<TrackedObject>& objects,
                                       const PoseOfFrame& world_from_camera);
// True if an error is from about the same number of rays.
bool IsComparable(const std::optional<RayError>& error, const RayError& as_read);

// Poses that are a constant time late or early, of which the seconds and the images are measured,
// or frames that are counted from 1: rays meet clearly better from the poses of other times.
std::vector<Finding> CheckLag(const ImportView& view, const std::vector<TrackedObject>& objects,
                              const RayError& as_read);

// All checks of a dataset, including the findings of its reader; errors first.
std::vector<Finding> CheckDataset(const ImportView& view);

}  // namespace soslam
