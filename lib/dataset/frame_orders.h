// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

namespace soslam {

// A wrong frame order that a file may have compared with the image list.
struct FrameOrder {
  const char* name;  // "the poses are in reversed order"
  const char* cause;
  const char* remedy;
  // For each frame, the index of the frame whose pose belongs to its boxes.
  std::vector<size_t> frame_meant;
};

// The wrong orders that occur in practice.
std::vector<FrameOrder> FrameOrders(size_t frames);

}  // namespace soslam
