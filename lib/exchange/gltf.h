// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "exchange/meshes.h"
#include "exchange/world.h"

namespace soslam {

// A world in glTF 2.0, in one self-contained file. The root node "world" rotates the world so that
// UpOf is glTF's y; below it are
// - a node "<label> <id>" per landmark: its pose, its body as a mesh in the object frame, a
// material
//   named by the label, and extras: id, label, observations, half_axes [a, b, c] in metres, yaw_deg
//   about the support normal, shape_exponent, and the covariance of ObjectEstimate if there is one;
// - a node "trajectory": the camera centres as a line strip, if there are at least two frames.
// `colours` must have all labels of the world.
// JSON with the numbers as a base64 data URI (.gltf):
std::string GltfText(const World& world, const LabelColours& colours);
// The binary form (.glb):
std::string GlbBytes(const World& world, const LabelColours& colours);

}  // namespace soslam
