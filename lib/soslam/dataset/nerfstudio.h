// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "soslam/dataset/calibration_file.h"
#include "soslam/dataset/trajectories.h"
#include "soslam/model/finding.h"

namespace soslam {

// Readers of nerfstudio's transforms.json, also as written by instant-ngp. They throw InputError
// with file and JSON pointer.

// Reads the camera: w, h (default: the size of the first image), fl_x, fl_y (default fl_x;
// camera_angle_x in place of both), cx, cy (default: image centre), k1, k2, k3, p1, p2,
// camera_model; k4, k5, k6 must be 0. Where frames have values of their own, OneCamera of all
// frames. Pixel (0, 0) is the outer corner of the top-left one: half a pixel is subtracted from cx,
// cy. None for another kind of file, such as a camera.json.
std::optional<LensCamera> ReadNerfstudioCamera(const std::filesystem::path& path,
                                               std::vector<Finding>* findings);

// Reads the poses of "frames": "transform_matrix", 4 x 4, is world_from_camera with OpenGL's camera
// axes (x right, y up, z backward), converted here to x right, y down, z forward. The image is
// "file_path". In file order; at least one. An "applied_transform" or "applied_scale" of the
// reconstruction is not undone; a scale other than 1 is a finding.
std::vector<NamedPose> ReadNerfstudioPoses(const std::filesystem::path& path,
                                           std::vector<Finding>* findings);

// Its frames as an image list, sorted by name as nerfstudio does, one second apart; the order in
// the file has no meaning. A "file_path" without extension, as Blender's, is that of a PNG file.
std::vector<ListedImage> ReadNerfstudioImages(const std::filesystem::path& path);

}  // namespace soslam
