// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/tum_trajectory.h"

#include <fmt/format.h>

namespace soslam {

std::string TumTrajectoryText(const World& world) {
  std::string text = "# world_from_camera: timestamp tx ty tz qx qy qz qw\n";
  for (const WorldFrame& frame : world.frames) {
    text += fmt::format("{} {} {}\n", frame.timestamp,
                        fmt::join(frame.world_from_camera.translation, " "),
                        fmt::join(frame.world_from_camera.rotation.coeffs(), " "));
  }
  return text;
}

}  // namespace soslam
