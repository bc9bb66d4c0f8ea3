// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dataset/json_entry.h"
#include "geometry/camera.h"
#include "geometry/distortion.h"
#include "model/sequence.h"

namespace soslam {

// The JSON files of a dataset folder. Fields that are not named here are ignored. All throw
// InputError naming the file, entry and field.

// The fields of a camera as below; fy may be negative.
Camera ParseCamera(const JsonEntry& entry);

// {"model": "pinhole" (optional), "width", "height", "fx", "fy", "cx", "cy"}, pixels.
Camera ReadCamera(const std::filesystem::path& path);

// The same file of a camera with y up, whose fy is negative: as the camera with y down that gives
// the same images.
Camera ReadCameraWithYUp(const std::filesystem::path& path);

// The "distortion" of the same file, [k1, k2, p1, p2, k3]; none when it is absent: the images are
// those of a pinhole camera.
std::optional<Distortion> ReadDistortion(const std::filesystem::path& path);

// [{"id", "normal": [x, y, z], "d"}]: planes normal . x + d = 0 in the world frame, normal pointing
// away from the support, of any length. Sorted by id; at least one.
std::vector<SupportPlane> ReadPlanes(const std::filesystem::path& path);

// [{"id", "label", "support_plane" (may be absent), and, all or none: "center", "quaternion_xyzw"
// (world from object), "half_axes"}], with optional "mirror_symmetric" (default true),
// "mirror_symmetric_yz" and "rotationally_symmetric" (default false).
struct ListedObject {
  int id = 0;
  std::string label;
  std::optional<int> plane_id;
  std::optional<GroundTruth> ground_truth;
};
// Sorted by id.
std::vector<ListedObject> ReadObjects(const std::filesystem::path& path);

}  // namespace soslam
