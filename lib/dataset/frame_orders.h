// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace soslam {

// An order that the frames of a file may have in place of that of the list of images.
struct FrameOrder {
  const char* name;  // "the poses are in reversed order"
  const char* cause;
  const char* remedy;
  std::vector<size_t> frame_meant;  // whose pose belongs to the boxes of a frame, by index
};

// The orders that people's files have been seen to have, but for the right one.
std::vector<FrameOrder> FrameOrders(size_t frames);

}  // namespace soslam
