// SPDX-License-Identifier: BSD-3-Clause
#include "support/scene.h"

#include <Eigen/Geometry>
#include <numbers>
#include <utility>

namespace soslam {
namespace {

// The image turns counterclockwise.
Sequence RolledByAQuarter(Sequence sequence) {
  const double width = sequence.camera.width;
  Camera& camera = sequence.camera;
  std::swap(camera.width, camera.height);
  std::swap(camera.fx, camera.fy);
  camera = {camera.width, camera.height, camera.fx, camera.fy, camera.cy, width - 1.0 - camera.cx};
  const Rigid3d old_from_new{
      Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitZ())),
      Eigen::Vector3d::Zero()};
  for (Frame& frame : sequence.frames) {
    frame.world_from_camera = frame.world_from_camera * old_from_new;
    if (frame.true_world_from_camera) {
      frame.true_world_from_camera = *frame.true_world_from_camera * old_from_new;
    }
  }
  for (Detection& detection : sequence.detections) {
    const Box box = detection.box;
    detection.box = {box.y_min, width - 1.0 - box.x_max, box.y_max, width - 1.0 - box.x_min};
    detection.plane_in_camera = Transform(old_from_new.Inverse(), detection.plane_in_camera);
    const auto [left, top, right, bottom] = detection.is_one_sided;
    detection.is_one_sided = {top, right, bottom, left};
  }
  return sequence;
}

}  // namespace

Sequence CuboidSequence(int objects, int frames) {
  Sequence sequence = SyntheticSequence(RandomScene(5, objects, frames, {Shape::kBox}), false);
  for (Object& object : sequence.objects) {
    object.ground_truth->landmark_in_world.shape_exponents = kCuboidExponent;
  }
  return sequence;
}

Scene LabelledScene(int seed, int objects, int frames, const std::vector<std::string>& labels) {
  Scene scene =
      RandomScene(seed, objects, frames, {Shape::kBox, Shape::kEllipsoid, Shape::kCylinder});
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    scene.objects[i].label = labels[i % labels.size()];
  }
  return scene;
}

SceneNoise OrdinaryNoise() {
  SceneNoise noise;
  noise.box_edge_sigma = 0.02;
  noise.box_sigma_px = 1.0;
  noise.miss_probability = 0.1;
  noise.odometry_translation_sigma = 0.008;
  noise.odometry_rotation_sigma_deg = 0.25;
  return noise;
}

std::vector<std::optional<ShapePrior>> TrueCuboidPriors(const Sequence& sequence,
                                                        double log_sigma) {
  std::vector<std::optional<ShapePrior>> priors;
  for (const Object& object : sequence.objects) {
    const Eigen::Vector3d& half_axes = object.ground_truth->landmark_in_world.half_axes;
    priors.push_back(ShapePrior{half_axes.head<2>() / half_axes.z(),
                                Eigen::Vector2d::Constant(log_sigma), kCuboidExponent});
  }
  return priors;
}

Scene WithShelf(Scene scene, double height) {
  scene.planes.push_back({1, "shelf", {Eigen::Vector3d::UnitZ(), -height}, std::nullopt});
  for (size_t i = 1; i < scene.objects.size(); i += 2) scene.objects[i].plane_index = 1;
  return scene;
}

Scene WithCeiling(Scene scene, double height) {
  const Plane floor = scene.planes[0].plane_in_world;
  const Plane ceiling{-Eigen::Vector3d::UnitZ(), height};
  const Rigid3d ceiling_from_floor = WorldFromPlane(ceiling).Inverse() * WorldFromPlane(floor);
  scene.planes.push_back({1, "ceiling", ceiling, std::nullopt});
  for (size_t i = 1; i < scene.objects.size(); i += 2) {
    SceneObject& object = scene.objects[i];
    object.plane_index = 1;
    const Eigen::Vector3d place(object.position_on_plane.x(), object.position_on_plane.y(), 0.0);
    object.position_on_plane = (ceiling_from_floor * place).head<2>();
  }
  return scene;
}

Sequence OnPlanesToEstimate(Sequence sequence) {
  const Eigen::Quaterniond turn = ExpRotation(Eigen::Vector3d(0.015, -0.02, 0.0));
  for (SupportPlane& plane : sequence.planes) {
    plane.plane_in_world.normal = turn * plane.plane_in_world.normal;
    plane.plane_in_world.offset -= 0.05;
    plane.attitude_information = 1e-3 * Eigen::Vector3d(1.0, 1.0, 0.0).asDiagonal();
  }
  return sequence;
}

Sequence TransformSequence(const Rigid3d& new_from_old, Sequence sequence) {
  for (Frame& frame : sequence.frames) {
    frame.world_from_camera = new_from_old * frame.world_from_camera;
    if (frame.true_world_from_camera) {
      frame.true_world_from_camera = new_from_old * *frame.true_world_from_camera;
    }
  }
  for (SupportPlane& plane : sequence.planes) {
    plane.plane_in_world = Transform(new_from_old, plane.plane_in_world);
    if (plane.scene_axis_in_world) {
      plane.scene_axis_in_world = new_from_old.rotation * *plane.scene_axis_in_world;
    }
  }
  for (Object& object : sequence.objects) {
    if (!object.ground_truth) continue;
    Landmark& landmark = object.ground_truth->landmark_in_world;
    landmark = Transform(new_from_old, landmark);
  }
  return sequence;
}

Sequence PostsAndMats() {
  Scene scene = RandomScene(2, 4, 20, {Shape::kBox});
  for (size_t i = 0; i < scene.objects.size(); ++i) {
    scene.objects[i].label = i % 2 == 0 ? "post" : "mat";
    scene.objects[i].half_axes =
        i % 2 == 0 ? Eigen::Vector3d(0.1, 0.1, 0.5) : Eigen::Vector3d(0.5, 0.5, 0.1);
  }
  Sequence sequence = SyntheticSequence(scene, false);
  sequence.planes.clear();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  return sequence;
}

SemanticTable TableOfPostsAndMats(double log_sigma) {
  const auto prior = [log_sigma](double ratio, double height_m) {
    ShapePrior prior{Eigen::Vector2d::Constant(ratio), Eigen::Vector2d::Constant(log_sigma),
                     kCuboidExponent};
    prior.height_m = LogNormal{height_m, log_sigma};
    return prior;
  };
  SemanticTable table;
  table.priors = {{"post", prior(0.2, 1.0)}, {"mat", prior(5.0, 0.2)}};
  return table;
}

Sequence Rolled(Sequence sequence, int quarters) {
  for (int i = 0; i < quarters; ++i) sequence = RolledByAQuarter(std::move(sequence));
  return sequence;
}

}  // namespace soslam
