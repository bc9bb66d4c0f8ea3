// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/training/rasterise.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

namespace soslam {

Rasteriser::Rasteriser(const Camera& camera, const Rigid3d& camera_from_world)
    : colour(camera.height, camera.width, CV_32FC3, cv::Scalar::all(0)),
      inverse_depth(camera.height, camera.width, CV_32F, cv::Scalar(0)),
      number(camera.height, camera.width, CV_8U, cv::Scalar(0)),
      camera_(camera),
      camera_from_world_(camera_from_world.rotation.toRotationMatrix().cast<float>()),
      translation_(camera_from_world.translation.cast<float>()) {}

Eigen::Vector3f Rasteriser::RayInWorld(int u, int v) const {
  return camera_from_world_.transpose() * camera_.Ray(Eigen::Vector2d(u, v)).cast<float>();
}

Eigen::Vector3f Rasteriser::CentreInWorld() const {
  return -(camera_from_world_.transpose() * translation_);
}

// Calls paint(u, v, inverse depth, weights of the corners) for each pixel whose centre is in the
// triangle; the weights are those of the triangle in space.
template <typename Paint>
void Rasteriser::Fill(const Eigen::Vector3f (&in_camera)[3], const Paint& paint) {
  constexpr float kNearest = 0.05f;  // metres
  Eigen::Vector3f u, v, w;
  for (int i = 0; i < 3; ++i) {
    if (in_camera[i].z() < kNearest) return;
    w[i] = 1.0f / in_camera[i].z();
    u[i] =
        static_cast<float>(camera_.fx) * in_camera[i].x() * w[i] + static_cast<float>(camera_.cx);
    v[i] =
        static_cast<float>(camera_.fy) * in_camera[i].y() * w[i] + static_cast<float>(camera_.cy);
  }
  const float area = (u[1] - u[0]) * (v[2] - v[0]) - (u[2] - u[0]) * (v[1] - v[0]);
  if (!(std::abs(area) > 1e-9f)) return;
  const auto first = [](float x) { return static_cast<int>(std::ceil(std::max(x, 0.0f))); };
  const auto last = [](float x, int size) {
    return static_cast<int>(std::floor(std::min(x, static_cast<float>(size - 1))));
  };
  for (int y = first(v.minCoeff()); y <= last(v.maxCoeff(), camera_.height); ++y) {
    for (int x = first(u.minCoeff()); x <= last(u.maxCoeff(), camera_.width); ++x) {
      Eigen::Vector3f share;  // barycentric, in the image
      for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        share[i] = ((u[j] - static_cast<float>(x)) * (v[k] - static_cast<float>(y)) -
                    (u[k] - static_cast<float>(x)) * (v[j] - static_cast<float>(y))) /
                   area;
      }
      if (share.minCoeff() < 0.0f) continue;
      const float inverse = share.dot(w);
      paint(x, y, inverse, Eigen::Vector3f(share.cwiseProduct(w) / inverse));
    }
  }
}

void Rasteriser::Draw(const PlacedModel& placed, const Lighting& lighting,
                      unsigned char own_number) {
  const FurnitureModel& model = *placed.model;
  const Eigen::Matrix3f linear = placed.world_from_object.linear();
  const Eigen::Matrix3f normals = linear.inverse().transpose();
  const Eigen::Vector3f centre = CentreInWorld();
  for (size_t i = 0; i < model.materials_of_triangles.size(); ++i) {
    const FurnitureModel::Corner* corners = &model.corners[3 * i];
    const Material& material = placed.materials[model.materials_of_triangles[i]];
    Eigen::Vector3f in_camera[3], in_world[3];
    for (int j = 0; j < 3; ++j) {
      in_world[j] = placed.world_from_object * corners[j].position;
      in_camera[j] = camera_from_world_ * in_world[j] + translation_;
    }
    Fill(in_camera, [&](int x, int y, float inverse, const Eigen::Vector3f& weights) {
      float& nearest = inverse_depth.at<float>(y, x);
      if (inverse <= nearest) return;
      nearest = inverse;
      number.at<uchar>(y, x) = own_number;
      Eigen::Vector3f point = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
      Eigen::Vector2f texture = Eigen::Vector2f::Zero();
      for (int j = 0; j < 3; ++j) {
        point += weights[j] * in_world[j];
        normal += weights[j] * corners[j].normal;
        texture += weights[j] * corners[j].texture;
      }
      const Eigen::Vector3f to_camera = (centre - point).normalized();
      normal = (normals * normal).stableNormalized();
      if (normal.dot(to_camera) < 0.0f) normal = -normal;  // meshes are seen from both sides
      const float up = 0.5f + 0.5f * normal.z();
      Eigen::Vector3f light = up * lighting.from_above + (1.0f - up) * lighting.from_below;
      float glint = 0.0f;
      for (const Light& source : lighting.lights) {
        light += std::max(0.0f, normal.dot(source.towards_in_world)) * source.colour;
        const Eigen::Vector3f half = (source.towards_in_world + to_camera).normalized();
        glint += std::pow(std::max(0.0f, normal.dot(half)), 30.0f);
      }
      Eigen::Vector3f own = material.colour;
      if (!material.texture.empty()) {
        // Textures repeat beyond coordinates of 0 .. 1.
        const auto pixel = [](float at, int size) {
          const float share = at - std::floor(at);
          return std::clamp(static_cast<int>(share * static_cast<float>(size)), 0, size - 1);
        };
        const cv::Vec3b& bgr = material.texture.at<cv::Vec3b>(
            pixel(-texture.y(), material.texture.rows), pixel(texture.x(), material.texture.cols));
        own = own.cwiseProduct(Eigen::Vector3f(bgr[0], bgr[1], bgr[2]) / 255.0f);
      }
      const Eigen::Vector3f seen =
          255.0f * (own.cwiseProduct(light) + Eigen::Vector3f::Constant(material.gloss * glint));
      colour.at<cv::Vec3f>(y, x) = {seen.x(), seen.y(), seen.z()};
    });
  }
}

void Rasteriser::DrawShadow(const PlacedModel& placed, const Eigen::Vector3f& towards_light,
                            cv::Mat* mask) {
  const FurnitureModel& model = *placed.model;
  for (size_t i = 0; i < model.materials_of_triangles.size(); ++i) {
    Eigen::Vector3f in_camera[3];
    for (int j = 0; j < 3; ++j) {
      Eigen::Vector3f point = placed.world_from_object * model.corners[3 * i + j].position;
      point -= point.z() / towards_light.z() * towards_light;
      in_camera[j] = camera_from_world_ * point + translation_;
    }
    Fill(in_camera,
         [&](int x, int y, float, const Eigen::Vector3f&) { mask->at<uchar>(y, x) = 255; });
  }
}

}  // namespace soslam
