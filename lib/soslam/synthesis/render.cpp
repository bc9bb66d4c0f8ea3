// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/synthesis/render.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <random>
#include <utility>

namespace soslam {
namespace {

constexpr int kPatches = 24;    // on the half with y >= 0
constexpr int kCandidates = 8;  // per patch; the one farthest from other patches is taken

// Blue, green, red. Pale enough for an edge detector to find the patches at usual thresholds.
const std::array<Eigen::Vector3d, 5> kBaseColours = {
    Eigen::Vector3d(205, 230, 242), Eigen::Vector3d(240, 226, 208), Eigen::Vector3d(212, 236, 216),
    Eigen::Vector3d(214, 218, 244), Eigen::Vector3d(228, 232, 234)};
const std::array<Eigen::Vector3d, 7> kPatchColours = {
    Eigen::Vector3d(118, 62, 24),  Eigen::Vector3d(48, 34, 168), Eigen::Vector3d(58, 98, 22),
    Eigen::Vector3d(28, 118, 222), Eigen::Vector3d(118, 46, 98), Eigen::Vector3d(124, 104, 0),
    Eigen::Vector3d(44, 40, 40)};

}  // namespace

SurfaceTexture::SurfaceTexture(const SceneObject& object) {
  std::mt19937 random(static_cast<std::mt19937::result_type>(object.texture_seed));
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> relative_radius(0.4, 0.95);
  base_colour_ = kBaseColours[random() % kBaseColours.size()];
  const Eigen::Vector3d& half_axes = object.half_axes;
  constexpr double kShareOfBoundingBox = 0.65;  // of its surface; the ellipsoid's is about half
  const double half_surface = kShareOfBoundingBox * 4.0 *
                              (half_axes.x() * half_axes.y() + half_axes.y() * half_axes.z() +
                               half_axes.z() * half_axes.x());
  // The approximate radius of a disc with the mean area of a patch.
  const double mean_radius = std::sqrt(half_surface / (kPatches * std::numbers::pi));

  while (patches_.size() < kPatches) {
    Eigen::Vector3d best = Eigen::Vector3d::Zero();
    double best_distance = -1.0;
    for (int i = 0; i < kCandidates; ++i) {
      const double x = normal(random), y = normal(random), z = normal(random);
      const Eigen::Vector3d direction(x, std::abs(y), z);
      const Eigen::Vector3d candidate =
          (direction / Gauge(ExponentsOf(object.shape), direction)).cwiseProduct(half_axes);
      double distance = std::numeric_limits<double>::infinity();
      for (const Patch& patch : patches_) {
        distance = std::min(distance, (candidate - patch.centre_in_object).norm());
      }
      if (distance > best_distance) {
        best = candidate;
        best_distance = distance;
      }
    }
    const double radius = mean_radius * relative_radius(random);
    patches_.push_back({best, radius * radius, kPatchColours[random() % kPatchColours.size()]});
  }
}

Eigen::Vector3d SurfaceTexture::Colour(const Eigen::Vector3d& point_in_object) const {
  // A point with y >= 0 in the mirror image of a ball with its centre at y >= 0 is in the ball too.
  const Eigen::Vector3d folded(point_in_object.x(), std::abs(point_in_object.y()),
                               point_in_object.z());
  for (const Patch& patch : patches_) {
    if ((folded - patch.centre_in_object).squaredNorm() <= patch.squared_radius) {
      return patch.colour;
    }
  }
  return base_colour_;
}

namespace {

using Colour = Eigen::Vector3d;  // blue, green, red, grey levels

const Colour kFloorColour(126, 141, 151);
const Colour kTableColour(84, 118, 152);
const Colour kWallColour(176, 183, 186);
const Colour kSkirtingColour(164, 171, 174);
const Colour kHazeColour(214, 208, 202);
constexpr double kHazeDistance = 40.0;    // metres, at which 1/e of the colour is left
constexpr double kSkirtingHeight = 0.09;  // metres
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double SmoothStep(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

// A pseudo-random number in [-1, 1), the same for the same cell.
double CellNoise(int x, int y) {
  uint32_t hash = static_cast<uint32_t>(x) * 0x8da6b343u ^ static_cast<uint32_t>(y) * 0xd8163841u;
  hash = (hash ^ (hash >> 15)) * 0x2c1b3c6du;
  hash = (hash ^ (hash >> 12)) * 0x297a2d39u;
  return static_cast<double>(hash ^ (hash >> 15)) / 2147483648.0 - 1.0;
}

// Tiles of half a metre, in grey levels about 0; fades with distance, where it would alias.
double TilePattern(const Eigen::Vector3d& point_in_plane, double distance) {
  constexpr double kTile = 0.5;
  constexpr double kHalfJoint = 0.004;
  constexpr double kFadeDistance = 4.0;
  constexpr double kMaxDistance = 100.0;  // beyond it the pattern has faded
  if (distance > kMaxDistance) return 0.0;
  const Eigen::Array2d scaled = point_in_plane.head<2>().array() / kTile;
  const Eigen::Array2d cell = scaled.floor();
  const double to_joint = kTile * (0.5 - (scaled - cell - 0.5).abs().maxCoeff());
  const double joint = to_joint < kHalfJoint ? -14.0 : 0.0;
  const double tile = 4.0 * CellNoise(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
  const double relative_distance = distance / kFadeDistance;
  return (tile + joint) / (1.0 + relative_distance * relative_distance);
}

// Wood grain along the plane's x axis, grey levels about 0.
double GrainPattern(const Eigen::Vector3d& point_in_plane) {
  const double x = point_in_plane.x();
  const double y = point_in_plane.y();
  return 3.0 * std::sin(70.0 * y + 4.0 * std::sin(3.0 * x + 5.0 * y)) + 2.0 * std::sin(23.0 * y);
}

// The depth at which a ray meets the front of a plane.
double PlaneDepth(const Plane& plane, const Eigen::Vector3d& origin,
                  const Eigen::Vector3d& direction) {
  const double approach = -plane.normal.dot(direction);
  return approach > 0.0 ? plane.SignedDistance(origin) / approach : kInfinity;
}

// Appearance of the scene apart from its objects: floors, walls and tables in faint textures that
// an edge detector overlooks, under one soft light. Keeps a reference to the scene.
class Surroundings {
 public:
  explicit Surroundings(const Scene& scene) : scene_(scene) {
    for (const ScenePlane& plane : scene.planes) {
      plane_from_world_.push_back(WorldFromPlane(plane.plane_in_world).Inverse());
    }
    // Light from above, a little from the side, so that the faces of a box differ.
    light_in_world_ = WorldFromPlane(scene.planes.at(0).plane_in_world).rotation *
                      Eigen::Vector3d(-0.42, -0.25, 0.87).normalized();
  }

  // Brightness of a surface with that normal, as a factor on its colour, at most 1.
  double Light(const Eigen::Vector3d& normal_in_world) const {
    return 0.84 + 0.16 * normal_in_world.dot(light_in_world_);
  }

  // Lit colour of a table at a point of its surface.
  Colour TableColour(const Eigen::Vector3d& point_in_world,
                     const Eigen::Vector3d& normal_in_world) const {
    constexpr double kTolerance = 1e-6;  // metres: rounding, far less than a table's thickness
    const double light = Light(normal_in_world);
    for (size_t i = 0; i < scene_.planes.size(); ++i) {
      const Plane& plane_in_world = scene_.planes[i].plane_in_world;
      const bool is_top = scene_.planes[i].table &&
                          normal_in_world.dot(plane_in_world.normal) > 0.5 &&
                          std::abs(plane_in_world.SignedDistance(point_in_world)) < kTolerance;
      if (!is_top) continue;
      const Eigen::Vector3d point_in_plane = plane_from_world_[i] * point_in_world;
      return light * ContactShadow(static_cast<int>(i), point_in_plane) *
             (kTableColour.array() + GrainPattern(point_in_plane)).matrix();
    }
    return light * kTableColour;
  }

  // Lit colour of the floor or wall that a ray meets first, or of the haze.
  Colour BackgroundColour(const Eigen::Vector3d& origin_in_world,
                          const Eigen::Vector3d& direction_in_world) const {
    const Eigen::Vector3d direction = direction_in_world.normalized();
    double distance = kInfinity;
    Colour colour = kHazeColour;
    for (size_t i = 0; i < scene_.planes.size(); ++i) {
      const double depth = PlaneDepth(scene_.planes[i].plane_in_world, origin_in_world, direction);
      if (scene_.planes[i].table || !(depth < distance)) continue;
      distance = depth;
      const Eigen::Vector3d point_in_plane =
          plane_from_world_[i] * Eigen::Vector3d(origin_in_world + depth * direction);
      colour = ContactShadow(static_cast<int>(i), point_in_plane) *
               (kFloorColour.array() + TilePattern(point_in_plane, depth)).matrix();
    }
    for (const Plane& wall_in_world : scene_.walls_in_world) {
      const double depth = PlaneDepth(wall_in_world, origin_in_world, direction);
      if (!(depth < distance)) continue;
      distance = depth;
      const double height =
          scene_.planes[0].plane_in_world.SignedDistance(origin_in_world + depth * direction);
      const double light = 0.95 + 0.07 * wall_in_world.normal.dot(light_in_world_) +
                           0.03 * SmoothStep(0.0, 2.5, height);
      colour = light * (height < kSkirtingHeight ? kSkirtingColour : kWallColour);
    }
    const double clarity = std::exp(-distance / kHazeDistance);
    return clarity * colour + (1.0 - clarity) * kHazeColour;
  }

 private:
  // Soft shadow under and around the objects on the plane, as a factor on its colour.
  double ContactShadow(int plane_index, const Eigen::Vector3d& point_in_plane) const {
    double shadow = 1.0;
    for (const SceneObject& object : scene_.objects) {
      if (object.plane_index != plane_index) continue;
      const Eigen::Vector2d from_object =
          Eigen::Rotation2Dd(-object.yaw) * (point_in_plane.head<2>() - object.position_on_plane);
      const double distance = from_object.cwiseQuotient(object.half_axes.head<2>()).norm();
      shadow *= 1.0 - 0.3 * (1.0 - SmoothStep(0.2, 1.5, distance));
    }
    return shadow;
  }

  const Scene& scene_;
  std::vector<Rigid3d> plane_from_world_;  // one per plane of the scene
  Eigen::Vector3d light_in_world_;
};

constexpr int kSamplesPerSide = 3;

struct Solid {
  Landmark body_in_camera;
  Rigid3d object_from_camera;
  std::optional<SurfaceTexture> texture;  // none for a table
  std::optional<Box> outline;             // none if it may be anywhere in the image

  bool MayCover(int u, int v) const {
    return !outline || (outline->x_min <= u + 0.5 && outline->x_max >= u - 0.5 &&
                        outline->y_min <= v + 0.5 && outline->y_max >= v - 0.5);
  }
};

using Solids = std::vector<const Solid*>;

// The solids of a scene, those of its objects first.
std::vector<Solid> MakeSolids(const Scene& scene, const Rigid3d& world_from_camera) {
  std::vector<Solid> solids;
  for (const Landmark& body_in_world : AllBodies(scene)) {
    const Landmark body_in_camera = Transform(world_from_camera.Inverse(), body_in_world);
    Solid solid{body_in_camera, body_in_camera.frame_from_object.Inverse(), std::nullopt,
                ExactOutline(scene.camera, body_in_camera)};
    if (solids.size() < scene.objects.size()) solid.texture.emplace(scene.objects[solids.size()]);
    solids.push_back(std::move(solid));
  }
  return solids;
}

Colour RayColour(const Surroundings& surroundings, const Rigid3d& world_from_camera,
                 const Solids& solids, const Eigen::Vector3d& ray_in_camera) {
  double depth = kInfinity;
  const Solid* nearest = nullptr;
  for (const Solid* solid : solids) {
    const auto hit =
        NearestIntersection(solid->body_in_camera, Eigen::Vector3d::Zero(), ray_in_camera);
    if (hit && *hit < depth) {
      depth = *hit;
      nearest = solid;
    }
  }
  if (!nearest) {
    return surroundings.BackgroundColour(world_from_camera.translation,
                                         world_from_camera.rotation * ray_in_camera);
  }
  const Eigen::Vector3d point_in_camera = depth * ray_in_camera;
  const Eigen::Vector3d point_in_object = nearest->object_from_camera * point_in_camera;
  const Eigen::Vector3d normal_in_camera = nearest->body_in_camera.frame_from_object.rotation *
                                           OutwardNormal(nearest->body_in_camera, point_in_object);
  const Eigen::Vector3d normal_in_world = world_from_camera.rotation * normal_in_camera;
  if (!nearest->texture) {
    return surroundings.TableColour(world_from_camera * point_in_camera, normal_in_world);
  }
  return surroundings.Light(normal_in_world) * nearest->texture->Colour(point_in_object);
}

}  // namespace

cv::Mat RenderFrame(const Scene& scene, const Rigid3d& world_from_camera) {
  const Camera& camera = scene.camera;
  const Surroundings surroundings(scene);
  const std::vector<Solid> solids = MakeSolids(scene, world_from_camera);
  cv::Mat image(camera.height, camera.width, CV_8UC3);
  Solids in_pixel;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      in_pixel.clear();
      for (const Solid& solid : solids) {
        if (solid.MayCover(u, v)) in_pixel.push_back(&solid);
      }
      Colour sum = Colour::Zero();
      for (int i = 0; i < kSamplesPerSide * kSamplesPerSide; ++i) {
        const int row = i / kSamplesPerSide, column = i % kSamplesPerSide;
        const Eigen::Vector2d offset((column + 0.5) / kSamplesPerSide - 0.5,
                                     (row + 0.5) / kSamplesPerSide - 0.5);
        sum += RayColour(surroundings, world_from_camera, in_pixel,
                         camera.Ray(Eigen::Vector2d(u, v) + offset));
      }
      const Colour colour = sum / (kSamplesPerSide * kSamplesPerSide);
      for (int channel = 0; channel < 3; ++channel) {
        image.at<cv::Vec3b>(v, u)[channel] = cv::saturate_cast<uchar>(colour[channel]);
      }
    }
  }
  return image;
}

}  // namespace soslam
