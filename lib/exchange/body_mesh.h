// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

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

}  // namespace soslam
