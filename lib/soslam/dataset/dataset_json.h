// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "soslam/dataset/calibration_file.h"
#include "soslam/dataset/json_entry.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Readers of the JSON files of a dataset folder. Unknown keys are refused. All throw InputError
// naming the file, entry and field.

// Camera from "width", "height", "fx", "fy", "cx", "cy" of an object that may have other keys; fy
// may be negative.
Camera ParseCamera(const JsonEntry& entry);

enum class CameraYAxis {
  kDown,
  kUp,  // fy is negative: converted to the camera with y down that gives the same images
};

// Reads {"width", "height", "fx", "fy", "cx", "cy"}, pixels, with optional "distortion"
// (ParseLens), its model as "model", "camera_model" or "distortion_model", and the ignored keys
// "name", "description", "comment", "source", "fps", "depth_scale".
LensCamera ReadCamera(const std::filesystem::path& path, CameraYAxis y_axis = CameraYAxis::kDown);

// A camera.json that ReadCamera reads. `source` goes to its ignored key "source".
std::string CameraText(const LensCamera& camera, const std::string& source);
// The source of cameras that soslam-reconstruct writes, which are of upright images.
inline constexpr const char* kReconstructed = "soslam-reconstruct";
// "source" of a camera.json, empty without one.
std::string SourceOfCamera(const std::filesystem::path& path);

// Reads [{"id", "normal": [x, y, z], "d"}]: planes normal . x + d = 0 in the world frame, normal
// pointing away from the support, of any length; optionally "scene_axis": [x, y, z], projected onto
// the plane, see SupportPlane. Ignored keys: "label", "name", "description",
// "comment". Sorted by id; at least one.
std::vector<SupportPlane> ReadPlanes(const std::filesystem::path& path);

// One object of objects.json.
struct ListedObject {
  int id = 0;
  std::string label;
  std::optional<int> plane_id;
  std::optional<GroundTruth> ground_truth;
};

struct ListedObjects {
  std::vector<ListedObject> objects = {};  // sorted by id
  std::vector<IgnoredThings> ignored = {};
};

// Reads [{"id", "label", "support_plane" (may be absent), and, all or none: "center",
// "quaternion_xyzw" (world from object), "half_axes"}], with optional "rests_on" (a name of
// kRestingFaceNames; default "bottom"), "mirror_symmetric" (default true), "mirror_symmetric_yz"
// and "rotationally_symmetric" (default false). Ignored keys: "model", "name", "description",
// "comment", "source". Or {"objects": such a list, "ignored": [{"label", or the volume "center",
// "quaternion_xyzw", "half_axes", or both}]}, ignored keys: "name", "description", "comment",
// "source".
ListedObjects ReadObjects(const std::filesystem::path& path);

}  // namespace soslam
