// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>
#include <sstream>

#include "exchange/exports.h"
#include "geometry/support_function.h"
#include "geometry/surface.h"
#include "support/exported_world.h"
#include "support/mesh_checks.h"

namespace soslam {
namespace {

const Eigen::Vector3d kHalfAxes(0.3, 0.7, 1.1);

class BodyMeshTest : public testing::TestWithParam<double> {
 protected:
  const TriangleMesh mesh_ = BodyMesh(kHalfAxes, GetParam());
};

INSTANTIATE_TEST_SUITE_P(ShapeExponents, BodyMeshTest,
                         testing::Values(1.0, 1.004, 1.01, 1.1, 1.25, 1.5, 1.75, 2.0));

TEST_P(BodyMeshTest, IsClosed) { ExpectClosed(mesh_); }

TEST_P(BodyMeshTest, VerticesAreOnTheSurface) {
  const BodySurface surface(kHalfAxes, GetParam());
  for (const Eigen::Vector3d& vertex : mesh_.vertices) {
    EXPECT_NEAR(surface.Gradient(vertex).dot(vertex), 1.0, 1e-12);
  }
}

TEST_P(BodyMeshTest, HasTheVolumeOfTheBody) {
  const double ratio = SignedVolume(mesh_) / BodyVolume(kHalfAxes, GetParam());
  EXPECT_LT(ratio, 1.0 + 2e-4);  // what is nearly a cuboid is drawn as one
  EXPECT_GT(ratio, 0.99);
}

TEST(BodyMeshTest, CuboidIsABoxOfTwelveTriangles) {
  const TriangleMesh mesh = BodyMesh(kHalfAxes, kCuboidExponent);
  EXPECT_EQ(mesh.triangles.size(), 12u);
  ASSERT_EQ(mesh.vertices.size(), 8u);
  for (const Eigen::Vector3d& vertex : mesh.vertices) {
    EXPECT_EQ(vertex.cwiseAbs(), kHalfAxes);
  }
}

struct PlyFile {
  std::vector<std::string> header;
  TriangleMesh mesh;
  std::vector<std::array<int, 3>> colours;
};

PlyFile ParsePly(const std::string& text) {
  PlyFile file;
  std::istringstream stream(text);
  size_t vertices = 0;
  size_t faces = 0;
  for (std::string line; std::getline(stream, line) && line != "end_header";) {
    file.header.push_back(line);
    std::istringstream words(line);
    std::string keyword, name;
    size_t count = 0;
    words >> keyword >> name >> count;
    if (keyword == "element") (name == "vertex" ? vertices : faces) = count;
  }
  for (size_t i = 0; i < vertices; ++i) {
    Eigen::Vector3d& vertex = file.mesh.vertices.emplace_back();
    std::array<int, 3>& colour = file.colours.emplace_back();
    stream >> vertex.x() >> vertex.y() >> vertex.z() >> colour[0] >> colour[1] >> colour[2];
  }
  for (size_t i = 0; i < faces; ++i) {
    int corners = 0;
    auto& triangle = file.mesh.triangles.emplace_back();
    stream >> corners >> triangle[0] >> triangle[1] >> triangle[2];
    EXPECT_EQ(corners, 3);
  }
  EXPECT_TRUE(stream);
  std::string rest;
  EXPECT_FALSE(stream >> rest) << rest;
  return file;
}

TEST(PlyTest, BodiesAreClosedInTheirPlaces) {
  const World world = ExportedWorld();
  const PlyFile file = ParsePly(PlyText(world, ColoursOfLabels({world})));
  EXPECT_EQ(file.header[0], "ply");
  EXPECT_EQ(file.header[1], "format ascii 1.0");
  ExpectClosed(file.mesh);

  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  for (const WorldObject& object : world.objects) {
    if (!object.estimate.landmark_in_world) continue;
    const Landmark& landmark = *object.estimate.landmark_in_world;
    const TriangleMesh body = BodyMesh(landmark.half_axes, landmark.shape_exponent);
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const Eigen::Vector3d& vertex : body.vertices) {
      vertices.push_back(landmark.frame_from_object * vertex);
    }
    for (const auto& [a, b, c] : body.triangles) {
      triangles.push_back({a + first, b + first, c + first});
    }
  }
  EXPECT_EQ(file.mesh.vertices, vertices);
  EXPECT_EQ(file.mesh.triangles, triangles);
}

TEST(PlyTest, ColoursGoByLabel) {
  World world = ExportedWorld();
  world.objects[2].label = "cup";
  for (WorldObject& object : world.objects) {  // boxes of eight vertices
    if (object.estimate.landmark_in_world) object.estimate.landmark_in_world->shape_exponent = 1.0;
  }
  const PlyFile file = ParsePly(PlyText(world, ColoursOfLabels({world})));
  ASSERT_EQ(file.colours.size(), 24u);
  EXPECT_EQ(std::set(file.colours.begin(), file.colours.begin() + 8).size(), 1u);
  EXPECT_EQ(std::set(file.colours.begin() + 8, file.colours.end()).size(), 1u);
  EXPECT_NE(file.colours[0], file.colours[8]);
}

}  // namespace
}  // namespace soslam
