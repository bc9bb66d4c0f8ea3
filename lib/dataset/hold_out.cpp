// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/hold_out.h"

#include <utility>
#include <vector>

namespace soslam {
namespace {

// New place of a frame of the whole sequence.
struct Destination {
  bool is_held_out;
  size_t index;  // index in Sequence::held_out or Sequence::frames
};

// Elements of frames that are not held out, with new frame indices.
template <typename OfFrame>
std::vector<OfFrame> InKeptFrames(std::vector<OfFrame> all,
                                  const std::vector<Destination>& destinations) {
  std::vector<OfFrame> kept;
  for (OfFrame& one : all) {
    const auto [is_held_out, index] = destinations[static_cast<size_t>(one.frame_index)];
    if (is_held_out) continue;
    one.frame_index = static_cast<int>(index);
    kept.push_back(std::move(one));
  }
  return kept;
}

}  // namespace

Sequence HoldOutFrames(Sequence sequence, HeldOutFrames held_out) {
  if (held_out == HeldOutFrames::kNone) return sequence;
  const std::vector<Frame> frames = std::exchange(sequence.frames, {});
  std::vector<Destination> destinations;
  size_t place = 0;
  for (size_t i = 0; i < frames.size(); ++i) {
    place = i > 0 && frames[i].segment == frames[i - 1].segment ? place + 1 : 0;
    if (place % 2 == 1) {
      destinations.push_back({true, sequence.held_out.size()});
      sequence.held_out.push_back({frames[i], {}});
      sequence.held_out.back().frame.boxes_in_view.clear();
    } else {
      destinations.push_back({false, sequence.frames.size()});
      sequence.frames.push_back(frames[i]);
    }
  }
  for (Detection& detection : std::exchange(sequence.detections, {})) {
    const auto [is_held_out, index] = destinations[static_cast<size_t>(detection.frame_index)];
    if (is_held_out) {
      const std::string& label = sequence.ObjectOf(detection).label;
      sequence.held_out[index].boxes.push_back({label, detection.score, detection.box});
    } else {
      detection.frame_index = static_cast<int>(index);
      sequence.detections.push_back(std::move(detection));
    }
  }
  sequence.rejected = InKeptFrames(std::move(sequence.rejected), destinations);
  sequence.truth_in_frames = InKeptFrames(std::move(sequence.truth_in_frames), destinations);
  return sequence;
}

}  // namespace soslam
