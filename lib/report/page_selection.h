// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <set>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// What of a sequence is on a page, which is to stay small however long the sequence is.
struct PageSelection {
  std::vector<int> frames;  // into Sequence::frames, ascending: the camera's way
  std::vector<int> shown;   // those of them whose pixels are shown, ascending
  std::vector<int>
      detections;  // into Sequence::detections, ascending: all in frames that are shown

  bool Shows(int frame_index) const;
  // Places in `frames` and `detections`, of what is in there.
  int PlaceOfFrame(int frame_index) const;
  int PlaceOfDetection(int detection_index) const;
};

// The ids of at most kMaxShownFrames frames, evenly over those with an image or, where there are no
// images, over all; of more than that only those in which something was detected count.
inline constexpr size_t kMaxShownFrames = 60;
std::set<int> FramesToShow(const Sequence& sequence,
                           const std::function<bool(int frame_index)>& has_image);

// Shows the frames of these ids; of the others as many as there are up to kMaxWayFrames, evenly
// over all.
inline constexpr size_t kMaxWayFrames = 1000;
PageSelection SelectForPage(const Sequence& sequence, const std::set<int>& shown_ids);

}  // namespace soslam
