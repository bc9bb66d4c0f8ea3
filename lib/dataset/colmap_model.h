// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/calibration_file.h"
#include "dataset/trajectories.h"

namespace soslam {

// COLMAP's model as text. The readers throw InputError naming the line; for binary files (.bin)
// with the command that converts them to text.

// Reads the camera of cameras.txt, lines "CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]". Several cameras
// must be identical. Models: SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV.
// COLMAP's pixel (0, 0) is the outer corner of the top-left one: half a pixel is subtracted from
// cx, cy.
LensCamera ReadColmapCamera(const std::filesystem::path& path);

// Reads the poses of images.txt, two lines per image: "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID
// NAME", and its points, which are ignored and may be empty. COLMAP's pose is camera_from_world; it
// is inverted here. In file order; at least one.
std::vector<NamedPose> ReadColmapPoses(const std::filesystem::path& path);

}  // namespace soslam
