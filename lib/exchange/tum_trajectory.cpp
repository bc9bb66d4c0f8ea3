// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/tum_trajectory.h"

#include <fmt/format.h>

#include <algorithm>

namespace soslam {

std::string TumTrajectoryText(const World& world) {
  std::string text = "# world_from_camera: timestamp tx ty tz qx qy qz qw\n";
  std::vector<WorldFrame> frames = world.frames;
  std::ranges::stable_sort(frames, {}, &WorldFrame::timestamp);
  for (const WorldFrame& frame : frames) {
    text += fmt::format("{} {} {}\n", frame.timestamp,
                        fmt::join(frame.world_from_camera.translation, " "),
                        fmt::join(frame.world_from_camera.rotation.coeffs(), " "));
  }
  return text;
}

}  // namespace soslam
