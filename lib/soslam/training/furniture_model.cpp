// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/training/furniture_model.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

#include "soslam/base/error.h"
#include "soslam/base/text.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

std::ifstream Open(const fs::path& path) {
  std::ifstream stream(path);
  if (!stream) throw InputError(path.string() + ": cannot be read");
  return stream;
}

// The rest of a line without spaces at its ends.
std::string Rest(std::istream& line) {
  std::string rest;
  std::getline(line, rest);
  return std::string(Trimmed(rest));
}

// Materials in a file of Wavefront's, by name.
std::map<std::string, Material> ReadMaterials(const fs::path& path) {
  constexpr int kMaxTextureSide = 256;
  std::map<std::string, Material> materials;
  if (!fs::exists(path)) return materials;
  std::ifstream stream = Open(path);
  Material* material = nullptr;
  for (std::string text; std::getline(stream, text);) {
    std::istringstream line(text);
    std::string key;
    line >> key;
    if (key == "newmtl") material = &materials[Rest(line)];
    if (material == nullptr) continue;
    if (key == "Kd") {
      line >> material->colour.z() >> material->colour.y() >> material->colour.x();
    } else if (key == "Ks") {
      line >> material->gloss;
    } else if (key == "map_Kd") {
      const fs::path texture = path.parent_path() / Rest(line);
      if (fs::exists(texture)) material->texture = cv::imread(texture.string());
      const int side = std::max(material->texture.cols, material->texture.rows);
      if (side > kMaxTextureSide) {
        const double scale = static_cast<double>(kMaxTextureSide) / side;
        cv::resize(material->texture, material->texture, {}, scale, scale, cv::INTER_AREA);
      }
    }
  }
  return materials;
}

// Indices into positions, texture coordinates and normals of a corner "7/2/5", "7//5" or "7"; -1
// for one that is not given. Negative ones count from the end.
std::array<int, 3> CornerIndices(const std::string& word, const std::array<size_t, 3>& counts) {
  std::array<int, 3> indices = {-1, -1, -1};
  std::istringstream stream(word);
  std::string field;
  for (size_t i = 0; i < 3 && std::getline(stream, field, '/'); ++i) {
    const int number = std::atoi(field.c_str());
    if (number == 0) continue;
    indices[i] = number > 0 ? number - 1 : static_cast<int>(counts[i]) + number;
    if (indices[i] < 0 || indices[i] >= static_cast<int>(counts[i])) indices[i] = -1;
  }
  return indices;
}

}  // namespace

std::vector<FurnitureEntry> ReadFurnitureLibrary(const fs::path& folder) {
  const fs::path path = folder / kCatalogueFile;
  std::ifstream stream = Open(path);
  std::map<int, std::map<std::string, std::string>> fields;  // by the entry's number
  for (std::string text; std::getline(stream, text);) {
    const size_t hash = text.find('#'), equals = text.find('=');
    if (hash == 0 || hash == text.npos || equals == text.npos || hash > equals) continue;
    while (!text.empty() && text.back() == '\r') text.pop_back();
    fields[std::atoi(text.c_str() + hash + 1)][text.substr(0, hash)] = text.substr(equals + 1);
  }
  std::vector<FurnitureEntry> entries;
  for (auto& [number, field] : fields) {
    if (!field.contains("model") || !field.contains("name")) continue;
    FurnitureEntry entry{
        folder.filename().string(),
        field["name"],
        field["category"],
        field["creator"],
        folder / field["model"].substr(1),
        Eigen::Vector3d(std::atof(field["depth"].c_str()), std::atof(field["width"].c_str()),
                        std::atof(field["height"].c_str())) /
            100.0};
    if (!(entry.size.minCoeff() > 0.0)) {
      throw InputError(fmt::format("{}: model {} has no size", path.string(), number));
    }
    if (field.contains("modelRotation")) {
      std::istringstream numbers(field["modelRotation"]);
      for (int i = 0; i < 9; ++i) numbers >> entry.own_from_file(i / 3, i % 3);
    }
    entries.push_back(std::move(entry));
  }
  return entries;
}

namespace {

// A mesh as in its file, but with the axes of the object; three corners of each triangle.
struct ObjMesh {
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<Eigen::Vector2f> textures;
  std::vector<std::array<int, 3>> corners;  // see CornerIndices
  std::vector<int> materials_of_triangles;
  std::vector<Material> materials;

  Eigen::Vector3f FaceNormal(size_t first) const {  // its length is twice the area
    const Eigen::Vector3f& a = positions[corners[first][0]];
    return (positions[corners[first + 1][0]] - a).cross(positions[corners[first + 2][0]] - a);
  }
};

ObjMesh ReadMesh(const FurnitureEntry& entry) {
  Eigen::Matrix3f object_from_obj;  // from y up, z front
  object_from_obj << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  const Eigen::Matrix3f object_from_file = object_from_obj * entry.own_from_file.cast<float>();
  ObjMesh mesh;
  std::map<std::string, Material> materials;
  std::map<std::string, int> index_of_material;
  int material = -1;
  std::ifstream stream = Open(entry.mesh);
  for (std::string text; std::getline(stream, text);) {
    std::istringstream line(text);
    std::string key;
    line >> key;
    if (key == "v" || key == "vn") {
      Eigen::Vector3f v = Eigen::Vector3f::Zero();
      line >> v.x() >> v.y() >> v.z();
      (key == "v" ? mesh.positions : mesh.normals).push_back(object_from_file * v);
    } else if (key == "vt") {
      Eigen::Vector2f v = Eigen::Vector2f::Zero();
      line >> v.x() >> v.y();
      mesh.textures.push_back(v);
    } else if (key == "mtllib") {
      materials.merge(ReadMaterials(entry.mesh.parent_path() / Rest(line)));
    } else if (key == "usemtl") {
      const std::string name = Rest(line);
      const auto [found, is_new] =
          index_of_material.try_emplace(name, static_cast<int>(mesh.materials.size()));
      if (is_new) mesh.materials.push_back(materials[name]);
      material = found->second;
    } else if (key == "f") {
      if (material < 0) {
        material = static_cast<int>(mesh.materials.size());
        mesh.materials.emplace_back();
      }
      std::vector<std::array<int, 3>> polygon;
      for (std::string word; line >> word;) {
        polygon.push_back(CornerIndices(
            word, {mesh.positions.size(), mesh.textures.size(), mesh.normals.size()}));
      }
      std::erase_if(polygon, [](const std::array<int, 3>& corner) { return corner[0] < 0; });
      for (size_t i = 2; i < polygon.size(); ++i) {
        mesh.corners.insert(mesh.corners.end(), {polygon[0], polygon[i - 1], polygon[i]});
        mesh.materials_of_triangles.push_back(material);
      }
    }
  }
  if (mesh.corners.empty()) throw InputError(entry.mesh.string() + ": has no triangle");
  return mesh;
}

}  // namespace

FurnitureModel ReadFurnitureModel(const FurnitureEntry& entry) {
  const ObjMesh mesh = ReadMesh(entry);
  FurnitureModel model{
      entry.name, entry.size.cast<float>(), {}, mesh.materials_of_triangles, mesh.materials};
  // Normals of corners that have none: the mean of the faces about the point, or the face's own
  // where these differ much (an edge).
  std::vector<Eigen::Vector3f> means(mesh.positions.size(), Eigen::Vector3f::Zero());
  Eigen::AlignedBox3f extent;
  for (size_t i = 0; i < mesh.corners.size(); ++i) {
    means[mesh.corners[i][0]] += mesh.FaceNormal(i - i % 3);
    extent.extend(mesh.positions[mesh.corners[i][0]]);
  }
  const Eigen::Vector3f scale =
      model.size.cwiseQuotient(extent.sizes().cwiseMax(Eigen::Vector3f::Constant(1e-6f)));
  const Eigen::Vector3f origin(extent.center().x(), extent.center().y(), extent.min().z());
  for (size_t i = 0; i < mesh.corners.size(); ++i) {
    const auto [position, texture, normal] = mesh.corners[i];
    Eigen::Vector3f n;
    if (normal >= 0 && mesh.normals[normal].norm() > 1e-6f) {
      n = mesh.normals[normal];
    } else {
      constexpr float kSmooth = 0.75f;  // cosine of the angle between faces that count as one
      const Eigen::Vector3f own = mesh.FaceNormal(i - i % 3).stableNormalized();
      const Eigen::Vector3f mean = means[position].stableNormalized();
      n = mean.dot(own) > kSmooth ? mean : own;
    }
    model.corners.push_back({(mesh.positions[position] - origin).cwiseProduct(scale),
                             n.cwiseQuotient(scale).stableNormalized(),
                             texture >= 0 ? mesh.textures[texture] : Eigen::Vector2f::Zero()});
  }
  return model;
}

}  // namespace soslam
