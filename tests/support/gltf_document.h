// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "soslam/exchange/exports.h"

namespace soslam {

// A glTF 2.0 document with its one buffer, read on a little-endian machine.
struct GltfDocument {
  nlohmann::json json;
  std::string buffer;

  // The numbers of an accessor, which has to fit into its view, that into the buffer, aligned.
  template <typename Number>
  std::vector<Number> Numbers(size_t accessor_index, int component_type, int components) const {
    const auto& accessor = json.at("accessors").at(accessor_index);
    EXPECT_EQ(accessor.at("componentType"), component_type);
    EXPECT_EQ(accessor.at("type"), components == 3 ? "VEC3" : "SCALAR");
    const auto& view = json.at("bufferViews").at(accessor.at("bufferView").get<size_t>());
    EXPECT_EQ(view.at("buffer"), 0);
    EXPECT_EQ(view.at("target"), components == 3 ? 34962 : 34963);
    const auto begin = view.at("byteOffset").get<size_t>();
    const auto size = view.at("byteLength").get<size_t>();
    EXPECT_EQ(begin % sizeof(Number), 0u);
    EXPECT_LE(begin + size, buffer.size());
    const size_t count = accessor.at("count").get<size_t>() * static_cast<size_t>(components);
    EXPECT_EQ(size, count * sizeof(Number));
    std::vector<Number> numbers(count);
    std::memcpy(numbers.data(), buffer.data() + begin, size);
    return numbers;
  }

  // Points of a POSITION accessor, whose bounds must be exact.
  std::vector<Eigen::Vector3d> Positions(size_t accessor_index) const {
    const std::vector<float> numbers = Numbers<float>(accessor_index, 5126, 3);
    std::vector<Eigen::Vector3d> points;
    Eigen::AlignedBox3d bounds;
    for (size_t i = 0; i < numbers.size(); i += 3) {
      points.push_back(Eigen::Vector3f(numbers[i], numbers[i + 1], numbers[i + 2]).cast<double>());
      bounds.extend(points.back());
    }
    const auto& accessor = json.at("accessors").at(accessor_index);
    for (int i = 0; i < 3; ++i) {
      EXPECT_EQ(accessor.at("min").at(i).get<double>(), bounds.min()[i]);
      EXPECT_EQ(accessor.at("max").at(i).get<double>(), bounds.max()[i]);
    }
    return points;
  }

  // The one primitive of a node's mesh.
  const nlohmann::json& Primitive(const nlohmann::json& node) const {
    const auto& mesh = json.at("meshes").at(node.at("mesh").get<size_t>());
    EXPECT_EQ(mesh.at("primitives").size(), 1u);
    return mesh.at("primitives").at(0);
  }

  TriangleMesh Mesh(const nlohmann::json& node) const {
    const nlohmann::json& primitive = Primitive(node);
    EXPECT_EQ(primitive.value("mode", 4), 4);  // triangles
    TriangleMesh mesh;
    mesh.vertices = Positions(primitive.at("attributes").at("POSITION").get<size_t>());
    const auto indices = Numbers<std::uint32_t>(primitive.at("indices").get<size_t>(), 5125, 1);
    EXPECT_EQ(indices.size() % 3, 0u);
    for (size_t i = 0; i < indices.size(); i += 3) {
      mesh.triangles.push_back({indices[i], indices[i + 1], indices[i + 2]});
    }
    return mesh;
  }

  Eigen::Quaterniond Rotation(const nlohmann::json& node) const {
    const auto xyzw = node.at("rotation").get<std::vector<double>>();
    return Eigen::Quaterniond(Eigen::Map<const Eigen::Vector4d>(xyzw.data()));
  }
};

// The binary form: a header, a JSON chunk, and a binary chunk with what the JSON says.
inline GltfDocument ParseGlb(const std::string& bytes) {
  const auto word = [&](size_t offset) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.substr(offset, 4).data(), 4);
    return value;
  };
  EXPECT_EQ(bytes.substr(0, 4), "glTF");
  EXPECT_EQ(word(4), 2u);
  EXPECT_EQ(word(8), bytes.size());
  const size_t json_size = word(12);
  EXPECT_EQ(bytes.substr(16, 4), "JSON");
  EXPECT_EQ(json_size % 4, 0u);
  GltfDocument document;
  document.json = nlohmann::json::parse(bytes.substr(20, json_size));
  const size_t binary = 20 + json_size;
  EXPECT_EQ(binary + 8 + word(binary), bytes.size());
  EXPECT_EQ(bytes.substr(binary + 4, 4), std::string("BIN\0", 4));
  document.buffer = bytes.substr(binary + 8);
  EXPECT_EQ(document.json.at("buffers").size(), 1u);
  EXPECT_EQ(document.json["buffers"][0].at("byteLength"), document.buffer.size());
  EXPECT_FALSE(document.json["buffers"][0].contains("uri"));
  return document;
}

}  // namespace soslam
