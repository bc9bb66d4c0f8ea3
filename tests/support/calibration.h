// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <map>
#include <memory>

#include "evaluation/statistics.h"
#include "geometry/angles.h"
#include "initialisation/upright.h"
#include "mapping/back_end.h"
#include "support/random.h"

namespace soslam::calibration {

// Whether landmarks are as far from the truth as their covariances say: the normalised estimation
// error squared (NEES) of centre, size and yaw over many random scenes of one body each.

inline constexpr int kFrames = 8;

inline double Normal(double sigma) {
  return std::normal_distribution<double>(0.0, sigma)(TestRandom());
}
inline Eigen::Vector3d NormalVector(double sigma) {
  return {Normal(sigma), Normal(sigma), Normal(sigma)};
}

// What the back end assumes of the errors, without what it does about wrong assumptions.
inline OptimiseOptions ModelOptions() {
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.odometry_rotation_sigma_deg = 0.1;
  options.odometry_translation_sigma_m = 0.003;
  options.huber_delta = 1e6;           // errors are Gaussian
  options.view_correlation_deg = 0.0;  // and independent
  options.misfit_sigma_fraction = 0.0;
  options.axes_weight = 0.0;  // yaws are any
  return options;
}

struct Truth {
  Landmark landmark_in_world;
  ShapePrior prior;
  std::vector<Rigid3d> world_from_camera;
};

// Edge images by detection.
using EdgeImages = std::map<int, std::shared_ptr<const EdgeImage>>;

// What the errors are, and what the back end takes them for.
struct Case {
  int scenes = 500;
  double shape_exponent = kCuboidExponent;
  double assumed_exponent = kCuboidExponent;
  // Ranges of a / c and b / c: clearly longer than deep, so that one or two views determine the
  // yaw.
  std::array<double, 4> ratio_range = {0.5, 0.7, 1.2, 1.6};
  double arc_rad = 2.5;  // around the object, over all frames
  OptimiseOptions actual = ModelOptions();
  OptimiseOptions assumed = ModelOptions();
  // What is seen of the body's edges; nothing where it is empty.
  std::function<EdgeImages(const Truth&)> edge_images;
};

inline Truth RandomTruth(const Case& c, const OptimiseOptions& options) {
  Truth truth;
  truth.prior.shape_exponent = c.assumed_exponent;
  truth.prior.log_sigma = {0.1, 0.1};
  truth.prior.ratio = {RandomUniform(c.ratio_range[0], c.ratio_range[1]),
                       RandomUniform(c.ratio_range[2], c.ratio_range[3])};
  Landmark& landmark = truth.landmark_in_world;
  landmark.shape_exponent = c.shape_exponent;
  landmark.half_axes.z() = RandomUniform(0.3, 0.6);
  for (int i = 0; i < 2; ++i) {
    landmark.half_axes[i] =
        landmark.half_axes.z() * truth.prior.ratio[i] * std::exp(Normal(truth.prior.log_sigma[i]));
  }
  // Standing on z = 0, as well as bodies are said to stand.
  const double tilt = options.standing_angle_sigma_deg * kRadPerDeg;
  landmark.frame_from_object = {ExpRotation({Normal(tilt), Normal(tilt), 0.0}) *
                                    UprightRotation(Eigen::Vector3d::UnitZ(), RandomUniform(-3, 3)),
                                {RandomUniform(-0.1, 0.1), RandomUniform(-0.1, 0.1),
                                 landmark.half_axes.z() + Normal(options.standing_height_sigma_m)}};
  // Cameras on an arc around it that look at it.
  for (int i = 0; i < kFrames; ++i) {
    const double angle = c.arc_rad * i / (kFrames - 1);
    const Eigen::Vector3d position(4.0 * std::cos(angle), 4.0 * std::sin(angle), 1.6);
    const Eigen::Vector3d z = (Eigen::Vector3d(0, 0, 0.4) - position).normalized();
    const Eigen::Vector3d x = z.cross(Eigen::Vector3d::UnitZ()).normalized();
    Eigen::Matrix3d axes;
    axes << x, z.cross(x), z;
    truth.world_from_camera.push_back({Eigen::Quaterniond(axes), position});
  }
  return truth;
}

// What is observed of it, with errors as the options say.
inline Sequence Observe(const Truth& truth, const OptimiseOptions& options) {
  Sequence sequence;
  sequence.camera = TestCamera();
  sequence.planes = {{0, Plane()}};
  sequence.objects.resize(1);
  std::array<double, 4> misfits{};
  if (options.misfit_sigma_fraction > 0.0) {
    for (double& misfit : misfits) misfit = Normal(options.misfit_sigma_fraction);
  }
  for (size_t i = 0; i < truth.world_from_camera.size(); ++i) {
    Frame frame;
    frame.id = static_cast<int>(i);
    frame.world_from_camera = truth.world_from_camera[i];
    if (i > 0) {
      Rigid3d step = truth.world_from_camera[i - 1].Inverse() * truth.world_from_camera[i];
      step.rotation = step.rotation *
                      ExpRotation(NormalVector(options.odometry_rotation_sigma_deg * kRadPerDeg));
      step.translation += NormalVector(options.odometry_translation_sigma_m);
      frame.world_from_camera = sequence.frames.back().world_from_camera * step;
    }
    sequence.frames.push_back(frame);
    Box box = *OutlineBox(sequence.camera,
                          Transform(truth.world_from_camera[i].Inverse(), truth.landmark_in_world));
    const double width = box.Width();
    const double height = box.Height();
    box = {box.x_min - misfits[0] * width, box.y_min - misfits[1] * height,
           box.x_max + misfits[2] * width, box.y_max + misfits[3] * height};
    const double sigma_x = options.detection_sigma_fraction * width;
    const double sigma_y = options.detection_sigma_fraction * height;
    box = {box.x_min + Normal(sigma_x), box.y_min + Normal(sigma_y), box.x_max + Normal(sigma_x),
           box.y_max + Normal(sigma_y)};
    Detection detection;
    detection.frame_index = static_cast<int>(i);
    detection.box = box;
    sequence.detections.push_back(detection);
  }
  return sequence;
}

struct Nees {
  double centre = 0.0;
  double size = 0.0;
  double yaw = 0.0;
};

// Means over scenes of the NEES per degree of freedom.
inline Nees MeanNees(const Case& c) {
  Nees sum;
  for (int i = 0; i < c.scenes; ++i) {
    const Truth truth = RandomTruth(c, c.actual);
    const Sequence sequence = Observe(truth, c.actual);
    Landmark start = truth.landmark_in_world;
    start.shape_exponent = c.assumed_exponent;
    BackEndInput input{sequence, {start}, {truth.prior}, {}, {}};
    if (c.edge_images) input.edge_images = c.edge_images(truth);
    const MapEstimate map = OptimiseMap(input, c.assumed);
    const Landmark& found = *map.objects[0].landmark_in_world;
    const auto& covariance = map.objects[0].covariance;
    if (!covariance) {
      ADD_FAILURE() << "scene " << i << ": no covariance";
      continue;
    }
    const Eigen::Vector3d centre = found.Centre() - truth.landmark_in_world.Centre();
    const Eigen::Vector3d size =
        (found.half_axes.array() / truth.landmark_in_world.half_axes.array()).log();
    const double yaw = YawDifferenceModuloPi(
        Yaw(Eigen::Vector3d::UnitZ(), found.frame_from_object.rotation),
        Yaw(Eigen::Vector3d::UnitZ(), truth.landmark_in_world.frame_from_object.rotation));
    const auto nees = [&](const Eigen::Vector3d& error, int block) {
      return error.dot(covariance->block<3, 3>(block, block).ldlt().solve(error)) / 3.0;
    };
    sum.centre += nees(centre, 3) / c.scenes;
    sum.size += nees(size, 6) / c.scenes;
    sum.yaw += yaw * yaw / (*covariance)(2, 2) / c.scenes;
  }
  return sum;
}

// The range in which the mean NEES of that many degrees of freedom, counted over all scenes, is
// with a probability of 99 % where errors are as their covariances say.
inline void ExpectWithin99Percent(double mean_nees, int degrees, const char* of) {
  EXPECT_GT(mean_nees, ChiSquareQuantile(degrees, -2.5758)) << of;
  EXPECT_LT(mean_nees, ChiSquareQuantile(degrees, 2.5758)) << of;
}

inline void ExpectHonest(const Nees& nees, int scenes) {
  ExpectWithin99Percent(nees.centre, 3 * scenes, "centre");
  ExpectWithin99Percent(nees.size, 3 * scenes, "size");
  ExpectWithin99Percent(nees.yaw, scenes, "yaw");
}

}  // namespace soslam::calibration
