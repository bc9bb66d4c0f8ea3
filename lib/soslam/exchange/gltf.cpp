// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <bit>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>

#include "soslam/artefact/json_file.h"
#include "soslam/exchange/exports.h"
#include "soslam/geometry/angles.h"
#include "soslam/system/hash.h"

namespace soslam {
namespace {

using nlohmann::json;

// Constants of the glTF 2.0 specification.
constexpr int kFloat = 5126;
constexpr int kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr int kLineStrip = 3;
constexpr std::uint32_t kGlbMagic = 0x46546C67;
constexpr std::uint32_t kGlbVersion = 2;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

constexpr const char* kTrajectory = "trajectory";

void AppendLittleEndian(std::uint32_t value, std::string* bytes) {
  for (int shift = 0; shift < 32; shift += 8) *bytes += static_cast<char>(value >> shift & 0xFF);
}

// The document under construction: JSON, and the one buffer that it refers to.
class GltfBuilder {
 public:
  GltfBuilder(const World& world, const LabelColours& colours) : colours_(colours) {
    const auto root_rotation = RotationBetween(EstimateCommonUp(world), Eigen::Vector3d::UnitY());
    document_ = {{"asset", {{"version", "2.0"}, {"generator", "soslam " SOSLAM_VERSION}}},
                 {"scene", 0},
                 {"scenes", json::array({{{"nodes", json::array({0})}}})}};
    Add("nodes", {{"name", "world"}, {"rotation", root_rotation.coeffs()}});
    for (const WorldObject& object : world.objects) {
      if (object.estimate.landmark_in_world) AddLandmark(object);
    }
    if (world.frames.size() >= 2) AddTrajectory(world.frames);
    if (!buffer_.empty()) Add("buffers", {{"byteLength", buffer_.size()}});
  }

  const json& document() const { return document_; }
  const std::string& buffer() const { return buffer_; }

 private:
  // Appends to a list of the document, which the first item creates, and returns the item's index.
  size_t Add(const char* list, json item) {
    document_[list].push_back(std::move(item));
    return document_[list].size() - 1;
  }

  // Adds a view of the buffer from `begin` to its end.
  size_t AddView(size_t begin, int target) {
    return Add("bufferViews", {{"buffer", 0},
                               {"byteOffset", begin},
                               {"byteLength", buffer_.size() - begin},
                               {"target", target}});
  }

  // The bounds are those of the rounded numbers, as the specification requires.
  size_t AddPositions(const std::vector<Eigen::Vector3d>& points) {
    const size_t begin = buffer_.size();
    Eigen::AlignedBox3f bounds;
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3f rounded = point.cast<float>();
      bounds.extend(rounded);
      for (const float value : rounded) {
        AppendLittleEndian(std::bit_cast<std::uint32_t>(value), &buffer_);
      }
    }
    return Add("accessors", {{"bufferView", AddView(begin, kArrayBuffer)},
                             {"componentType", kFloat},
                             {"type", "VEC3"},
                             {"count", points.size()},
                             {"min", Eigen::Vector3d(bounds.min().cast<double>())},
                             {"max", Eigen::Vector3d(bounds.max().cast<double>())}});
  }

  size_t AddIndices(const TriangleMesh& mesh) {
    const size_t begin = buffer_.size();
    for (const auto& triangle : mesh.triangles) {
      for (const std::uint32_t index : triangle) AppendLittleEndian(index, &buffer_);
    }
    return Add("accessors", {{"bufferView", AddView(begin, kElementArrayBuffer)},
                             {"componentType", kUnsignedInt},
                             {"type", "SCALAR"},
                             {"count", 3 * mesh.triangles.size()}});
  }

  size_t AddMaterial(const std::string& name, const Colour& colour) {
    const Colour linear = colour.array().pow(2.2);  // glTF's factors are not sRGB
    return Add("materials", {{"name", name},
                             {"pbrMetallicRoughness",
                              {{"baseColorFactor", {linear[0], linear[1], linear[2], 1.0}},
                               {"metallicFactor", 0.0},
                               {"roughnessFactor", 0.9}}}});
  }

  size_t FindOrAddMaterial(const std::string& label) {
    const auto found = materials_.find(label);
    if (found != materials_.end()) return found->second;
    return materials_[label] = AddMaterial(label, colours_.at(label));
  }

  // Adds a node below the root.
  void AddNode(json node, const json& primitive) {
    node["mesh"] =
        Add("meshes", {{"name", node["name"]}, {"primitives", json::array({primitive})}});
    const size_t index = Add("nodes", std::move(node));
    document_["nodes"][0]["children"].push_back(index);
  }

  void AddLandmark(const WorldObject& object) {
    const Landmark& landmark = *object.estimate.landmark_in_world;
    const TriangleMesh mesh = BodyMesh(landmark.half_axes, landmark.shape_exponents);
    const json primitive = {{"attributes", {{"POSITION", AddPositions(mesh.vertices)}}},
                            {"indices", AddIndices(mesh)},
                            {"material", FindOrAddMaterial(object.label)}};
    json extras = {{"id", object.id},
                   {"label", object.label},
                   {"observations", object.estimate.observations},
                   {"half_axes", landmark.half_axes},
                   {"yaw_deg", ComputeYaw(object) * kDegPerRad},
                   {"shape_exponent", landmark.shape_exponents.horizontal},
                   {"vertical_exponent", landmark.shape_exponents.vertical}};
    if (landmark.rests_on != RestingFace::kBottom) {
      extras["rests_on"] = kRestingFaceNames[static_cast<size_t>(landmark.rests_on)];
    }
    if (object.estimate.front_probability) {
      extras["front_probability"] = *object.estimate.front_probability;
    }
    if (object.estimate.covariance) {
      extras["covariance"] = *object.estimate.covariance;
    }
    if (object.verdict) {
      extras["fate"] = object.verdict->fate;
      if (object.verdict->iou) extras["iou"] = *object.verdict->iou;
      if (!object.verdict->reason.empty()) extras["reason"] = object.verdict->reason;
    }
    AddNode({{"name", fmt::format("{} {}", object.label, object.id)},
             {"translation", landmark.Centre()},
             {"rotation", landmark.frame_from_object.rotation.coeffs()},
             {"extras", extras}},
            primitive);
  }

  // Positions are relative to the first centre, to keep their precision far from the world's
  // origin.
  void AddTrajectory(const std::vector<WorldFrame>& frames) {
    const Eigen::Vector3d& first = frames.front().world_from_camera.translation;
    std::vector<Eigen::Vector3d> centres;
    for (const WorldFrame& frame : frames) {
      centres.push_back(frame.world_from_camera.translation - first);
    }
    const json primitive = {{"attributes", {{"POSITION", AddPositions(centres)}}},
                            {"mode", kLineStrip},
                            {"material", AddMaterial(kTrajectory, Colour::Zero())}};
    AddNode({{"name", kTrajectory}, {"translation", first}}, primitive);
  }

  const LabelColours& colours_;
  std::map<std::string, size_t> materials_;  // by label
  json document_;
  std::string buffer_;
};

// Chunks are padded to a multiple of four bytes.
void AppendChunk(std::uint32_t type, std::string content, char padding, std::string* bytes) {
  while (content.size() % 4 != 0) content += padding;
  AppendLittleEndian(static_cast<std::uint32_t>(content.size()), bytes);
  AppendLittleEndian(type, bytes);
  *bytes += content;
}

}  // namespace

std::string GltfText(const World& world, const LabelColours& colours) {
  const GltfBuilder builder(world, colours);
  json document = builder.document();
  if (!builder.buffer().empty()) {
    document["buffers"][0]["uri"] =
        "data:application/octet-stream;base64," + Base64(builder.buffer());
  }
  return document.dump(1) + "\n";
}

std::string GlbBytes(const World& world, const LabelColours& colours) {
  const GltfBuilder builder(world, colours);
  std::string chunks;
  AppendChunk(kJsonChunk, builder.document().dump(), ' ', &chunks);
  if (!builder.buffer().empty()) AppendChunk(kBinaryChunk, builder.buffer(), '\0', &chunks);
  std::string bytes;
  constexpr std::uint32_t kHeaderSize = 12;
  AppendLittleEndian(kGlbMagic, &bytes);
  AppendLittleEndian(kGlbVersion, &bytes);
  AppendLittleEndian(kHeaderSize + static_cast<std::uint32_t>(chunks.size()), &bytes);
  return bytes + chunks;
}

}  // namespace soslam
