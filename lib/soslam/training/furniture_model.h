// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/training/random.h"

namespace soslam {

// A model of a furniture library of Sweet Home 3D, as its catalogue lists it.
struct FurnitureEntry {
  std::string collection;  // the library: "Scopia"
  std::string name;
  std::string category;
  std::string creator;
  std::filesystem::path mesh;  // .obj
  Eigen::Vector3d size;        // along x (front), y, z (up), metres
  Eigen::Matrix3d own_from_file = Eigen::Matrix3d::Identity();  // rotation of the file's axes
};

inline constexpr const char* kCatalogueFile = "PluginFurnitureCatalog.properties";

// The entries of an unpacked library, which is a folder with a kCatalogueFile. Throws InputError.
std::vector<FurnitureEntry> ReadFurnitureLibrary(const std::filesystem::path& folder);

struct Material {
  Eigen::Vector3f colour = Eigen::Vector3f::Constant(0.7f);  // blue, green, red, 0 .. 1
  float gloss = 0.0f;
  cv::Mat texture = {};  // 8-bit blue, green, red; empty: the colour alone
};

// Triangles in the object frame: x front, z up, the origin in the middle of the base, metres.
struct FurnitureModel {
  struct Corner {
    Eigen::Vector3f position;
    Eigen::Vector3f normal;  // unit
    Eigen::Vector2f texture;
  };
  std::string name;
  Eigen::Vector3f size = Eigen::Vector3f::Zero();
  std::vector<Corner> corners;  // three of each triangle
  std::vector<int> materials_of_triangles;
  std::vector<Material> materials;
};

// Reads the mesh of an entry (Wavefront OBJ, with materials and textures beside it), scaled to its
// size. Throws InputError for one without triangles.
FurnitureModel ReadFurnitureModel(const FurnitureEntry& entry);

// A random model of a kind of which libraries have few, of boxes and cylinders: "office chair",
// "cantilever chair", "shell chair", "sofa", "monitor", "laptop", "keyboard", "cabinet",
// "refrigerator", "desk", "bed". None for another kind.
std::optional<FurnitureModel> ParametricModel(const std::string& kind, Random* random);

}  // namespace soslam
