// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/training/furniture_model.h"

namespace soslam {

struct Light {
  Eigen::Vector3f towards_in_world;  // unit
  Eigen::Vector3f colour;            // blue, green, red
};

struct Lighting {
  std::vector<Light> lights;
  Eigen::Vector3f from_above;  // ambient colours
  Eigen::Vector3f from_below;
};

// A model at a place in the world, of which z = 0 is the floor.
struct PlacedModel {
  const FurnitureModel* model;
  Eigen::Affine3f world_from_object;
  std::vector<Material> materials;  // in place of the model's
};

// A pinhole camera's image of models: colours (blue, green, red; 32-bit float), inverse depth (0
// where there is nothing) and the number of the model (0 where there is none).
class Rasteriser {
 public:
  Rasteriser(const Camera& camera, const Rigid3d& camera_from_world);

  // Triangles that reach behind the camera are left out.
  void Draw(const PlacedModel& placed, const Lighting& lighting, unsigned char number);
  // The pixels of the floor that the model's shadow falls on become 255 in `mask`.
  void DrawShadow(const PlacedModel& placed, const Eigen::Vector3f& towards_light, cv::Mat* mask);

  Eigen::Vector3f RayInWorld(int u, int v) const;
  Eigen::Vector3f CentreInWorld() const;

  cv::Mat colour, inverse_depth, number;

 private:
  template <typename Paint>
  void Fill(const Eigen::Vector3f (&in_camera)[3], const Paint& paint);

  Camera camera_;
  Eigen::Matrix3f camera_from_world_;
  Eigen::Vector3f translation_;
};

}  // namespace soslam
