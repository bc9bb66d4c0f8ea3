// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/yaw_prior.h"

#include <cmath>

#include "soslam/base/parallel.h"
#include "soslam/geometry/angles.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/model/occlusion.h"

namespace soslam {
namespace {

// Standard deviation (rad) of a true yaw: the error of its annotation.
constexpr double kTrueYawSigma = 0.1 * kRadPerDeg;
constexpr size_t kMinPriorViews = 2;

// Motion (m, world frame) between the first and the last of the detections' feet, from the linear
// regression of all feet over time.
std::optional<Eigen::Vector3d> Motion(const Sequence& sequence,
                                      const std::vector<int>& detections) {
  std::vector<double> times;
  std::vector<Eigen::Vector3d> feet;
  double mean_time = 0.0;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[index];
    if (detection.is_one_sided[3]) continue;
    // Where the ray through the centre of the box's lower edge meets the support plane.
    const auto foot = GroundContactInCamera(sequence.CameraOf(detection), detection.box,
                                            detection.plane_in_camera);
    if (!foot) continue;
    feet.push_back(sequence.FrameOf(detection).world_from_camera * *foot);
    times.push_back(sequence.FrameOf(detection).timestamp);
    mean_time += times.back();
  }
  if (feet.size() < kMinPriorViews) return std::nullopt;
  mean_time /= static_cast<double>(times.size());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0.0;
  for (size_t i = 0; i < feet.size(); ++i) {
    sum += (times[i] - mean_time) * feet[i];
    squares += std::pow(times[i] - mean_time, 2);
  }
  if (!(squares > 0.0)) return std::nullopt;
  return sum / squares * (times.back() - times.front());
}

YawPrior AlongDirection(const Sequence& sequence, const Detection& detection,
                        const Eigen::Vector3d& direction_in_world, double sigma) {
  const Eigen::Vector3d direction =
      sequence.FrameOf(detection).world_from_camera.rotation.conjugate() * direction_in_world;
  return {
      Yaw(detection.plane_in_camera.normal, RotationBetween(Eigen::Vector3d::UnitX(), direction)),
      sigma};
}

// `around`: a detection and those of the same object in neighbouring frames.
std::optional<YawPrior> MotionPrior(const Sequence& sequence, const Detection& detection,
                                    const std::vector<int>& around,
                                    const std::optional<ShapePrior>& shape,
                                    const YawPriorOptions& options, const UprightOptions& upright) {
  const auto motion = Motion(sequence, around);
  if (motion && motion->norm() >= options.motion_min_m) {
    return AlongDirection(sequence, detection, *motion,
                          std::atan2(options.motion_foot_sigma_m, motion->norm()));
  }
  if (around.size() < kMinPriorViews || (shape && shape->attitude != Attitude::kStanding)) {
    return std::nullopt;
  }
  ObjectEvidence views = EvidenceInWorld(sequence, around, shape, upright);
  views.axes_weight = 0.0;
  views.picture_costs.clear();  // pictures count once, in the fit that this is a prior of
  views.prior = shape;
  WeighViews(upright.ViewCorrelation(), &views);
  const auto optima = ProfileOverYaw(views, upright.YawStep()).Minima(1);
  if (optima.empty()) return std::nullopt;
  const Eigen::Quaterniond& rotation = optima.front().frame_from_object.rotation;
  return AlongDirection(sequence, detection, rotation * Eigen::Vector3d::UnitX(),
                        options.standing_sigma_deg * kRadPerDeg);
}

// For each detection, the detections of its object, itself included, at most `frames` before or
// after.
std::vector<std::vector<int>> Neighbours(const Sequence& sequence, int frames) {
  std::vector<std::vector<int>> neighbours(sequence.detections.size());
  const auto frame_of = [&](int index) { return sequence.detections[index].frame_index; };
  for (const std::vector<int>& track : DetectionsByObject(sequence)) {
    size_t first = 0;
    for (const int index : track) {
      while (frame_of(track[first]) < frame_of(index) - frames) ++first;
      for (size_t i = first; i < track.size() && frame_of(track[i]) <= frame_of(index) + frames;
           ++i) {
        neighbours[index].push_back(track[i]);
      }
    }
  }
  return neighbours;
}

}  // namespace

std::optional<double> TrueYaw(const Sequence& sequence, const Detection& detection) {
  const auto truth = TrueLandmarkInCamera(sequence, detection);
  if (!truth) return std::nullopt;
  return Yaw(detection.plane_in_camera.normal, truth->frame_from_object.rotation);
}

std::vector<std::optional<YawPrior>> YawPriors(const Sequence& sequence,
                                               const std::vector<std::optional<ShapePrior>>& shapes,
                                               const YawPriorOptions& options,
                                               const UprightOptions& upright, int threads) {
  std::vector<std::optional<YawPrior>> priors(sequence.detections.size());
  if (options.source == YawPriorSource::kNone) return priors;
  const auto neighbours = Neighbours(sequence, options.motion_frames);
  ParallelFor("detections", priors.size(), threads, [&](size_t i) {
    const Detection& detection = sequence.detections[i];
    if (options.source == YawPriorSource::kMotion) {
      priors[i] = MotionPrior(sequence, detection, neighbours[i], shapes[detection.object_index],
                              options, upright);
    } else if (const auto yaw = TrueYaw(sequence, detection)) {
      priors[i] = YawPrior{*yaw, kTrueYawSigma};
    }
  });
  return priors;
}

}  // namespace soslam
