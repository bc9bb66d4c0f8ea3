// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/back_end_problem.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <limits>

#include "base/parallel.h"
#include "constraints/box_bias.h"
#include "constraints/detection.h"
#include "constraints/odometry.h"
#include "constraints/plane_normal.h"
#include "constraints/scale_ratio.h"
#include "constraints/support.h"
#include "constraints/tangency.h"
#include "constraints/upright_on_plane.h"
#include "geometry/angles.h"
#include "initialisation/view_weights.h"
#include "mapping/axis_cost_term.h"
#include "mapping/minimise.h"
#include "mapping/ratio_cost_term.h"
#include "mapping/residual_term.h"
#include "mapping/tangency_term.h"
#include "mapping/view_term.h"
#include "orientation/symmetry_samples.h"
#include "orientation/texture_asymmetry.h"

namespace soslam {
namespace {

// Kinds of residuals, and reasons for leaving something out.
constexpr const char* kSymmetry = "symmetry";
constexpr const char* kEdges = "edges";
constexpr const char* kTooFewPairs = "symmetry_with_too_few_visible_pairs";
constexpr const char* kNoEdgeCounts = "no_edge_point_counts";

constexpr double kNoLoss = std::numeric_limits<double>::infinity();

}  // namespace

BackEndProblem::BackEndProblem(const BackEndInput& input, const OptimiseOptions& options,
                               int threads)
    : input_(input),
      options_(options),
      threads_(threads),
      detections_by_object_(DetectionsByObject(input.sequence)),
      variables_(input) {
  HoldPoses();
  WeighViews();
  if (!options.hold_poses) AddOdometry();
  for (size_t i = 0; i < input.starts.size(); ++i) {
    if (input.starts[i]) AddLandmark(i);
  }
  AddDetections();
}

template <typename Residual, VariableKind... kKinds, typename... Arguments>
std::unique_ptr<const Term> BackEndProblem::TermOf(
    const std::array<int, sizeof...(kKinds)>& variables, double huber_delta,
    Arguments&&... arguments) const {
  using Made = ResidualTerm<Residual, kKinds...>;
  std::array<typename Made::Block, sizeof...(kKinds)> blocks;
  for (size_t i = 0; i < blocks.size(); ++i) {
    blocks[i] = {variables[i], variables_.Values(variables[i])};
  }
  return std::make_unique<Made>(blocks, huber_delta, std::forward<Arguments>(arguments)...);
}

Terms BackEndProblem::AllTerms() const {
  Terms terms;
  for (const auto* some : {&terms_, &image_terms_}) {
    for (const auto& term : *some) terms.push_back(term.get());
  }
  return terms;
}

Landmark BackEndProblem::LandmarkInCamera(const Detection& detection) const {
  return Transform(variables_.PoseValue(static_cast<size_t>(detection.frame_index)).Inverse(),
                   *variables_.LandmarkValue(static_cast<size_t>(detection.object_index)));
}

void BackEndProblem::WeighViews() {
  view_weights_.assign(input_.sequence.detections.size(), 1.0);
  for (size_t i = 0; i < detections_by_object_.size(); ++i) {
    if (!input_.starts[i]) continue;
    const std::vector<int>& detections = detections_by_object_[i];
    const auto weights = ViewWeights(input_.sequence, detections, input_.starts[i]->Centre(),
                                     options_.view_correlation_deg * kRadPerDeg);
    for (size_t k = 0; k < weights.size(); ++k) {
      view_weights_[static_cast<size_t>(detections[k])] = weights[k];
    }
  }
}

// The first pose of each segment defines its world.
void BackEndProblem::HoldPoses() {
  const auto& frames = input_.sequence.frames;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (options_.hold_poses || i == 0 || frames[i].segment != frames[i - 1].segment) {
      variables_.Hold(variables_.Pose(i));
    }
  }
}

void BackEndProblem::AddOdometry() {
  const auto& frames = input_.sequence.frames;
  for (size_t i = 1; i < frames.size(); ++i) {
    if (frames[i].segment != frames[i - 1].segment) continue;
    const Rigid3d first_from_second =
        frames[i - 1].world_from_camera.Inverse() * frames[i].world_from_camera;
    terms_.push_back(TermOf<OdometryResidual, VariableKind::kPose, VariableKind::kPose>(
        {variables_.Pose(i - 1), variables_.Pose(i)}, options_.huber_delta, first_from_second,
        options_.odometry_rotation_sigma_deg * kRadPerDeg, options_.odometry_translation_sigma_m));
    ++summary_.residuals["odometry"];
  }
}

// An estimated plane moves with what stands on it, under what is known of its normal besides.
void BackEndProblem::AddStanding(size_t object_index) {
  const auto plane_index = static_cast<size_t>(input_.sequence.objects[object_index].plane_index);
  const int normal = variables_.Normal(plane_index);
  const int offset = variables_.Offset(plane_index);
  // No loss: a body that floats is not an outlier, but wrong.
  terms_.push_back(TermOf<UprightOnPlaneResidual, VariableKind::kLandmark, VariableKind::kNormal,
                          VariableKind::kOffset>(
      {variables_.Landmark(object_index), normal, offset}, kNoLoss,
      options_.standing_angle_sigma_deg * kRadPerDeg, options_.standing_height_sigma_m,
      variables_.NormalSide(plane_index)));
  const auto& attitude = input_.sequence.planes[plane_index].attitude_information;
  if (!attitude || !options_.refine_planes) {
    variables_.Hold(normal);
    variables_.Hold(offset);
  } else if (normals_under_objects_.insert(normal).second) {
    terms_.push_back(
        TermOf<PlaneNormalResidual, VariableKind::kNormal>({normal}, kNoLoss, *attitude));
  }
}

void BackEndProblem::AddLandmark(size_t object_index) {
  const Object& object = input_.sequence.objects[object_index];
  const Plane& plane =
      input_.sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world;
  const int landmark = variables_.Landmark(object_index);
  if (options_.support) {
    if (options_.detection_model == DetectionModel::kTangency) {
      AddStanding(object_index);
    } else {
      terms_.push_back(TermOf<SupportResidual, VariableKind::kLandmark>(
          {landmark}, options_.huber_delta, plane, options_.variances.SupportAngleRad2(),
          options_.variances.SupportTangencyM4()));
    }
    ++summary_.residuals["support"];
  }
  if (options_.ratio) AddRatio(object_index);
  if (options_.detection_model == DetectionModel::kTangency && options_.axes_weight > 0.0) {
    terms_.push_back(std::make_unique<AxisCostTerm>(landmark, variables_.Values(landmark), plane,
                                                    options_.axes_weight));
  }
}

void BackEndProblem::AddRatio(size_t object_index) {
  const auto& prior = input_.priors[object_index];
  if (!prior) {
    ++summary_.gated["object_without_ratio"];
    return;
  }
  const int landmark = variables_.Landmark(object_index);
  if (options_.detection_model == DetectionModel::kTangency) {
    // No loss: a ratio far from the prior is as unlikely as its spread says.
    terms_.push_back(
        std::make_unique<RatioCostTerm>(landmark, variables_.Values(landmark), *prior));
  } else {
    terms_.push_back(TermOf<ScaleRatioResidual, VariableKind::kLandmark>(
        {landmark}, options_.huber_delta, prior->ratio, options_.variances.ratio));
  }
  ++summary_.residuals["ratio"];
}

void BackEndProblem::AddDetections() {
  int added = 0;
  for (size_t i = 0; i < input_.sequence.detections.size(); ++i) {
    const Detection& detection = input_.sequence.detections[i];
    const auto& start = input_.starts[static_cast<size_t>(detection.object_index)];
    if (!start) {
      ++summary_.gated[input_.sequence.ObjectOf(detection).is_static
                           ? "detection_of_object_without_start"
                           : "detection_of_moving_object"];
      continue;
    }
    const Rigid3d& world_from_camera = input_.sequence.FrameOf(detection).world_from_camera;
    const Landmark start_in_camera = Transform(world_from_camera.Inverse(), *start);
    if (!(start_in_camera.Centre().z() > 0.0)) {
      ++summary_.gated["landmark_behind_camera"];
      continue;
    }
    AddDetection(i, start_in_camera);
    ++added;
  }
  if (added > 0) summary_.residuals["detection"] = added;
  if (options_.detection_model == DetectionModel::kTangency) AddBias();
}

void BackEndProblem::AddDetection(size_t index, const Landmark& start_in_camera) {
  const Detection& detection = input_.sequence.detections[index];
  const Camera& camera = input_.sequence.CameraOf(detection);
  if (options_.detection_model == DetectionModel::kQuadric) {
    terms_.push_back(TermOf<DetectionResidual, VariableKind::kPose, VariableKind::kLandmark>(
        {Pose(detection), LandmarkOf(detection)}, options_.huber_delta, camera, detection.box,
        options_.variances.DetectionM4()));
    return;
  }
  const auto edges =
      BoxEdges(camera, detection.box, detection.is_bound, options_.detection_sigma_fraction);
  const TangentBox box(edges, start_in_camera);
  // A body so near that it reaches behind the camera has no tangent point in view.
  const int left_out = static_cast<int>(edges.size()) - box.num_edges;
  if (left_out > 0) summary_.gated["edge_behind_camera"] += left_out;
  const int landmark = LandmarkOf(detection);
  const int pose = Pose(detection);
  const int bias = variables_.Bias();
  terms_.push_back(std::make_unique<TangencyTerm>(
      std::array{pose, landmark, bias},
      TangencyTerm::Blocks{variables_.Values(pose), variables_.Values(landmark),
                           variables_.Values(bias)},
      box, options_.huber_delta, view_weights_[index]));
}

void BackEndProblem::AddBias() {
  if (options_.detector_bias_sigma_px > 0.0) {
    terms_.push_back(TermOf<BoxBiasResidual, VariableKind::kBias>({variables_.Bias()}, kNoLoss,
                                                                  options_.detector_bias_sigma_px));
  } else {
    variables_.Hold(variables_.Bias());
  }
}

void BackEndProblem::RenewImageTerms() {
  image_terms_.clear();
  for (const char* kind : {kSymmetry, kEdges}) summary_.residuals.erase(kind);
  for (const char* reason : {kTooFewPairs, kNoEdgeCounts}) summary_.gated.erase(reason);
  const auto has_start = [&](int detection_index) {
    const Detection& detection = input_.sequence.detections[static_cast<size_t>(detection_index)];
    return input_.starts[static_cast<size_t>(detection.object_index)].has_value();
  };
  std::vector<std::function<ImageTerms()>> makers;
  for (const auto& [index, image] : input_.symmetry_images) {
    if (!has_start(index)) continue;
    makers.push_back([this, index = static_cast<size_t>(index), &image = image] {
      return options_.detection_model == DetectionModel::kTangency ? AsymmetryOf(index, image)
                                                                   : PairsOf(index, image);
    });
  }
  for (const auto& [index, image] : input_.edge_images) {
    if (!has_start(index)) continue;
    makers.push_back([this, index = static_cast<size_t>(index), &image = image] {
      return EdgesOf(index, image);
    });
  }
  std::vector<ImageTerms> made(makers.size());
  ParallelFor(static_cast<int>(makers.size()), threads_,
              [&](int i) { made[static_cast<size_t>(i)] = makers[static_cast<size_t>(i)](); });
  for (ImageTerms& of_image : made) AddImageTerms(std::move(of_image));
}

void BackEndProblem::AddImageTerms(ImageTerms of_image) {
  if (of_image.terms.empty()) {
    ++summary_.gated[of_image.reason_for_none];
    return;
  }
  summary_.residuals[of_image.kind] += of_image.residuals;
  std::ranges::move(of_image.terms, std::back_inserter(image_terms_));
}

BackEndProblem::ImageTerms BackEndProblem::AsymmetryOf(
    size_t index, const std::shared_ptr<const SymmetryImage>& image) const {
  const Detection& detection = input_.sequence.detections[index];
  const Landmark in_camera = LandmarkInCamera(detection);
  auto texture = std::make_unique<AsymmetryTerm>(image, input_.sequence.CameraOf(detection),
                                                 in_camera, options_.texture,
                                                 options_.symmetry_options, view_weights_[index]);
  ImageTerms made{kSymmetry, kTooFewPairs, texture->NumPairs(), {}};
  if (made.residuals > 0) {
    made.terms.push_back(ViewTermOf(detection, in_camera, std::move(texture)));
  }
  return made;
}

BackEndProblem::ImageTerms BackEndProblem::PairsOf(
    size_t index, const std::shared_ptr<const SymmetryImage>& image) const {
  const Detection& detection = input_.sequence.detections[index];
  const Landmark in_camera = LandmarkInCamera(detection);
  const Camera& camera = input_.sequence.CameraOf(detection);
  const SymmetryOptions& symmetry = options_.symmetry_options;
  const SymmetryDescriptor at_start(symmetry.descriptor, *image, camera, in_camera);
  std::vector<Eigen::Vector2d> visible;
  for (const Eigen::Vector2d& pixel : SamplePixels(*image, camera, in_camera, symmetry)) {
    if (at_start.Evaluate(pixel, symmetry.min_viewing_cosine, false)) visible.push_back(pixel);
  }
  ImageTerms made{kSymmetry, kTooFewPairs, static_cast<int>(visible.size()), {}};
  if (made.residuals < symmetry.min_pairs) return made;
  for (const Eigen::Vector2d& pixel : visible) {
    made.terms.push_back(TermOf<SymmetryResidual, VariableKind::kPose, VariableKind::kLandmark>(
        {Pose(detection), LandmarkOf(detection)}, options_.huber_delta, symmetry.descriptor, image,
        camera, pixel, in_camera.shape_exponent, options_.symmetry_sigma));
  }
  return made;
}

BackEndProblem::ImageTerms BackEndProblem::EdgesOf(
    size_t index, const std::shared_ptr<const EdgeImage>& image) const {
  const Detection& detection = input_.sequence.detections[index];
  const Landmark in_camera = LandmarkInCamera(detection);
  auto edges = std::make_unique<EdgeTerm>(SupportedEdgeTerm(
      image, input_.sequence.CameraOf(detection), in_camera, options_.edges, view_weights_[index]));
  ImageTerms made{kEdges, kNoEdgeCounts, 1, {}};
  if (edges->NumPoints() > 0) {
    made.terms.push_back(ViewTermOf(detection, in_camera, std::move(edges)));
  }
  return made;
}

// No loss: what a pair or a point costs is bounded.
std::unique_ptr<const Term> BackEndProblem::ViewTermOf(
    const Detection& detection, const Landmark& landmark_in_camera,
    std::unique_ptr<const LandmarkCost> cost) const {
  const int pose = Pose(detection);
  const int landmark = LandmarkOf(detection);
  return std::make_unique<ViewTerm>(
      std::array{pose, landmark},
      ViewTerm::Blocks{variables_.Values(pose), variables_.Values(landmark)},
      landmark_in_camera.shape_exponent, std::move(cost));
}

void BackEndProblem::Solve(int max_iterations) {
  const int iterations = std::min(max_iterations, options_.max_iterations);
  const Minimisation minimisation = Minimise(AllTerms(), {iterations, threads_}, &variables_.all());
  const std::vector<double>& costs = minimisation.costs;
  if (summary_.cost_per_iteration.empty()) summary_.initial_cost = costs.front();
  summary_.final_cost = costs.back();
  summary_.iterations += static_cast<int>(costs.size()) - 1;
  summary_.converged = minimisation.converged;
  summary_.detector_bias_px = variables_.BiasValues();
  summary_.cost_per_iteration.insert(summary_.cost_per_iteration.end(), costs.begin(), costs.end());
}

}  // namespace soslam
