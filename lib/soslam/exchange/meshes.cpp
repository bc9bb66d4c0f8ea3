// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "soslam/exchange/exports.h"
#include "soslam/geometry/support_function.h"

namespace soslam {
namespace {

// Lines across a face of the cube |x_i| <= 1 at equally spaced angles of superquadrics, which are
// dense where the surface is curved (Barr, "Superquadrics and angle-preserving transformations",
// 1981): x / z = tan(angle)^(2 / q).
std::vector<double> LinesAcrossFace(double q) {
  constexpr int kCells = 16;
  if (std::isinf(q)) return {-1.0, 1.0};
  std::vector<double> lines;
  for (int i = 0; i <= kCells; ++i) {
    const double tangent = std::tan((2.0 * i / kCells - 1.0) * std::numbers::pi / 4.0);
    lines.push_back(std::copysign(std::pow(std::abs(tangent), 2.0 / q), tangent));
  }
  return lines;
}

}  // namespace

TriangleMesh BodyMesh(const Eigen::Vector3d& half_axes, const ShapeExponents& shape_exponents) {
  // A node (i, j, k) of a grid on the surface of the cube, each from 0 to cells(axis); at least one
  // of them is at an end.
  using Node = std::array<int, 3>;
  const ShapeExponents dual = DualExponents(shape_exponents);
  const auto horizontal = LinesAcrossFace(std::min(dual.horizontal, dual.vertical));
  const std::array lines = {horizontal, horizontal, LinesAcrossFace(dual.vertical)};
  const auto cells = [&](size_t axis) { return static_cast<int>(lines[axis].size()) - 1; };
  // The node moved onto the body: first in the horizontal section, then between the axis and the
  // section's rim.
  const auto point = [&](const Node& node) -> Eigen::Vector3d {
    const Eigen::Array3d on_cube(lines[0][node[0]], lines[1][node[1]], lines[2][node[2]]);
    const double rim = on_cube.head<2>().abs().maxCoeff();
    Eigen::Array3d in_section(on_cube.x(), on_cube.y(), 0.0);
    if (rim > 0.0) in_section *= rim / SuperquadricNorm(in_section, dual).value;
    const Eigen::Array3d on_body(in_section.x(), in_section.y(), on_cube.z());
    return half_axes.cwiseProduct((on_body / SuperquadricNorm(on_body, dual).value).matrix());
  };
  TriangleMesh mesh;
  std::map<Node, std::uint32_t> vertices;
  const auto vertex = [&](const Node& node) {
    const auto [found, is_new] =
        vertices.try_emplace(node, static_cast<std::uint32_t>(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(point(node));
    return found->second;
  };
  const auto add_cell = [&](size_t axis, int side, int i, int j) {
    const auto corner = [&](int di, int dj) {
      Node node;
      node[axis] = side;
      node[(axis + 1) % 3] = i + di;
      node[(axis + 2) % 3] = j + dj;
      return vertex(node);
    };
    // Counter-clockwise about the axis, that is seen from outside if the axis points outside.
    std::array<std::uint32_t, 4> quad = {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)};
    if (side == 0) std::swap(quad[1], quad[3]);
    mesh.triangles.push_back({quad[0], quad[1], quad[2]});
    mesh.triangles.push_back({quad[0], quad[2], quad[3]});
  };
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const int side : {0, cells(axis)}) {
      for (int i = 0; i < cells((axis + 1) % 3); ++i) {
        for (int j = 0; j < cells((axis + 2) % 3); ++j) add_cell(axis, side, i, j);
      }
    }
  }
  return mesh;
}

LabelColours ColoursOfLabels(const std::vector<World>& worlds) {
  LabelColours colours;
  for (const World& world : worlds) {
    for (const WorldObject& object : world.objects) colours[object.label];
  }
  constexpr double kSaturation = 0.65, kValue = 0.9;
  const Eigen::Array3d offset(5.0, 3.0, 1.0);
  // Steps of the golden ratio keep their distance from the hues of the last few steps.
  double hue = 0.0;  // in turns: 0 red, 1/3 green, 2/3 blue
  for (auto& [label, colour] : colours) {
    for (int channel = 0; channel < 3; ++channel) {
      const double sector = std::fmod(6.0 * hue + offset[channel], 6.0);
      const double missing = std::clamp(std::min(sector, 4.0 - sector), 0.0, 1.0);
      colour[channel] = kValue * (1.0 - kSaturation * missing);
    }
    hue = std::fmod(hue + 1.0 / std::numbers::phi, 1.0);
  }
  return colours;
}

std::string PlyText(const World& world, const LabelColours& colours) {
  std::string vertices;
  std::string faces;
  size_t num_vertices = 0;
  size_t num_faces = 0;
  for (const WorldObject& object : world.objects) {
    if (!object.estimate.landmark_in_world) continue;
    const Landmark& landmark = *object.estimate.landmark_in_world;
    const TriangleMesh mesh = BodyMesh(landmark.half_axes, landmark.shape_exponents);
    const Eigen::Array3i rgb = (colours.at(object.label).array() * 255.0).round().cast<int>();
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      vertices += fmt::format("{} {}\n", fmt::join(landmark.frame_from_object * vertex, " "),
                              fmt::join(rgb, " "));
    }
    for (const auto& [a, b, c] : mesh.triangles) {
      faces += fmt::format("3 {} {} {}\n", num_vertices + a, num_vertices + b, num_vertices + c);
    }
    num_vertices += mesh.vertices.size();
    num_faces += mesh.triangles.size();
  }
  return fmt::format(
      "ply\nformat ascii 1.0\ncomment landmarks in the world frame, metres\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face {}\nproperty list uchar int vertex_indices\nend_header\n{}{}",
      num_vertices, num_faces, vertices, faces);
}

}  // namespace soslam
