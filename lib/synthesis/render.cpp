// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/render.h"

#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "synthesis/surroundings.h"
#include "synthesis/texture.h"

namespace soslam {
namespace {

using Colour = Eigen::Vector3d;  // blue, green, red, grey levels

constexpr int kSamplesPerSide = 3;

struct Solid {
  Body body_in_camera;
  Rigid3d object_from_camera;
  std::optional<SurfaceTexture> texture;  // none for a table
  std::optional<Box> outline;             // none if it may be anywhere in the image

  bool MayCoverRow(int v) const {
    return !outline || (outline->y_min <= v + 0.5 && outline->y_max >= v - 0.5);
  }
  bool MayCoverColumn(int u) const {
    return !outline || (outline->x_min <= u + 0.5 && outline->x_max >= u - 0.5);
  }
};

using Solids = std::vector<const Solid*>;

class FrameRenderer {
 public:
  FrameRenderer(const Scene& scene, const Rigid3d& world_from_camera)
      : camera_(scene.camera), surroundings_(scene), world_from_camera_(world_from_camera) {
    for (const SceneObject& object : scene.objects) {
      AddSolid(ObjectBody(scene, object), SurfaceTexture(object));
    }
    for (const Body& body : Furniture(scene)) AddSolid(body, std::nullopt);
  }

  void RenderRow(int v, cv::Vec3b* row) const {
    Solids in_row;
    for (const Solid& solid : solids_) {
      if (solid.MayCoverRow(v)) in_row.push_back(&solid);
    }
    Solids in_pixel;
    for (int u = 0; u < camera_.width; ++u) {
      in_pixel.clear();
      for (const Solid* solid : in_row) {
        if (solid->MayCoverColumn(u)) in_pixel.push_back(solid);
      }
      const Colour colour = PixelColour(u, v, in_pixel);
      for (int channel = 0; channel < 3; ++channel) {
        row[u][channel] = cv::saturate_cast<uchar>(colour[channel]);
      }
    }
  }

 private:
  void AddSolid(const Body& body_in_world, std::optional<SurfaceTexture> texture) {
    const Body body_in_camera = Transform(world_from_camera_.Inverse(), body_in_world);
    solids_.push_back({body_in_camera, body_in_camera.landmark.frame_from_object.Inverse(),
                       std::move(texture), OutlineBox(camera_, body_in_camera)});
  }

  Colour PixelColour(int u, int v, const Solids& solids) const {
    Colour sum = Colour::Zero();
    for (int i = 0; i < kSamplesPerSide * kSamplesPerSide; ++i) {
      const Eigen::Vector2d offset((i % kSamplesPerSide + 0.5) / kSamplesPerSide - 0.5,
                                   (i / kSamplesPerSide + 0.5) / kSamplesPerSide - 0.5);
      sum += RayColour(camera_.Ray(Eigen::Vector2d(u, v) + offset), solids);
    }
    return sum / (kSamplesPerSide * kSamplesPerSide);
  }

  Colour RayColour(const Eigen::Vector3d& ray_in_camera, const Solids& solids) const {
    double depth = std::numeric_limits<double>::infinity();
    const Solid* nearest = nullptr;
    for (const Solid* solid : solids) {
      const auto hit =
          NearestIntersection(solid->body_in_camera, Eigen::Vector3d::Zero(), ray_in_camera);
      if (hit && *hit < depth) {
        depth = *hit;
        nearest = solid;
      }
    }
    if (nearest) return SolidColour(*nearest, depth * ray_in_camera);
    return surroundings_.BackgroundColour(world_from_camera_.translation,
                                          world_from_camera_.rotation * ray_in_camera);
  }

  Colour SolidColour(const Solid& solid, const Eigen::Vector3d& point_in_camera) const {
    const Eigen::Vector3d point_in_object = solid.object_from_camera * point_in_camera;
    const Eigen::Vector3d normal_in_camera =
        solid.body_in_camera.landmark.frame_from_object.rotation *
        OutwardNormal(solid.body_in_camera, point_in_object);
    const Eigen::Vector3d normal_in_world = world_from_camera_.rotation * normal_in_camera;
    if (!solid.texture) {
      return surroundings_.TableColour(world_from_camera_ * point_in_camera, normal_in_world);
    }
    return surroundings_.Light(normal_in_world) * solid.texture->Colour(point_in_object);
  }

  Camera camera_;
  Surroundings surroundings_;
  Rigid3d world_from_camera_;
  std::vector<Solid> solids_;
};

}  // namespace

cv::Mat RenderFrame(const Scene& scene, const Rigid3d& world_from_camera) {
  const FrameRenderer renderer(scene, world_from_camera);
  cv::Mat image(scene.camera.height, scene.camera.width, CV_8UC3);
  for (int v = 0; v < image.rows; ++v) renderer.RenderRow(v, image.ptr<cv::Vec3b>(v));
  return image;
}

}  // namespace soslam
