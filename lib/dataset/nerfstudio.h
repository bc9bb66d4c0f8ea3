// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dataset/lens_camera.h"
#include "dataset/named_pose.h"
#include "dataset/tum_list.h"
#include "model/finding.h"

namespace soslam {

// nerfstudio's transforms.json, also as instant-ngp writes it. The readers throw InputError with
// file and JSON pointer.

// The camera: w, h, fl_x, fl_y (that of x when absent; camera_angle_x in place of both), cx, cy
// (the middle when absent), k1, k2, k3, p1, p2, camera_model; k4, k5, k6 have to be 0. What a frame
// says of its own has to be the same. Pixel (0, 0) is the outer corner of the top-left one: half a
// pixel is taken off cx, cy. None for a file that is not one of these, as a camera.json.
std::optional<LensCamera> ReadNerfstudioCamera(const std::filesystem::path& path);

// The poses of "frames": "transform_matrix", 4 x 4, is world_from_camera with the camera axes of
// OpenGL (x right, y up, z backward), which become x right, y down, z forward here. The image is
// "file_path". In file order; at least one. An "applied_transform" or "applied_scale", which say
// how the world came from that of the reconstruction, is not undone; another scale is a finding.
std::vector<NamedPose> ReadNerfstudioPoses(const std::filesystem::path& path,
                                           std::vector<Finding>* findings);

// Its frames as a list of images, by their names, as nerfstudio itself sorts them, a second apart:
// the order in the file is of no meaning.
std::vector<ListedImage> ReadNerfstudioImages(const std::filesystem::path& path);

}  // namespace soslam
