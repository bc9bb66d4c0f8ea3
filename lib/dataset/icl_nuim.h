// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "dataset/tum_list.h"
#include "geometry/camera.h"
#include "geometry/rigid3.h"

namespace soslam {

// Conversion of ICL-NUIM (A. Handa et al., "A Benchmark for RGB-D Visual Odometry, 3D
// Reconstruction and SLAM", ICRA 2014), whose images are rendered by POV-Ray:
//
// - Both its world and its camera have y up, x right, z forward: they are left-handed. The negative
//   fy of the published intrinsics (481.20, -480.00, 319.50, 239.50; 640 x 480) shows this: it
//   projects a point with positive y to the upper half of the image.
// - Its trajectories (*.gt.freiburg) look like TUM's, but are rotations between left-handed frames,
//   and their first column, like that of associations.txt, is the frame number; the images are
//   1/30 s apart.
//
// Mirroring y in the world and in the camera makes both right-handed, with the same images: y is
// then down, and up in the world is (0, -1, 0).

inline constexpr double kIclNuimFramesPerSecond = 30.0;

// The camera with x right, y down, z forward that gives the same images as one whose published fy
// is negative. Throws InputError for a positive fy, with which y is already down.
Camera WithYDown(const Camera& camera_with_y_up);

// Converts a pose between left-handed frames to one between the mirrored, right-handed ones.
Rigid3d MirroredInY(const Rigid3d& world_from_camera);

// Converts a published trajectory: poses are mirrored and frame numbers become seconds.
std::vector<TimedPose> FromIclNuim(const std::vector<TimedPose>& published);

}  // namespace soslam
