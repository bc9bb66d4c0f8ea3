// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_selection.h"

#include <algorithm>
#include <numeric>

namespace soslam {
namespace {

int PlaceIn(const std::vector<int>& ascending, int value) {
  return static_cast<int>(std::ranges::lower_bound(ascending, value) - ascending.begin());
}

std::vector<int> AllFrames(const Sequence& sequence) {
  std::vector<int> frames(sequence.frames.size());
  std::iota(frames.begin(), frames.end(), 0);
  return frames;
}

}  // namespace

bool PageSelection::Shows(int frame_index) const {
  return std::ranges::binary_search(shown, frame_index);
}

int PageSelection::PlaceOfFrame(int frame_index) const { return PlaceIn(frames, frame_index); }

int PageSelection::PlaceOfDetection(int detection_index) const {
  return PlaceIn(detections, detection_index);
}

std::set<int> FramesToShow(const Sequence& sequence,
                           const std::function<bool(int frame_index)>& has_image) {
  std::vector<int> frames = AllFrames(sequence);
  if (std::ranges::any_of(frames, has_image)) std::erase_if(frames, std::not_fn(has_image));
  if (frames.size() > kMaxShownFrames) {
    std::set<int> with_detections;
    for (const Detection& detection : sequence.detections) {
      with_detections.insert(detection.frame_index);
    }
    std::erase_if(frames, [&](int frame) { return !with_detections.contains(frame); });
  }
  std::set<int> ids;
  for (const int frame : SpreadOver(frames, kMaxShownFrames)) {
    ids.insert(sequence.frames[static_cast<size_t>(frame)].id);
  }
  return ids;
}

PageSelection SelectForPage(const Sequence& sequence, const std::set<int>& shown_ids) {
  PageSelection selection;
  const std::vector<int> all = AllFrames(sequence);
  std::ranges::copy_if(all, std::back_inserter(selection.shown), [&](int frame) {
    return shown_ids.contains(sequence.frames[static_cast<size_t>(frame)].id);
  });
  std::ranges::set_union(SpreadOver(all, kMaxWayFrames), selection.shown,
                         std::back_inserter(selection.frames));
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    if (selection.Shows(sequence.detections[i].frame_index)) {
      selection.detections.push_back(static_cast<int>(i));
    }
  }
  return selection;
}

}  // namespace soslam
