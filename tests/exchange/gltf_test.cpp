// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <set>
#include <sstream>
#include <utility>

#include "soslam/exchange/exports.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/support_function.h"
#include "soslam/geometry/surface.h"
#include "soslam/system/hash.h"
#include "support/exported_world.h"
#include "support/gltf_document.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

// Volume of || ( ||(x / a, y / b)||_q, z / c ) ||_r <= 1 with the dual exponents (Dirichlet's
// integrals): 8 a b c for the cuboid, 4 / 3 pi a b c for the ellipsoid, 2 pi a b c for the
// cylinder.
double BodyVolume(const Eigen::Vector3d& half_axes, const ShapeExponents& shape_exponents) {
  const double q = 1.0 - 1.0 / shape_exponents.horizontal;  // their inverses
  const double r = 1.0 - 1.0 / shape_exponents.vertical;
  const double section = std::pow(std::tgamma(1.0 + q), 2) / std::tgamma(1.0 + 2.0 * q);
  const double sections =
      std::tgamma(1.0 + r) * std::tgamma(1.0 + 2.0 * r) / std::tgamma(1.0 + 3.0 * r);
  return 8.0 * half_axes.prod() * section * sections;
}

// Positive where the triangles are counter-clockwise seen from outside.
double SignedVolume(const TriangleMesh& mesh) {
  double volume = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    volume += mesh.vertices.at(a).dot(mesh.vertices.at(b).cross(mesh.vertices.at(c))) / 6.0;
  }
  return volume;
}

// Each edge is in two triangles, once in each direction, and every vertex is used.
void ExpectClosed(const TriangleMesh& mesh) {
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

using nlohmann::json;

class GltfTest : public testing::Test {
 protected:
  GltfDocument Export() const { return ParseGlb(GlbBytes(world_, ColoursOfLabels({world_}))); }
  // Nodes of the world's objects, in their order; then the trajectory.
  static const json& Node(const GltfDocument& document, size_t child) {
    const auto index = document.json.at("nodes").at(0).at("children").at(child).get<size_t>();
    return document.json["nodes"].at(index);
  }

  World world_ = ExportedWorld();
};

TEST_F(GltfTest, NodesAreLandmarksWithTheirBodies) {
  const GltfDocument document = Export();
  const std::vector<std::string> names = {"Dining_Table 2", "cup 3", "a \"b\", c 5", "trajectory"};
  ASSERT_EQ(document.json.at("nodes").at(0).at("children").size(), names.size());
  for (size_t i = 0; i < names.size(); ++i) EXPECT_EQ(Node(document, i).at("name"), names[i]);
  for (size_t i = 0; i < 3; ++i) {
    const json& node = Node(document, i);
    const Landmark& landmark = *world_.objects[i].estimate.landmark_in_world;
    EXPECT_EQ(node.at("translation").get<std::vector<double>>(),
              std::vector<double>(landmark.Centre().begin(), landmark.Centre().end()));
    EXPECT_EQ(document.Rotation(node).coeffs(), landmark.frame_from_object.rotation.coeffs());
    const TriangleMesh mesh = document.Mesh(node);
    ExpectClosed(mesh);
    EXPECT_NEAR(SignedVolume(mesh) / BodyVolume(landmark.half_axes, landmark.shape_exponents), 1.0,
                0.01);
  }
  EXPECT_EQ(document.Mesh(Node(document, 0)).triangles.size(), 12u);
}

TEST_F(GltfTest, ExtrasSayWhatTheMapKnows) {
  world_.objects[0].estimate.front_probability = 0.75;
  const GltfDocument document = Export();
  const json& extras = Node(document, 0).at("extras");
  const WorldObject& object = world_.objects[0];
  EXPECT_EQ(extras.at("id"), 2);
  EXPECT_EQ(extras.at("label"), "Dining_Table");
  EXPECT_EQ(extras.at("observations"), 12);
  EXPECT_EQ(extras.at("shape_exponent"), 1.0);
  EXPECT_EQ(extras.at("vertical_exponent"), 1.0);
  EXPECT_EQ(extras.at("half_axes").at(1), object.estimate.landmark_in_world->half_axes.y());
  EXPECT_NEAR(extras.at("yaw_deg").get<double>(), ComputeYaw(object) * kDegPerRad, 1e-9);
  EXPECT_EQ(extras.at("covariance").size(), 9u);
  EXPECT_EQ(extras.at("covariance").at(3).at(8), (*object.estimate.covariance)(3, 8));
  EXPECT_EQ(extras.at("front_probability"), 0.75);
  for (const char* field : {"covariance", "front_probability"}) {
    EXPECT_FALSE(Node(document, 1).at("extras").contains(field)) << field;
  }
}

TEST_F(GltfTest, SupportNormalIsUp) {
  const Eigen::Vector3d up = RandomPlane().normal;
  for (WorldObject& object : world_.objects) object.support_normal = up;
  const GltfDocument document = Export();
  const json& root = document.json.at("nodes").at(0);
  EXPECT_EQ(root.at("name"), "world");
  EXPECT_NEAR(document.Rotation(root).norm(), 1.0, 1e-12);
  EXPECT_LT((document.Rotation(root) * up - Eigen::Vector3d::UnitY()).norm(), 1e-12);
  EXPECT_FALSE(root.contains("translation"));
}

TEST_F(GltfTest, EachLabelHasOneMaterial) {
  world_.objects[2].label = "cup";
  const GltfDocument document = Export();
  const auto material = [&](size_t child) {
    return document.Primitive(Node(document, child)).at("material").get<size_t>();
  };
  EXPECT_EQ(material(1), material(2));
  EXPECT_NE(material(0), material(1));
  EXPECT_EQ(document.json.at("materials").size(), 3u);  // with the trajectory's
  EXPECT_EQ(document.json["materials"].at(material(1)).at("name"), "cup");
}

TEST_F(GltfTest, TrajectoryIsALineStripThroughTheCameras) {
  for (WorldFrame& frame : world_.frames) frame.world_from_camera.translation.x() += 4e6;
  const GltfDocument document = Export();
  const json& node = Node(document, 3);
  const json& primitive = document.Primitive(node);
  EXPECT_EQ(primitive.at("mode"), 3);
  EXPECT_FALSE(primitive.contains("indices"));
  const auto points = document.Positions(primitive.at("attributes").at("POSITION").get<size_t>());
  ASSERT_EQ(points.size(), world_.frames.size());
  const auto origin = node.at("translation").get<std::vector<double>>();
  for (size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d centre = points[i] + Eigen::Vector3d(origin.data());
    // Single precision of distances of a few metres.
    EXPECT_LT((centre - world_.frames[i].world_from_camera.translation).norm(), 1e-6);
  }
}

TEST_F(GltfTest, OneFrameHasNoTrajectory) {
  world_.frames.resize(1);
  EXPECT_EQ(Export().json.at("nodes").at(0).at("children").size(), 3u);
}

TEST_F(GltfTest, AWorldWithNothingInItHasNoBuffer) {
  const std::string text = GltfText(World(), {});
  const json document = json::parse(text);
  EXPECT_FALSE(document.contains("buffers"));
  EXPECT_EQ(document.at("nodes").size(), 1u);
  EXPECT_EQ(GlbBytes(World(), {}).substr(0, 4), "glTF");
}

TEST_F(GltfTest, TextHasTheSameWithTheBufferInBase64) {
  const GltfDocument binary = Export();
  json document = json::parse(GltfText(world_, ColoursOfLabels({world_})));
  const std::string uri = document.at("buffers").at(0).at("uri").get<std::string>();
  document["buffers"][0].erase("uri");
  EXPECT_EQ(document, binary.json);
  EXPECT_EQ(uri, "data:application/octet-stream;base64," + Base64(binary.buffer));
}

const Eigen::Vector3d kHalfAxes(0.3, 0.7, 1.1);

// Also bodies that are nearly cuboids, and drawn as such.
TEST(BodyMeshTest, IsClosedOnTheSurfaceAndOfTheVolumeOfTheBody) {
  std::vector<ShapeExponents> tested(kShapeExponents.begin(), kShapeExponents.end());
  for (const double p : {1.004, 1.01, 1.25, 1.75}) tested.emplace_back(p);
  for (const ShapeExponents& p : tested) {
    SCOPED_TRACE(testing::Message() << p);
    const TriangleMesh mesh = BodyMesh(kHalfAxes, p);
    ExpectClosed(mesh);
    const BodySurface surface(kHalfAxes, p);
    for (const Eigen::Vector3d& vertex : mesh.vertices) {
      EXPECT_NEAR(surface.Gradient(vertex).dot(vertex), 1.0, 1e-12);
    }
    const double ratio = SignedVolume(mesh) / BodyVolume(kHalfAxes, p);
    EXPECT_LT(ratio, 1.0 + 2e-4);
    EXPECT_GT(ratio, 0.99);
  }
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
    const TriangleMesh body = BodyMesh(landmark.half_axes, landmark.shape_exponents);
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
    if (object.estimate.landmark_in_world) object.estimate.landmark_in_world->shape_exponents = 1.0;
  }
  const PlyFile file = ParsePly(PlyText(world, ColoursOfLabels({world})));
  ASSERT_EQ(file.colours.size(), 24u);
  EXPECT_EQ(std::set(file.colours.begin(), file.colours.begin() + 8).size(), 1u);
  EXPECT_EQ(std::set(file.colours.begin() + 8, file.colours.end()).size(), 1u);
  EXPECT_NE(file.colours[0], file.colours[8]);
}

}  // namespace
}  // namespace soslam
