// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "base/hash.h"
#include "exchange/exports.h"
#include "geometry/angles.h"
#include "support/exported_world.h"
#include "support/gltf_document.h"
#include "support/mesh_checks.h"

namespace soslam {
namespace {

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
    EXPECT_NEAR(SignedVolume(mesh) / BodyVolume(landmark.half_axes, landmark.shape_exponent), 1.0,
                0.01);
  }
  EXPECT_EQ(document.Mesh(Node(document, 0)).triangles.size(), 12u);
}

TEST_F(GltfTest, ExtrasSayWhatTheMapKnows) {
  const GltfDocument document = Export();
  const json& extras = Node(document, 0).at("extras");
  const WorldObject& object = world_.objects[0];
  EXPECT_EQ(extras.at("id"), 2);
  EXPECT_EQ(extras.at("label"), "Dining_Table");
  EXPECT_EQ(extras.at("observations"), 12);
  EXPECT_EQ(extras.at("shape_exponent"), 1.0);
  EXPECT_EQ(extras.at("half_axes").at(1), object.estimate.landmark_in_world->half_axes.y());
  EXPECT_NEAR(extras.at("yaw_deg").get<double>(), YawOf(object) * kDegPerRad, 1e-9);
  EXPECT_EQ(extras.at("covariance").size(), 9u);
  EXPECT_EQ(extras.at("covariance").at(3).at(8), (*object.estimate.covariance)(3, 8));
  EXPECT_FALSE(Node(document, 1).at("extras").contains("covariance"));
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

}  // namespace
}  // namespace soslam
