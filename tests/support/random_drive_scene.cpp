// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "support/scene.h"

namespace soslam {
namespace {

constexpr int kMinViews = 3;
constexpr int kMaxAttempts = 5000;  // per object

double Uniform(double min, double max, std::mt19937* random) {
  return std::uniform_real_distribution<double>(min, max)(*random);
}

// A drive with a gentle turn every two metres, the camera a little above the objects.
Trajectory RandomDrive(double length, int frames, std::mt19937* random) {
  constexpr double kStep = 2.0;          // metres
  constexpr double kMaxTurn = 0.35;      // per step, rad
  constexpr double kLookAhead = 3.0;     // metres
  constexpr double kCameraHeight = 1.1;  // metres
  constexpr double kLookAtHeight = 0.4;  // metres
  Trajectory trajectory;
  trajectory.frames = frames;
  const int steps = std::max(1, static_cast<int>(std::ceil(length / kStep)));
  Eigen::Vector2d position = Eigen::Vector2d::Zero();
  double heading = Uniform(-std::numbers::pi, std::numbers::pi, random);
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d forward(std::cos(heading), std::sin(heading));
    const Eigen::Vector2d look_at = position + kLookAhead * forward;
    trajectory.waypoints.push_back(
        {{position.x(), position.y(), kCameraHeight}, {look_at.x(), look_at.y(), kLookAtHeight}});
    heading += Uniform(-kMaxTurn, kMaxTurn, random);
    position += length / steps * Eigen::Vector2d(std::cos(heading), std::sin(heading));
  }
  return trajectory;
}

// Places objects one by one and counts the frames that see each of them.
class Placement {
 public:
  Placement(Scene* scene, std::mt19937* random)
      : scene_(*scene), random_(*random), poses_(TruePoses(*scene)) {
    min_views_ = std::min<size_t>(kMinViews, poses_.size());
  }

  void Place(SceneObject object) {
    for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
      Draw(&object);
      if (HasRoom(object) && TryAdd(object)) return;
    }
    throw std::runtime_error("random scene: no place for an object");
  }

 private:
  // Draws random sizes, and a position ahead of the camera of some frame.
  void Draw(SceneObject* object) {
    object->half_axes.x() = Uniform(0.12, 0.45, &random_);
    object->half_axes.y() = Uniform(0.12, 0.45, &random_);
    object->half_axes.z() = Uniform(0.12, 0.5, &random_);
    object->yaw = Uniform(-std::numbers::pi, std::numbers::pi, &random_);
    const Rigid3d& world_from_camera = poses_[random_() % poses_.size()];
    const double depth = Uniform(1.8, 6.0, &random_);
    const double lateral = depth * Uniform(-0.5, 0.5, &random_);
    const Eigen::Vector3d place_in_world = world_from_camera * Eigen::Vector3d(lateral, 0.0, depth);
    object->position_on_plane = place_in_world.head<2>();
  }

  // True if the object touches no other one and does not block the robot's path.
  bool HasRoom(const SceneObject& object) const {
    constexpr double kGap = 0.1;    // metres
    constexpr double kRobot = 0.4;  // metres, half its width
    const auto radius = [](const SceneObject& o) { return o.half_axes.head<2>().norm(); };
    const bool others = std::ranges::all_of(scene_.objects, [&](const SceneObject& other) {
      return (object.position_on_plane - other.position_on_plane).norm() >
             radius(object) + radius(other) + kGap;
    });
    return others && std::ranges::all_of(poses_, [&](const Rigid3d& pose) {
             return (object.position_on_plane - pose.translation.head<2>()).norm() >
                    radius(object) + kRobot;
           });
  }

  // Adds the object if enough frames see it, and still see every other one.
  bool TryAdd(const SceneObject& object) {
    bodies_.push_back(ObjectBody(scene_, object));
    const int index = static_cast<int>(bodies_.size()) - 1;
    std::vector<std::vector<size_t>> views = views_;
    views.emplace_back();
    for (size_t frame = 0; frame < poses_.size(); ++frame) {
      const Rigid3d& world_from_camera = poses_[frame];
      if (BoxInImage(scene_.camera, world_from_camera, bodies_[index]) &&
          CentreIsVisible(bodies_, index, world_from_camera.translation)) {
        views[index].push_back(frame);
      }
    }
    for (int other = 0; other < index && views[index].size() >= min_views_; ++other) {
      std::erase_if(views[other], [&](size_t frame) {
        return !CentreIsVisible({bodies_[other], bodies_[index]}, 0, poses_[frame].translation);
      });
    }
    if (std::ranges::any_of(views,
                            [&](const auto& frames) { return frames.size() < min_views_; })) {
      bodies_.pop_back();
      return false;
    }
    views_ = std::move(views);
    scene_.objects.push_back(object);
    return true;
  }

  Scene& scene_;
  std::mt19937& random_;
  std::vector<Rigid3d> poses_;
  size_t min_views_;
  std::vector<Landmark> bodies_;            // in the world, one per object
  std::vector<std::vector<size_t>> views_;  // per object, the frames that see it
};

}  // namespace

Scene RandomScene(int seed, int objects, int frames, const std::vector<Shape>& shapes) {
  constexpr double kMetresPerFrame = 0.12;
  constexpr double kMetresPerObject = 0.4;
  std::mt19937 random(static_cast<std::mt19937::result_type>(seed));
  Scene scene;
  scene.name = fmt::format("random_{}", seed);
  scene.camera = {640, 480, 520.0, 520.0, 319.5, 239.5};
  scene.planes.push_back({0, "floor", Plane{}, std::nullopt});
  scene.trajectory = RandomDrive(
      std::max(kMetresPerFrame * (frames - 1), kMetresPerObject * objects), frames, &random);
  scene.seed = seed;
  Placement placement(&scene, &random);
  for (int i = 0; i < objects; ++i) {
    SceneObject object;
    object.id = i + 1;
    object.label = fmt::format("object {}", object.id);
    object.shape = shapes[random() % shapes.size()];
    object.texture_seed = static_cast<int>(random() % 1000000);
    placement.Place(object);
  }
  return scene;
}

Sequence SyntheticSequence(const Scene& scene, bool noise) {
  const Simulation simulation = Simulate(scene, noise);
  Sequence sequence;
  sequence.name = scene.name;
  sequence.camera = scene.camera;
  for (int i = 0; i < scene.trajectory.frames; ++i) {
    sequence.frames.push_back({i, i * scene.trajectory.frame_interval, ImageName(i),
                               simulation.odometry_world_from_camera[i],
                               simulation.true_world_from_camera[i]});
  }
  for (const ScenePlane& plane : scene.planes) {
    sequence.planes.push_back({plane.id, plane.plane_in_world});
  }
  for (const SceneObject& object : scene.objects) {
    sequence.objects.push_back(
        {object.id, object.label, object.plane_index, ObjectGroundTruth(scene, object)});
    sequence.true_objects.push_back({object.id, object.label, ObjectGroundTruth(scene, object)});
  }
  for (const SimulatedBox& detection : simulation.detections) {
    if (detection.is_false) continue;
    const int plane_index = scene.objects[detection.object_index].plane_index;
    const Rigid3d& world_from_camera = simulation.true_world_from_camera[detection.frame_index];
    sequence.detections.push_back(
        {detection.frame_index,
         detection.object_index,
         1.0,
         detection.box,
         Transform(world_from_camera.Inverse(), scene.planes[plane_index].plane_in_world),
         {},
         {}});
    sequence.detections.back().true_object_id = scene.objects[detection.object_index].id;
  }
  return sequence;
}

}  // namespace soslam
