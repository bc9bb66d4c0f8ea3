// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "soslam/base/description.h"
#include "soslam/dataset/import_options.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/landmark.h"
#include "soslam/geometry/plane.h"
#include "soslam/image/image_format.h"
#include "soslam/model/sequence.h"

namespace soslam {

// DetectionRow::object_id of an unused row that belongs to no object; never a real id.
inline constexpr int kNoObject = std::numeric_limits<int>::min();

// A 2D box of one object in one frame, as in the dataset.
struct DetectionRow {
  std::string place;  // "<file>:<line>", for error messages
  int frame_id;
  int object_id;
  std::string label;
  double score;
  Box box;
  // Distorted box in the image file, in a dataset with distorted images.
  std::optional<Box> box_in_image_file = std::nullopt;
  // Size of its image, where the file of boxes states it.
  std::optional<ImageSize> image_size = std::nullopt;
  // The turned box in the image file that `box` is the upright one around, where the file has that.
  std::optional<TurnedBox> as_drawn = std::nullopt;
  // Further values from the dataset's labels, if any; geometry is in the camera frame.
  double truncation = 0.0;  // amount outside the image, in the dataset's own measure
  int occlusion = 0;        // occlusion level, in the dataset's own measure
  std::optional<Plane> plane_in_camera = std::nullopt;  // its support plane
  std::optional<Landmark> true_landmark_in_camera = std::nullopt;

  // The box as it was drawn in the image file.
  TurnedBox InImageFile() const {
    return as_drawn.value_or(TurnedBox{box_in_image_file.value_or(box)});
  }
};

// Reason why a detection is not used. Sequence::rejected_detections counts them by name.
enum class RejectReason {
  kFrameNotListed,      // its image is not in the dataset's list
  kFrameNotUsed,        // its image is skipped: first_frame, frame_stride
  kFrameWithoutImage,   // its image is missing, and images_only asks for it
  kFrameWithoutPose,    // no pose close in time for its image, or for its plane
  kOtherLabel,          // not one of `labels`
  kTruncated,           // more than max_truncation
  kOccluded,            // more than max_occlusion
  kLowScore,            // score below min_score
  kBeyondLensModel,     // the distortion model cannot produce a box at this place
  kEmptyBox,            // no width or no height
  kOutsideImage,        // no part of the box is in the image
  kLowBox,              // lower than min_box_height_px
  kNearBorder,          // an edge is closer to the image border than border_px, or beyond it
  kDuplicate,           // another box of the object in the frame has a higher score
  kTooFewObservations,  // the object has fewer than min_observations usable detections
  kWithoutObjectId,     // without track id, in a table with ids
  kMatchesNoLabel,      // no labelled box of its class overlaps the detector's box
  kCrowd,               // its annotation is of a crowd, or is to be ignored
  kOutOfView,           // its annotation says that the object is not in this image
};
inline constexpr std::array kRejectReasonNames = {
    "frame_not_listed",   "frame_not_used",   "frame_without_image",
    "frame_without_pose", "other_label",      "truncated",
    "occluded",           "low_score",        "beyond_lens_model",
    "empty_box",          "outside_image",    "low_box",
    "near_border",        "duplicate",        "too_few_observations",
    "without_object_id",  "matches_no_label", "crowd",
    "out_of_view"};
inline constexpr const auto& NamesOf(RejectReason) { return kRejectReasonNames; }

using RejectionCounts = std::map<std::string, int>;

// Rejected rows, and counts that also include rejected boxes without a row.
struct Rejections {
  RejectionCounts counts;
  std::vector<std::pair<DetectionRow, RejectReason>> rows;

  void Add(const DetectionRow& row, RejectReason reason);
};

// "12 detections rejected: 10 too near the image border, 2 repeating another one".
std::string DescribeRejections(const RejectionCounts& rejected);

// True if the object of a rejected row is still in view and may occlude others.
bool IsInView(RejectReason reason);

// Reason to reject the row itself, independent of its frame; none when it is usable.
std::optional<RejectReason> GateRow(const DetectionRow& row, const Camera& camera,
                                    const ImportOptions& options);

// Keeps one row per object and frame, the one with the highest score (the first of equals), sorted
// by frame, then object.
std::vector<DetectionRow> WithoutDuplicates(std::vector<DetectionRow> rows, Rejections* rejected);

// Marks edges of boxes that are one-sided (Detection::is_one_sided): edges cut by the image border,
// and lower edges occluded by nearer objects.

// True for the edges of a box (left, top, right, bottom) at the border of its image.
std::array<bool, 4> EdgesCutByBorder(const Box& box, const Camera& camera);

// Marks lower edges that BoxesInFront cover (hidden_edge_fraction).
void MarkHiddenEdges(double hidden_edge_fraction, Sequence* sequence);

// Moves the held-out frames and their detections to Sequence::held_out, where no estimate uses
// them. Positions of frames are counted from 0 in each segment.
Sequence HoldOutFrames(Sequence sequence, HeldOutFrames held_out);

}  // namespace soslam
