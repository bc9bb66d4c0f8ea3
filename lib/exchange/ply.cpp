// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/ply.h"

#include <fmt/format.h>

#include "exchange/body_mesh.h"

namespace soslam {

std::string PlyText(const World& world, const LabelColours& colours) {
  std::string vertices;
  std::string faces;
  size_t num_vertices = 0;
  size_t num_faces = 0;
  for (const WorldObject& object : world.objects) {
    if (!object.estimate.landmark_in_world) continue;
    const Landmark& landmark = *object.estimate.landmark_in_world;
    const TriangleMesh mesh = BodyMesh(landmark.half_axes, landmark.shape_exponent);
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
