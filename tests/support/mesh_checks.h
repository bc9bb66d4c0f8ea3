// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <utility>

#include "exchange/exports.h"

namespace soslam {

// Volume of ||(x / a, y / b, z / c)||_q <= 1 with 1 / p + 1 / q = 1 (Dirichlet's integral); p = 1
// gives 8 a b c, p = 2 gives 4 / 3 pi a b c.
inline double BodyVolume(const Eigen::Vector3d& half_axes, double shape_exponent) {
  const double inverse_q = 1.0 - 1.0 / shape_exponent;
  return 8.0 * half_axes.prod() * std::pow(std::tgamma(1.0 + inverse_q), 3) /
         std::tgamma(1.0 + 3.0 * inverse_q);
}

// Positive where the triangles are counter-clockwise seen from outside.
inline double SignedVolume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices.at(a).dot(mesh.vertices.at(b).cross(mesh.vertices.at(c))) / 6.0;
  }
  return volume;
}

// Each edge is in two triangles, once in each direction, and every vertex is used.
inline void ExpectClosed(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed_edges;
  std::map<std::uint32_t, int> uses;
  for (const auto& triangle : mesh.triangles) {
    for (size_t i = 0; i < 3; ++i) {
      ++directed_edges[{triangle[i], triangle[(i + 1) % 3]}];
      ++uses[triangle[i]];
    }
  }
  for (const auto& [edge, count] : directed_edges) {
    EXPECT_NE(edge.first, edge.second);
    EXPECT_EQ(count, 1) << edge.first << " " << edge.second;
    EXPECT_TRUE(directed_edges.count({edge.second, edge.first}))
        << edge.first << " " << edge.second;
  }
  EXPECT_EQ(uses.size(), mesh.vertices.size());
}

}  // namespace soslam
