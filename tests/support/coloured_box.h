// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "soslam/training/furniture_model.h"

namespace soslam {

// Adds an axis-aligned box to a model.
inline void AddColouredBox(const Eigen::Vector3f& min, const Eigen::Vector3f& max,
                           const Eigen::Vector3f& colour, FurnitureModel* model) {
  const Eigen::Vector3f centre = 0.5f * (min + max), half = 0.5f * (max - min);
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      const Eigen::Vector3f normal = side * Eigen::Vector3f::Unit(axis);
      const Eigen::Vector3f u = Eigen::Vector3f::Unit((axis + 1) % 3);
      const Eigen::Vector3f v = Eigen::Vector3f::Unit((axis + 2) % 3);
      for (const auto& [a, b] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1),
                                 std::pair(-1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
        model->corners.push_back({centre + half.cwiseProduct(normal + static_cast<float>(a) * u +
                                                             static_cast<float>(b) * v),
                                  normal, Eigen::Vector2f::Zero()});
      }
      model->materials_of_triangles.insert(model->materials_of_triangles.end(), 2,
                                           static_cast<int>(model->materials.size()));
    }
  }
  model->materials.push_back({colour});
}

// A box whose front half, where x is positive, has one colour, and the rear half another one.
inline FurnitureModel TwoColouredBox(const Eigen::Vector3f& size, const Eigen::Vector3f& front,
                                     const Eigen::Vector3f& rear) {
  FurnitureModel model;
  model.name = "box";
  model.size = size;
  const Eigen::Vector3f corner(0.5f * size.x(), 0.5f * size.y(), size.z());
  AddColouredBox({0.0f, -corner.y(), 0.0f}, corner, front, &model);
  AddColouredBox({-corner.x(), -corner.y(), 0.0f}, {0.0f, corner.y(), corner.z()}, rear, &model);
  return model;
}

}  // namespace soslam
