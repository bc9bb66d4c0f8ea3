// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "dataset/tum_list.h"
#include "geometry/camera.h"
#include "geometry/rigid3.h"

namespace soslam {

// What is peculiar to ICL-NUIM (A. Handa et al., "A Benchmark for RGB-D Visual Odometry, 3D
// Reconstruction and SLAM", ICRA 2014), whose images are renders of POV-Ray:
//
// - Both its world and its camera have y up, x right, z forward: they are left-handed. The negative
//   fy of the published intrinsics (481.20, -480.00, 319.50, 239.50; 640 x 480) says so: it makes a
//   point with positive y land in the upper half of the image.
// - Its trajectories (*.gt.freiburg) look like TUM's, but are rotations between left-handed frames,
//   and their first column, like that of associations.txt, is the number of the frame; the images
//   are 1/30 s apart.
//
// Mirroring y in the world and in the camera makes both right-handed, with the same images: y is
// then down, and up in the world is (0, -1, 0).

inline constexpr double kIclNuimFramesPerSecond = 30.0;

// The camera with x right, y down, z forward that gives the same images as one whose published fy
// is negative. Throws InputError for a positive fy: this camera has y down already.
Camera WithYDown(const Camera& camera_with_y_up);

// A pose between left-handed frames as one between the mirrored, right-handed ones.
Rigid3d MirroredInY(const Rigid3d& world_from_camera);

// A trajectory as it is published, with mirrored poses and frame numbers turned into seconds.
std::vector<TimedPose> FromIclNuim(const std::vector<TimedPose>& published);

}  // namespace soslam
