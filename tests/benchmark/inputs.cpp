// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/inputs.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

#include "soslam/base/parallel.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/iou.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/orientation/image_evidence.h"
#include "soslam/synthesis/render.h"
#include "soslam/synthesis/scene.h"
#include "soslam/system/process.h"
#include "support/scene.h"

namespace soslam {
namespace {

SceneObject Ellipsoid(int id, const Eigen::Vector2d& position, double yaw_deg,
                      const Eigen::Vector3d& half_axes) {
  SceneObject object;
  object.id = id;
  object.label = "ellipsoid " + std::to_string(id);
  object.half_axes = half_axes;
  object.position_on_plane = position;
  object.yaw = yaw_deg * kRadPerDeg;
  object.texture_seed = id;
  return object;
}

Scene ArcScene() {
  constexpr double kRadius = 4.0;  // metres
  constexpr double kCameraHeight = 2.0;
  Scene scene;
  scene.name = "arc";
  scene.camera = {640, 480, 520.0, 520.0, 319.5, 239.5};
  scene.planes.push_back({0, "floor", Plane{}, std::nullopt});
  scene.objects = {Ellipsoid(1, {-0.7, -1.3}, 178.0, {0.25, 0.40, 0.30}),
                   Ellipsoid(2, {-0.7, 0.0}, -172.0, {0.30, 0.45, 0.20}),
                   Ellipsoid(3, {-0.7, 1.3}, 168.0, {0.22, 0.30, 0.35}),
                   Ellipsoid(4, {0.7, -1.3}, -165.0, {0.35, 0.25, 0.30}),
                   Ellipsoid(5, {0.7, 0.0}, 171.0, {0.28, 0.40, 0.40}),
                   Ellipsoid(6, {0.7, 1.3}, -178.0, {0.40, 0.30, 0.25})};
  for (int angle_deg = -30; angle_deg <= 30; angle_deg += 10) {
    const double angle = angle_deg * kRadPerDeg;
    scene.trajectory.waypoints.push_back(
        {{-kRadius * std::cos(angle), -kRadius * std::sin(angle), kCameraHeight}, {0.0, 0.0, 0.2}});
  }
  scene.trajectory.frames = 12;
  scene.noise.box_edge_sigma = 0.02;
  scene.noise.odometry_translation_sigma = 0.005;
  scene.noise.odometry_rotation_sigma_deg = 0.1;
  return scene;
}

}  // namespace

const Sequence& TwelveViews() {
  static const Sequence sequence = SyntheticSequence(ArcScene(), /*noise=*/true);
  return sequence;
}

const std::vector<std::shared_ptr<const FrameEdges>>& EdgesOfTwelveViews() {
  static const auto edges = [] {
    const Scene scene = ArcScene();
    const std::vector<Frame>& frames = TwelveViews().frames;
    std::vector<std::shared_ptr<const FrameEdges>> result(frames.size());
    ParallelFor(frames.size(), ThisMachine().cores, [&](int i) {
      const auto frame = static_cast<size_t>(i);
      cv::Mat grey;
      cv::cvtColor(RenderFrame(scene, *frames[frame].true_world_from_camera), grey,
                   cv::COLOR_BGR2GRAY);
      result[frame] = std::make_shared<const FrameEdges>(ComputeEdgeMaps(grey, EdgesOptions()));
    });
    return result;
  }();
  return edges;
}

Sequence OnlyObject(const Sequence& sequence, size_t object_index) {
  Sequence only = sequence;
  only.objects = {sequence.objects[object_index]};
  std::erase_if(only.detections, [&](const Detection& detection) {
    return detection.object_index != static_cast<int>(object_index);
  });
  for (Detection& detection : only.detections) detection.object_index = 0;
  return only;
}

Sequence FirstObservations(Sequence sequence) {
  std::vector<bool> is_known(sequence.objects.size());
  std::erase_if(sequence.detections, [&](const Detection& detection) {
    const auto object = static_cast<size_t>(detection.object_index);
    const bool was_known = is_known[object];
    is_known[object] = true;
    return was_known;
  });
  return sequence;
}

Landmark FacingCamera(const Sequence& sequence, const ObservationEstimate& estimate) {
  const Detection& detection = sequence.detections[estimate.detection_index];
  const Rigid3d& world_from_camera = sequence.FrameOf(detection).world_from_camera;
  std::optional<Landmark> best;
  double best_cosine = -1.0;
  for (const Hypothesis& hypothesis : estimate.hypotheses) {
    const Landmark landmark = Transform(world_from_camera, hypothesis.landmark_in_camera);
    const double cosine =
        std::abs((landmark.frame_from_object.rotation * Eigen::Vector3d::UnitX()).x());
    if (!(cosine > best_cosine)) continue;
    best = landmark;
    best_cosine = cosine;
  }
  return best.value();
}

std::vector<std::optional<ShapePrior>> TruePriors(const Sequence& sequence) {
  std::vector<std::optional<ShapePrior>> priors;
  for (const Object& object : sequence.objects) {
    const Landmark& truth = object.ground_truth->landmark_in_world;
    priors.push_back(ShapePrior{truth.half_axes.head<2>() / truth.half_axes.z(),
                                Eigen::Vector2d::Constant(0.1), truth.shape_exponents});
  }
  return priors;
}

double MeanIou(const Sequence& sequence, const std::vector<Landmark>& landmarks_in_world) {
  double sum = 0.0;
  for (size_t i = 0; i < landmarks_in_world.size(); ++i) {
    sum += BoxIou(landmarks_in_world[i], sequence.objects[i].ground_truth->landmark_in_world);
  }
  return sum / static_cast<double>(landmarks_in_world.size());
}

OneObject::OneObject(const Sequence& all, size_t object_index, size_t textures)
    : sequence(OnlyObject(all, object_index)), input{sequence, {}, TruePriors(sequence)} {
  const Sequence first = FirstObservations(sequence);
  const auto estimates = InitialiseUpright(first, input.priors, UprightOptions(), /*threads=*/1);
  input.initial_landmarks = {FacingCamera(first, estimates.observations.front())};
  for (const int index : SpreadOver(DetectionsByObject(sequence).front(), textures)) {
    const Detection& detection = sequence.detections[index];
    const auto& edges = EdgesOfTwelveViews()[detection.frame_index];
    input.images.emplace_back(
        index,
        MakeAsymmetryEvidence(std::make_shared<const SymmetryImage>(edges->maps, detection.box),
                              sequence.CameraOf(detection), TextureOptions(), SymmetryOptions()));
  }
}

}  // namespace soslam
