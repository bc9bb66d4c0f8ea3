// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/drive.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace soslam {
namespace {

constexpr double kMetresPerFrame = 0.5;
constexpr double kFirstDepth = 13.0;    // m, from where an object is seen first
constexpr double kCameraHeight = 1.1;   // m
constexpr double kBoxSigma = 0.02;      // of width or height
constexpr double kStepSigma = 0.003;    // m per frame and axis
constexpr double kTurnSigma = 0.00175;  // rad per frame and axis

class Noise {
 public:
  double Normal(double sigma) { return sigma * normal_(random_); }
  double Uniform(double min, double max) { return min + (max - min) * uniform_(random_); }
  Eigen::Vector3d NormalVector(double sigma) {
    const double x = Normal(sigma), y = Normal(sigma), z = Normal(sigma);
    return {x, y, z};
  }

 private:
  std::mt19937 random_{20220101};
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
};

// Ahead along the world's x axis, looking a little to the left and to the right.
Rigid3d TruePose(int frame) {
  Eigen::Matrix3d looking_ahead;
  looking_ahead << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  const double heading = 0.05 * std::sin(frame / 15.0);
  return {Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()) * Eigen::Quaterniond(looking_ahead),
          {kMetresPerFrame * frame, 0.0, kCameraHeight}};
}

Landmark TrueLandmark(int index, double first_x, Noise* noise) {
  constexpr double kShapeExponents[] = {1.0, 1.25, 2.0};
  Landmark landmark;
  landmark.half_axes = {noise->Uniform(0.12, 0.45), noise->Uniform(0.12, 0.45),
                        noise->Uniform(0.12, 0.5)};
  landmark.frame_from_object = {
      UprightRotation(Eigen::Vector3d::UnitZ(), noise->Uniform(0.0, std::numbers::pi)),
      {first_x + kFirstDepth, (index % 2 == 0 ? 1.0 : -1.0) * noise->Uniform(0.8, 1.5),
       landmark.half_axes.z()}};
  landmark.shape_exponents = kShapeExponents[index % 3];
  return landmark;
}

Box Noisy(const Box& box, Noise* noise) {
  const double x = kBoxSigma * box.Width();
  const double y = kBoxSigma * box.Height();
  return {box.x_min + noise->Normal(x), box.y_min + noise->Normal(y), box.x_max + noise->Normal(x),
          box.y_max + noise->Normal(y)};
}

void AddFrames(int frames, Noise* noise, Sequence* sequence) {
  for (int i = 0; i < frames; ++i) {
    Frame frame;
    frame.id = i;
    frame.timestamp = 0.1 * i;
    frame.true_world_from_camera = frame.world_from_camera = TruePose(i);
    if (i > 0) {
      const Rigid3d step = TruePose(i - 1).Inverse() * TruePose(i);
      frame.world_from_camera =
          sequence->frames.back().world_from_camera *
          Rigid3d{step.rotation * ExpRotation(noise->NormalVector(kTurnSigma)),
                  step.translation + noise->NormalVector(kStepSigma)};
    }
    sequence->frames.push_back(frame);
  }
}

// A tenth too large or small, a few degrees turned, where the odometry sees it from a frame.
Landmark Disturbed(const Landmark& truth, const Frame& frame, Noise* noise) {
  Landmark start = RotatedAboutZ(
      Transform(frame.world_from_camera * frame.true_world_from_camera->Inverse(), truth),
      noise->Normal(0.05));
  start.half_axes.array() *= noise->NormalVector(0.1).array().exp();
  start.frame_from_object.translation += noise->NormalVector(0.05);
  return start;
}

}  // namespace

Drive::Drive(int frames, int objects) {
  Noise noise;
  sequence.camera = {640, 480, 520.0, 520.0, 319.5, 239.5};
  sequence.planes.push_back({0, Plane{}});
  AddFrames(frames, &noise, &sequence);
  for (int i = 0; i < objects; ++i) {
    const int first = static_cast<int>(std::int64_t{i} * (frames - kDriveViews) / (objects - 1));
    const Landmark truth = TrueLandmark(i, kMetresPerFrame * first, &noise);
    sequence.objects.push_back({i, "object", 0, GroundTruth{truth}});
    for (int view = first; view < first + kDriveViews; ++view) {
      const Rigid3d camera_from_world = TruePose(view).Inverse();
      const auto box = OutlineBox(sequence.camera, Transform(camera_from_world, truth));
      if (!box || DistanceToBorder(*box, sequence.camera.width, sequence.camera.height) < 0.0) {
        continue;
      }
      sequence.detections.push_back(
          {view, i, 1.0, Noisy(*box, &noise), Transform(camera_from_world, Plane{})});
    }
    priors.push_back(
        ShapePrior{(truth.half_axes.head<2>() / truth.half_axes.z())
                       .cwiseProduct(noise.NormalVector(0.2).head<2>().array().exp().matrix()),
                   Eigen::Vector2d::Constant(0.2), truth.shape_exponents});
    initial_landmarks.push_back(Disturbed(truth, sequence.frames[first + kDriveViews / 2], &noise));
  }
  std::ranges::stable_sort(sequence.detections, [](const auto& a, const auto& b) {
    return a.frame_index < b.frame_index;
  });
}

}  // namespace soslam
