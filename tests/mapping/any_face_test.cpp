// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

#include "soslam/association/fit_track.h"
#include "soslam/evaluation/landmark_errors.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/angles.h"
#include "soslam/initialisation/initialise.h"
#include "soslam/mapping/back_end.h"
#include "soslam/mapping/initial_landmarks.h"
#include "support/one_body.h"
#include "support/random.h"

namespace soslam::any_face {
namespace {

// Scenes of one cuboid that rests on any of its faces or leans, seen from cameras on an arc.
struct Body {
  Eigen::Vector3d own_half_axes = Eigen::Vector3d::Ones();
  RestingFace rests_on = RestingFace::kBottom;
  double yaw = 0.0;
  Eigen::Vector3d tilt = Eigen::Vector3d::Zero();  // rotation vector in the object frame
};

struct Views {
  int frames = 12;
  double arc_rad = 2.5;
  double box_sigma_fraction = 0.0;
  unsigned seed = 0;  // of the boxes' noise
};

Landmark MakeLandmark(const Body& body) {
  Landmark landmark;
  landmark.shape_exponents = kCuboidExponent;
  landmark.rests_on = body.rests_on;
  landmark.half_axes = HalfAxesOnFace(body.own_half_axes, body.rests_on);
  landmark.frame_from_object.rotation =
      UprightRotation(Eigen::Vector3d::UnitZ(), body.yaw) * ExpRotation(body.tilt);
  landmark.frame_from_object.translation.z() =
      FindSupportPoint(landmark, Eigen::Vector3d::UnitZ()).extent;
  return landmark;
}

Sequence Observe(const Landmark& landmark, const Views& views) {
  Sequence sequence =
      ViewsOfBody(landmark, CamerasOnArc(views.frames, views.arc_rad, 3.0, 1.5, 0.3));
  std::mt19937 random(views.seed);
  std::normal_distribution<double> normal;
  for (Detection& detection : sequence.detections) {
    Box& box = detection.box;
    const double sigma_x = views.box_sigma_fraction * box.Width();
    const double sigma_y = views.box_sigma_fraction * box.Height();
    box.x_min += sigma_x * normal(random);
    box.x_max += sigma_x * normal(random);
    box.y_min += sigma_y * normal(random);
    box.y_max += sigma_y * normal(random);
  }
  return sequence;
}

// The map of `OursS`: a sweep in each frame, all views, the back end.
Landmark Estimate(const Sequence& sequence, const ShapePrior& prior) {
  OptimiseOptions options;
  options.detection_model = DetectionModel::kTangency;
  options.hold_poses = true;
  options.covariances = false;
  options.upright.axes_weight = 0.0;
  options.upright.view_correlation_deg = 0.0;  // errors are independent
  BackEndInput input{sequence, {}, {prior}};
  const LandmarkEstimates initial = InitialiseUpright(sequence, {prior}, UprightOptions(), 1);
  input.initial_landmarks = ChooseInitialUprightLandmarks(input, initial, options, 1);
  return OptimiseMap(input, options).objects[0].landmark_in_world.value_or(Landmark());
}

ShapePrior PriorOf(const Eigen::Vector3d& own_half_axes, double log_sigma, Attitude attitude) {
  ShapePrior prior;
  prior.ratio = own_half_axes.head<2>() / own_half_axes.z();
  prior.log_sigma = {log_sigma, log_sigma};
  prior.shape_exponents = kCuboidExponent;
  prior.attitude = attitude;
  return prior;
}

// Half axes of which no two are equal to 20 %, in any order.
Eigen::Vector3d RandomHalfAxes() {
  while (true) {
    const Eigen::Vector3d half_axes = RandomVector(0.1, 0.4);
    Eigen::Vector3d sorted = half_axes;
    std::ranges::sort(sorted);
    if (sorted[1] > 1.2 * sorted[0] && sorted[2] > 1.2 * sorted[1]) return half_axes;
  }
}

TEST(SlowAnyFace, SameShapesHoweverTheyAreLaid) {
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d half_axes = RandomHalfAxes();
    const double yaw = RandomUniform(-3.0, 3.0);
    for (const RestingFace face : kRestingFaces) {
      const Landmark truth = MakeLandmark({half_axes, face, yaw});
      const Landmark estimate =
          Estimate(Observe(truth, Views()), PriorOf(half_axes, 0.1, Attitude::kAnyFace));
      EXPECT_EQ(estimate.rests_on, face);
      EXPECT_LT((InOwnAxes(estimate).half_axes - half_axes).norm(), 0.01 * half_axes.norm());
      EXPECT_LT(AttitudeError(estimate, truth), 1.0 * kRadPerDeg);
    }
  }
}

TEST(SlowAnyFace, SeveralViewsAloneTellTheFace) {
  for (int i = 0; i < 6; ++i) {
    const Eigen::Vector3d half_axes = RandomHalfAxes();
    const RestingFace face = kRestingFaces[static_cast<size_t>(i) % 3];
    const Landmark truth = MakeLandmark({half_axes, face, RandomUniform(-3.0, 3.0)});
    const Sequence sequence = Observe(truth, Views());
    ShapePrior prior = PriorOf(half_axes, 0.1, Attitude::kAnyFace);
    prior.height_m = LogNormal{2.0 * half_axes.z(), 0.1};
    const auto of_views = InitialiseMultiView(sequence, {prior}, UprightOptions(), 1);
    EXPECT_EQ(of_views.objects[0].landmark_in_world.value().rests_on, face);
    std::vector<int> all(sequence.detections.size());
    std::iota(all.begin(), all.end(), 0);
    const auto fitted = FitTrack(sequence, all, prior, AssociateOptions(), Plane());
    ASSERT_TRUE(fitted);
    EXPECT_EQ(fitted->landmark_in_world.rests_on, face);
    EXPECT_LT(AttitudeError(fitted->landmark_in_world, truth), 1.0 * kRadPerDeg);
  }
}

TEST(SlowAnyFace, LeaningBodiesAreFound) {
  for (int i = 0; i < 10; ++i) {
    const Eigen::Vector3d half_axes = RandomHalfAxes();
    const Landmark truth = MakeLandmark(
        {half_axes, kRestingFaces[static_cast<size_t>(i) % 3], RandomUniform(-3.0, 3.0),
         Eigen::Vector3d(RandomUniform(-0.35, 0.35), RandomUniform(-0.35, 0.35), 0.0)});
    const Landmark estimate =
        Estimate(Observe(truth, {.arc_rad = 5.0}), PriorOf(half_axes, 0.05, Attitude::kFree));
    EXPECT_GT(CompareLandmarks(estimate, GroundTruth{truth}, truth).iou, 0.9);
    EXPECT_LT(AttitudeError(estimate, truth), 3.0 * kRadPerDeg);
  }
}

// Share of scenes with the right face, and by how much IoU is lower than that of the same objects
// standing. Boxes are noisy, and objects differ from their label's ratio.
struct FaceScore {
  double right = 0.0;
  double loss_of_iou = 0.0;
};
FaceScore ScoreOf(int scenes, double log_sigma) {
  std::vector<double> right, losses;
  for (int i = 0; i < scenes; ++i) {
    const Eigen::Vector3d of_label = RandomHalfAxes();
    Body body{of_label, kRestingFaces[static_cast<size_t>(RandomUniform(0.0, 2.999))],
              RandomUniform(-3.0, 3.0)};
    for (int axis = 0; axis < 2; ++axis) {
      body.own_half_axes[axis] *= std::exp(RandomNormal(log_sigma));
    }
    const Views views{.box_sigma_fraction = 0.015, .seed = static_cast<unsigned>(i)};
    const auto iou_of = [&](Attitude attitude) {
      const Landmark truth = MakeLandmark(body);
      const Landmark estimate =
          Estimate(Observe(truth, views), PriorOf(of_label, log_sigma, attitude));
      if (attitude == Attitude::kAnyFace) right.push_back(estimate.rests_on == truth.rests_on);
      return CompareLandmarks(estimate, GroundTruth{truth}, truth).iou;
    };
    const double laid = iou_of(Attitude::kAnyFace);
    body.rests_on = RestingFace::kBottom;
    losses.push_back(iou_of(Attitude::kStanding) - laid);
  }
  const FaceScore score{*MeanOf(right), *MeanOf(losses)};
  fmt::print("{} scenes, spread {}: {:.1f} % on the right face, IoU lower by {:.4f}\n", scenes,
             log_sigma, 100.0 * score.right, score.loss_of_iou);
  return score;
}

TEST(SlowAnyFace, FacesOfManyScenes) {
  const std::pair<double, double> least_by_spread[] = {{0.05, 0.99}, {0.1, 0.95}, {0.15, 0.9}};
  for (const auto& [log_sigma, least] : least_by_spread) {
    const FaceScore score = ScoreOf(500, log_sigma);
    EXPECT_GE(score.right, least);
    EXPECT_LT(score.loss_of_iou, 0.02);
  }
}

}  // namespace
}  // namespace soslam::any_face
