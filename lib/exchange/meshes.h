// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "exchange/world.h"

namespace soslam {

// Triangles over shared vertices, counter-clockwise seen from outside.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  // metres
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

// The closed surface of a landmark's body (see BodySurface) in its object frame: all vertices are
// on the surface; the 12 triangles of a box for the cuboid. Its volume is at most 1 % below the
// body's.
TriangleMesh BodyMesh(const Eigen::Vector3d& half_axes, double shape_exponent);

// Red, green and blue in sRGB, 0 to 1.
using Colour = Eigen::Vector3d;
using LabelColours = std::map<std::string, Colour>;

// A colour for each label of the worlds' objects, clearly different from its alphabetical
// neighbours'.
LabelColours ColoursOfLabels(const std::vector<World>& worlds);

// The landmarks as one mesh in the world frame, metres, in ASCII PLY: the vertices of each body are
// consecutive, in the colour of its label. `colours` must have all labels of the world.
std::string PlyText(const World& world, const LabelColours& colours);

}  // namespace soslam
