// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace soslam {

// Summary of a reconstruction by structure from motion, for reconstruction.json.
struct ReconstructionSummary {
  // A model with its own world, not connected to the others.
  struct Component {
    int images = 0;
    int points = 0;
  };
  int images = 0;      // in the dataset's list
  int registered = 0;  // images with a pose
  std::vector<std::string> images_without_pose = {};
  int points = 0;
  int observations = 0;
  std::vector<Component> components;                     // largest first; the first one is used
  std::optional<double> median_reprojection_error_px;    // over points whose error is known
  std::optional<double> median_triangulation_angle_deg;  // over points, the widest of each
  std::string colmap;  // version that ran; empty: the model was given
  bool poses_are_given = false;
  bool camera_is_given = false;  // or else estimated
};

}  // namespace soslam
