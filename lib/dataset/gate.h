// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "dataset/detection_row.h"
#include "dataset/import_options.h"
#include "geometry/camera.h"

namespace soslam {

// Why a detection is not used. Sequence::rejected_detections counts them by name.
enum class RejectReason {
  kFrameNotListed,      // its image is not in the dataset's list
  kFrameNotUsed,        // its image is skipped: first_frame, frame_stride
  kFrameWithoutImage,   // the dataset does not have its image, and images_only asks for it
  kFrameWithoutPose,    // no pose close in time for its image, or for its plane
  kOtherLabel,          // not one of `labels`
  kTruncated,           // more than max_truncation
  kOccluded,            // more than max_occlusion
  kLowScore,            // score below min_score
  kBeyondLensModel,     // a lens cannot have put the box where it is, says its distortion
  kEmptyBox,            // no width or no height
  kOutsideImage,        // no part of the box is in the image
  kLowBox,              // lower than min_box_height_px
  kNearBorder,          // an edge is closer to the image border than border_px, or beyond it
  kDuplicate,           // another box of the object in the frame has a higher score
  kTooFewObservations,  // the object has fewer than min_observations usable detections
  kWithoutObjectId,     // of no track, in a table that says of which object others are
  kMatchesNoLabel,      // no labelled box of its kind is where a detector found this one
};
const char* RejectReasonName(RejectReason reason);

using RejectionCounts = std::map<std::string, int>;

// Rows that are not used, and how many there are with those of which there is no row.
struct Rejections {
  struct RejectedRow {
    int frame_id;
    int object_id;
    std::string label;
    double score;
    Box box;
    RejectReason reason;
  };
  RejectionCounts counts;
  std::vector<RejectedRow> rows;

  void Add(const DetectionRow& row, RejectReason reason);
};

// "12 detections rejected: duplicate 2, near_border 10".
std::string DescribeRejections(const RejectionCounts& rejected);

// Whether what a rejected row shows is there all the same, and may hide other objects.
bool IsInView(RejectReason reason);

// Whether the label is one of the option `labels`, or that lists none.
bool IsWanted(const std::string& label, const ImportOptions& options);

// What is wrong with the row by itself, apart from its frame; none when it is usable.
std::optional<RejectReason> GateRow(const DetectionRow& row, const Camera& camera,
                                    const ImportOptions& options);

// Keeps one row of each object in each frame, the one with the highest score (the first of equals),
// sorted by frame, then object.
std::vector<DetectionRow> WithoutDuplicates(std::vector<DetectionRow> rows, Rejections* rejected);

// Drops all rows of objects that have fewer than `min_observations`.
std::vector<DetectionRow> WithEnoughObservations(std::vector<DetectionRow> rows,
                                                 int min_observations, Rejections* rejected);

}  // namespace soslam
