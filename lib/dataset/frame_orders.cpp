// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/frame_orders.h"

#include <algorithm>
#include <numeric>
#include <string>

namespace soslam {
namespace {

// Order of the frame numbers as strings: 0, 1, 10, 11, 2, ...
std::vector<size_t> OrderOfStrings(size_t frames) {
  std::vector<size_t> order(frames);
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::sort(order, {}, [](size_t frame) { return std::to_string(frame); });
  return order;
}

std::vector<size_t> Reversed(size_t frames) {
  std::vector<size_t> order(frames);
  std::iota(order.rbegin(), order.rend(), size_t{0});
  return order;
}

std::vector<size_t> Inverse(const std::vector<size_t>& order) {
  std::vector<size_t> inverse(order.size());
  for (size_t i = 0; i < order.size(); ++i) inverse[order[i]] = i;
  return inverse;
}

}  // namespace

std::vector<FrameOrder> FrameOrders(size_t frames) {
  constexpr const char* kAsStrings = "numbers that were sorted as strings, 10 before 2";
  const std::vector<size_t> of_strings = OrderOfStrings(frames);
  return {{"the poses are in reversed order", "poses or boxes from the last image to the first",
           "reverse the poses or the frames of the detections", Reversed(frames)},
          {"boxes are in the order of strings", kAsStrings,
           "sort the images or boxes by number, or write numbers with leading zeros", of_strings},
          {"the poses are in the order of strings", kAsStrings,
           "sort the images or poses by number, or write numbers with leading zeros",
           Inverse(of_strings)}};
}

}  // namespace soslam
