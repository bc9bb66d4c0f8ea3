// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// The part of a sequence that is on a page, which must stay small however long the sequence is.
struct PageSelection {
  std::vector<int> frames;  // into Sequence::frames, ascending: the camera's path
  std::vector<int> shown;   // frames whose pixels are shown, ascending
  std::vector<int>
      detections;  // into Sequence::detections, ascending: all in frames that are shown

  bool Shows(int frame_index) const;
  // Positions in `frames` and `detections`, which must contain the argument.
  int PlaceOfFrame(int frame_index) const;
  int PlaceOfDetection(int detection_index) const;
};

// The ids of at most kMaxShownFrames frames, evenly spaced among those with an image or, if there
// are no images, among all; if these are too many, only those with detections are considered.
inline constexpr size_t kMaxShownFrames = 60;
std::set<int> FramesToShow(const Sequence& sequence,
                           const std::function<bool(int frame_index)>& has_image);

// Shows the frames with these ids. The camera's path has them, and up to kMaxWayFrames frames
// evenly spaced over all.
inline constexpr size_t kMaxWayFrames = 1000;
PageSelection SelectForPage(const Sequence& sequence, const std::set<int>& shown_ids);

// The data of a sequence on a page, whatever the method. Frames and detections are the selected
// ones, and indices refer to these lists:
//   counts: frames, objects, detections of the whole sequence
//   frames: id, timestamp, segment, width, height, pose (odometry) and true_pose or null, shown;
//     of those shown grid: see PageGridInFrame
//   objects: id, label, segment (null if unknown), plane (index or null), truth (landmark or null)
//   detections: frame and object (indices), box, truth (outline or null); the truth is the cuboid
//     around the object, with which estimates are compared
//   planes: see PageGrids
//   segments: up, a direction of the world
//   rejected: reason -> detections that were not used
nlohmann::json PageSequence(const Sequence& sequence, const PageSelection& selection);

}  // namespace soslam
