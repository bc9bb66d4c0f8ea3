// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/synthesis/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "soslam/geometry/angles.h"

namespace soslam {
namespace {

// The part of a body that a camera sees, in rays through the centres of pixels.
struct VisiblePart {
  int silhouette = 0;  // rays that meet the body, inside and outside the image
  int visible = 0;     // rays inside the image that meet it first
  Eigen::AlignedBox2d pixels;
};

// The visible part of each body. Silhouettes are counted as far as three images reach in each
// direction, the camera's own in their middle.
std::vector<VisiblePart> VisibleParts(const Camera& camera,
                                      const std::vector<Landmark>& bodies_in_camera) {
  const Box counted = {-1.0 * camera.width, -1.0 * camera.height, 2.0 * camera.width - 1.0,
                       2.0 * camera.height - 1.0};
  std::vector<VisiblePart> parts(bodies_in_camera.size());
  Eigen::ArrayXXi nearest = Eigen::ArrayXXi::Constant(camera.height, camera.width, -1);
  Eigen::ArrayXXd depths = Eigen::ArrayXXd::Constant(camera.height, camera.width,
                                                     std::numeric_limits<double>::infinity());
  for (size_t i = 0; i < parts.size(); ++i) {
    const Landmark& body = bodies_in_camera[i];
    if (body.Centre().z() + body.half_axes.norm() <= 0.0) continue;  // behind the camera
    const Box outline = ExactOutline(camera, body).value_or(counted);
    const int u_begin =
        static_cast<int>(std::ceil(std::clamp(outline.x_min, counted.x_min, counted.x_max + 1.0)));
    const int v_begin =
        static_cast<int>(std::ceil(std::clamp(outline.y_min, counted.y_min, counted.y_max + 1.0)));
    for (int v = v_begin; v <= std::min(outline.y_max, counted.y_max); ++v) {
      for (int u = u_begin; u <= std::min(outline.x_max, counted.x_max); ++u) {
        const auto depth = NearestIntersection(body, Eigen::Vector3d::Zero(), camera.Ray({u, v}));
        if (!depth) continue;
        ++parts[i].silhouette;
        const bool is_inside = u >= 0 && v >= 0 && u < camera.width && v < camera.height;
        if (!is_inside || *depth >= depths(v, u)) continue;
        depths(v, u) = *depth;
        nearest(v, u) = static_cast<int>(i);
      }
    }
  }
  for (int u = 0; u < camera.width; ++u) {
    for (int v = 0; v < camera.height; ++v) {
      if (nearest(v, u) < 0) continue;
      VisiblePart& part = parts[nearest(v, u)];
      ++part.visible;
      part.pixels.extend(Eigen::Vector2d(u, v));
    }
  }
  return parts;
}

// The exact boxes of a frame.
std::vector<SimulatedBox> BoxesInSight(const Scene& scene, int frame,
                                       const Rigid3d& world_from_camera,
                                       const std::vector<Landmark>& bodies_in_world) {
  constexpr double kMinSizePx = 10.0;
  const int objects = static_cast<int>(scene.objects.size());
  std::vector<SimulatedBox> boxes;
  if (scene.boxes == BoxedPart::kWhole) {
    for (int object = 0; object < objects; ++object) {
      const auto box = BoxInImage(scene.camera, world_from_camera, bodies_in_world[object]);
      if (!box || !CentreIsVisible(bodies_in_world, object, world_from_camera.translation)) {
        continue;
      }
      boxes.push_back({frame, object, *box});
    }
    return boxes;
  }
  std::vector<Landmark> bodies_in_camera;
  for (const Landmark& body : bodies_in_world) {
    bodies_in_camera.push_back(Transform(world_from_camera.Inverse(), body));
  }
  const std::vector<VisiblePart> parts = VisibleParts(scene.camera, bodies_in_camera);
  for (int object = 0; object < objects; ++object) {
    const auto& [silhouette, visible, pixels] = parts[object];
    const double share = silhouette > 0 ? static_cast<double>(visible) / silhouette : 0.0;
    const Box box = {pixels.min().x() - 0.5, pixels.min().y() - 0.5, pixels.max().x() + 0.5,
                     pixels.max().y() + 0.5};
    if (share < scene.min_visible_share || !(std::min(box.Width(), box.Height()) >= kMinSizePx)) {
      continue;
    }
    boxes.push_back({frame, object, box, 0.3 + 0.65 * share});
  }
  return boxes;
}

// With probability false_share, a box of nothing somewhere inside the image, with the label of some
// object.
std::optional<SimulatedBox> FalseBox(const Scene& scene, int frame_index, int object_id) {
  auto random = NoiseGenerator(scene.seed, NoiseKind::kFalseBox, frame_index, object_id);
  std::uniform_real_distribution<double> uniform;
  if (uniform(random) >= scene.noise.false_share) return std::nullopt;
  const auto between = [&](double from, double to) { return from + (to - from) * uniform(random); };
  const double log_height = between(std::log(0.05), std::log(0.5));
  const double height = std::exp(log_height) * scene.camera.height;
  const double width = height * std::exp2(between(-1.0, 1.0));
  const double x = between(0.0, std::max(scene.camera.width - width, 0.0)) - 0.5;
  const double y = between(0.0, scene.camera.height - height) - 0.5;
  const double score = between(0.25, 0.6);
  const Box box = {x, y, std::min(x + width, scene.camera.width - 0.5), y + height};
  return SimulatedBox{frame_index, static_cast<int>(random() % scene.objects.size()), box, score,
                      true};
}

// The true motions with noise, integrated from the first true pose.
std::vector<Rigid3d> NoisyOdometry(const Scene& scene, const std::vector<Rigid3d>& true_poses) {
  constexpr double kTurn =
      std::numbers::pi / 6.0;  // turn with the same noise as a metre, 30 degrees
  const SceneNoise& noise = scene.noise;
  auto random = NoiseGenerator(scene.seed, NoiseKind::kOdometry, 0, 0);
  std::normal_distribution<double> normal;
  const auto random_vector = [&]() -> Eigen::Vector3d {
    const double x = normal(random), y = normal(random), z = normal(random);
    return {x, y, z};
  };
  const double scale = 1.0 + noise.odometry_scale_sigma * normal(random);
  const double rotation_sigma = noise.odometry_rotation_sigma_deg * kRadPerDeg;

  std::vector<Rigid3d> odometry = {true_poses.front()};
  for (size_t i = 1; i < true_poses.size(); ++i) {
    const Rigid3d motion = true_poses[i - 1].Inverse() * true_poses[i];
    const double metres = motion.translation.norm();
    const double turns = LogRotation(motion.rotation).norm() / kTurn;
    const Rigid3d noisy_motion = {
        (motion.rotation *
         ExpRotation(rotation_sigma * std::sqrt(metres + turns) * random_vector()))
            .normalized(),
        scale * motion.translation +
            noise.odometry_translation_sigma * std::sqrt(metres) * random_vector()};
    odometry.push_back(odometry.back() * noisy_motion);
  }
  return odometry;
}

}  // namespace

bool CentreIsVisible(const std::vector<Landmark>& bodies_in_world, int body_index,
                     const Eigen::Vector3d& camera_in_world) {
  const Landmark& body = bodies_in_world[body_index];
  const Eigen::Vector3d direction = body.Centre() - camera_in_world;
  const auto own_depth = NearestIntersection(body, camera_in_world, direction);
  if (!own_depth) return false;
  return std::ranges::none_of(bodies_in_world, [&](const Landmark& other) {
    const auto depth = NearestIntersection(other, camera_in_world, direction);
    return depth && *depth < *own_depth;
  });
}

std::optional<Box> BoxInImage(const Camera& camera, const Rigid3d& world_from_camera,
                              const Landmark& body_in_world) {
  const auto box = ExactOutline(camera, Transform(world_from_camera.Inverse(), body_in_world));
  if (!box || !(DistanceToBorder(*box, camera.width, camera.height) >= 0.0)) return std::nullopt;
  return box;
}

Simulation Simulate(const Scene& scene, bool noise) {
  Simulation simulation;
  simulation.true_world_from_camera = TruePoses(scene);
  simulation.odometry_world_from_camera =
      noise ? NoisyOdometry(scene, simulation.true_world_from_camera)
            : simulation.true_world_from_camera;

  for (int frame = 0; frame < scene.trajectory.frames; ++frame) {
    const Rigid3d& world_from_camera = simulation.true_world_from_camera[frame];
    const Scene there = SceneAt(scene, frame);
    for (SimulatedBox row : BoxesInSight(there, frame, world_from_camera, AllBodies(there))) {
      const SceneObject& object = there.objects[row.object_index];
      row.object_index = static_cast<int>(
          std::ranges::find(scene.objects, object.id, &SceneObject::id) - scene.objects.begin());
      simulation.exact_boxes.push_back(row);
      if (!noise) {
        simulation.detections.push_back(row);
        continue;
      }
      auto random = NoiseGenerator(scene.seed, NoiseKind::kDetection, frame, object.id);
      std::uniform_real_distribution<double> uniform;
      std::normal_distribution<double> normal;
      if (uniform(random) < scene.noise.miss_probability) continue;
      const auto sigma = [&](double extent) {
        return std::hypot(scene.noise.box_edge_sigma * extent, scene.noise.box_sigma_px);
      };
      const Box exact = row.box;
      row.box.x_min += sigma(exact.Width()) * normal(random);
      row.box.y_min += sigma(exact.Height()) * normal(random);
      row.box.x_max += sigma(exact.Width()) * normal(random);
      row.box.y_max += sigma(exact.Height()) * normal(random);
      const auto in_image = CutToImage(row.box, scene.camera.width, scene.camera.height);
      if (!in_image) continue;
      row.box = *in_image;
      simulation.detections.push_back(row);
      if (const auto box = FalseBox(scene, frame, object.id)) {
        simulation.detections.push_back(*box);
      }
    }
  }
  return simulation;
}

GroundTruth ObjectGroundTruth(const Scene& scene, const SceneObject& object) {
  GroundTruth truth;
  truth.landmark_in_world = ObjectLandmark(scene, object);
  truth.mirror_symmetric = true;
  truth.mirror_symmetric_yz = false;
  truth.rotationally_symmetric = object.shape != Shape::kBox &&
                                 object.half_axes.x() == object.half_axes.y() &&
                                 object.rests_on == RestingFace::kBottom && object.tilt.isZero();
  return truth;
}

std::string ImageName(int frame_index) { return fmt::format("rgb/{:06}.png", frame_index); }

}  // namespace soslam
