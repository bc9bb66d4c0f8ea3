// SPDX-License-Identifier: BSD-3-Clause
#include "synthesis/simulate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/angles.h"

namespace soslam {
namespace {

// The box with noise on each edge, cut at the image border; none if it is missed or empty.
std::optional<Box> NoisyBox(const Scene& scene, int frame_index, const SceneObject& object,
                            const Box& exact) {
  auto random = NoiseGenerator(scene.seed, NoiseKind::kDetection, frame_index, object.id);
  std::uniform_real_distribution<double> uniform;
  std::normal_distribution<double> normal;
  if (uniform(random) < scene.noise.miss_probability) return std::nullopt;
  const auto sigma = [&](double extent) {
    return std::hypot(scene.noise.box_edge_sigma * extent, scene.noise.box_sigma_px);
  };
  Box box = exact;
  box.x_min += sigma(exact.Width()) * normal(random);
  box.y_min += sigma(exact.Height()) * normal(random);
  box.x_max += sigma(exact.Width()) * normal(random);
  box.y_max += sigma(exact.Height()) * normal(random);
  return CutToImage(box, scene.camera.width, scene.camera.height);
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

  const std::vector<Landmark> bodies_in_world = AllBodies(scene);
  for (int frame = 0; frame < scene.trajectory.frames; ++frame) {
    const Rigid3d& world_from_camera = simulation.true_world_from_camera[frame];
    for (int object = 0; object < static_cast<int>(scene.objects.size()); ++object) {
      const auto exact = BoxInImage(scene.camera, world_from_camera, bodies_in_world[object]);
      if (!exact || !CentreIsVisible(bodies_in_world, object, world_from_camera.translation)) {
        continue;
      }
      simulation.exact_boxes.push_back({frame, object, *exact});
      const auto detected = noise ? NoisyBox(scene, frame, scene.objects[object], *exact) : exact;
      if (detected) simulation.detections.push_back({frame, object, *detected});
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
