// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "dataset/lens_camera.h"
#include "dataset/named_pose.h"

namespace soslam {

// COLMAP's model as text. The readers throw InputError naming the line; for its binary files (.bin)
// with the command that makes text of them.

// The camera of cameras.txt, lines "CAMERA_ID MODEL WIDTH HEIGHT PARAMS[]". Of several cameras, all
// have to be the same. Models: SIMPLE_PINHOLE, PINHOLE, SIMPLE_RADIAL, RADIAL, OPENCV, FULL_OPENCV.
// COLMAP's pixel (0, 0) is the outer corner of the top-left one: half a pixel is taken off cx, cy.
LensCamera ReadColmapCamera(const std::filesystem::path& path);

// The poses of images.txt, two lines an image: "IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME", and
// its points, which are not read and may be none. COLMAP's pose is camera_from_world; it is
// inverted here. In file order; at least one.
std::vector<NamedPose> ReadColmapPoses(const std::filesystem::path& path);

}  // namespace soslam
