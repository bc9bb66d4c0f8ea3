// SPDX-License-Identifier: BSD-3-Clause
// Residuals of texture, edges and points of BackEndProblem.
#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "base/parallel.h"
#include "constraints/landmark_cost.h"
#include "mapping/back_end_problem.h"
#include "orientation/texture_asymmetry.h"

namespace soslam {
namespace {

// Kinds of residuals, and reasons for leaving something out.
constexpr const char* kSymmetry = "symmetry";
constexpr const char* kEdges = "edges";
constexpr const char* kPoints = "points";
constexpr const char* kTooFewPairs = "symmetry_with_too_few_visible_pairs";
constexpr const char* kNoPoints = "objects_without_points";
constexpr const char* kNoEdgeCounts = "no_edge_point_counts";

}  // namespace

void BackEndProblem::RenewImageResiduals() {
  for (auto* blocks : {&image_blocks_, &point_blocks_}) {
    for (const ceres::ResidualBlockId block : *blocks) problem_.RemoveResidualBlock(block);
    blocks->clear();
  }
  summary_.constant_cost = 0.0;
  for (const char* kind : {kSymmetry, kEdges, kPoints}) summary_.residuals.erase(kind);
  for (const char* reason : {kTooFewPairs, kNoEdgeCounts, kNoPoints}) summary_.gated.erase(reason);
  const auto is_used = [&](int detection_index) {
    const auto& detection = input_.sequence.detections[detection_index];
    return input_.initial_landmarks[detection.object_index].has_value();
  };
  std::vector<size_t> detections;
  std::vector<std::function<ImageBlocks()>> makers;
  for (const auto& [index, image] : input_.symmetry_images) {
    if (!is_used(index)) continue;
    detections.push_back(index);
    makers.push_back([this, index = detections.back(), &image = image] {
      return IsTangency() ? TextureBlocks(index, image) : PairBlocks(index, image);
    });
  }
  for (const auto& [index, image] : input_.edge_images) {
    if (!is_used(index)) continue;
    detections.push_back(index);
    makers.push_back(
        [this, index = detections.back(), &image = image] { return EdgeBlocks(index, image); });
  }
  for (size_t i = 0; i < input_.points.size(); ++i) {
    if (!input_.initial_landmarks[i]) continue;
    if (input_.points[i].empty()) ++summary_.gated[kNoPoints];
    for (const PointsInView& view : input_.points[i]) {
      detections.push_back(view.detection_index);
      makers.push_back([this, i, &view = view] { return PointBlocks(i, view); });
    }
  }
  std::vector<ImageBlocks> made(makers.size());
  ParallelFor(makers.size(), threads_, [&](size_t i) { made[i] = makers[i](); });
  for (size_t i = 0; i < made.size(); ++i) AddImageBlocks(detections[i], std::move(made[i]));
  SetManifolds();
}

void BackEndProblem::AddImageBlocks(size_t index, ImageBlocks blocks) {
  summary_.constant_cost += blocks.constant_cost;
  if (blocks.functions.empty()) {
    ++summary_.gated[blocks.reason_for_none];
    return;
  }
  summary_.residuals[blocks.kind] += blocks.count;
  const Detection& detection = input_.sequence.detections[index];
  auto& added = blocks.kind == kPoints ? point_blocks_ : image_blocks_;
  // Costs of bodies of any shape are bounded.
  ceres::LossFunction* loss = IsTangency() ? nullptr : &loss_;
  for (auto& function : blocks.functions) {
    added.push_back(problem_.AddResidualBlock(function.release(), loss, Pose(detection),
                                              LandmarkOf(detection)));
  }
}

BackEndProblem::ImageBlocks BackEndProblem::TextureBlocks(
    size_t index, const std::shared_ptr<const SymmetryImage>& image) const {
  const Detection& detection = input_.sequence.detections[index];
  const Landmark in_camera = LandmarkInCamera(detection);
  auto texture = std::make_unique<AsymmetryCost>(image, input_.sequence.CameraOf(detection),
                                                 in_camera, options_.texture,
                                                 options_.symmetry_options, view_weights_[index]);
  ImageBlocks blocks{kSymmetry, kTooFewPairs, texture->NumPairs(), {}};
  if (blocks.count == 0) {
    blocks.constant_cost = view_weights_[index] * options_.texture.asymmetry_cost;
  } else {
    blocks.functions.push_back(
        std::make_unique<ImageResidual>(std::move(texture), in_camera.shape_exponents));
  }
  return blocks;
}

BackEndProblem::ImageBlocks BackEndProblem::PairBlocks(
    size_t index, const std::shared_ptr<const SymmetryImage>& image) const {
  const Detection& detection = input_.sequence.detections[index];
  const Landmark in_camera = LandmarkInCamera(detection);
  const Camera& camera = input_.sequence.CameraOf(detection);
  const SymmetryOptions& symmetry = options_.symmetry_options;
  const SymmetryDescriptor descriptor(symmetry.descriptor, *image, camera, in_camera);
  const auto samples = SamplePixels(*image, camera, in_camera, symmetry);
  std::vector<Eigen::Vector2d> visible;
  for (const Eigen::Vector2d& pixel : samples) {
    if (descriptor.Evaluate(pixel, symmetry.min_viewing_cosine, false)) visible.push_back(pixel);
  }
  ImageBlocks blocks{kSymmetry, kTooFewPairs, static_cast<int>(visible.size()), {}};
  if (blocks.count < symmetry.MinPairs(samples.size())) return blocks;
  for (const Eigen::Vector2d& pixel : visible) {
    blocks.functions.push_back(
        std::make_unique<SymmetryResidual>(symmetry.descriptor, image, camera, pixel,
                                           in_camera.shape_exponents, options_.symmetry_sigma));
  }
  return blocks;
}

PointCost BackEndProblem::PointCostOf(size_t object_index, const PointsInView& view,
                                      const Landmark& start_in_camera) const {
  const double weight = PointWeight(input_.points[object_index], options_.points);
  return {view.points,     start_in_camera, SizeForPoints(start_in_camera),
          options_.points, weight,          second_derivatives_of_points_};
}

void BackEndProblem::PrepareCovariances() {
  second_derivatives_of_points_ = PointCost::SecondDerivatives::kFisherInformation;
  for (const ceres::ResidualBlockId block : point_blocks_) problem_.RemoveResidualBlock(block);
  point_blocks_.clear();
  for (size_t i = 0; i < input_.points.size(); ++i) {
    if (!input_.initial_landmarks[i]) continue;
    for (const PointsInView& view : input_.points[i]) {
      AddImageBlocks(view.detection_index, PointBlocks(i, view));
    }
  }
}

std::vector<PointPosterior> BackEndProblem::PointsOf(size_t object_index) const {
  std::vector<PointPosterior> points;
  if (input_.points.empty() || !input_.initial_landmarks[object_index]) return points;
  for (const PointsInView& view : input_.points[object_index]) {
    const Landmark in_camera = LandmarkInCamera(input_.sequence.detections[view.detection_index]);
    std::ranges::copy(PointCostOf(object_index, view, in_camera).Posteriors(in_camera),
                      std::back_inserter(points));
  }
  std::ranges::stable_sort(points, {}, &PointPosterior::point);
  return points;
}

BackEndProblem::ImageBlocks BackEndProblem::PointBlocks(size_t object_index,
                                                        const PointsInView& view) const {
  const Detection& detection = input_.sequence.detections[view.detection_index];
  const Landmark in_camera = LandmarkInCamera(detection);
  auto points = std::make_unique<PointCost>(PointCostOf(object_index, view, in_camera));
  ImageBlocks blocks{kPoints, nullptr, static_cast<int>(view.points.size()), {}};
  blocks.functions.push_back(
      std::make_unique<ImageResidual>(std::move(points), in_camera.shape_exponents));
  return blocks;
}

BackEndProblem::ImageBlocks BackEndProblem::EdgeBlocks(
    size_t index, const std::shared_ptr<const EdgeImage>& image) const {
  const Detection& detection = input_.sequence.detections[index];
  const Landmark in_camera = LandmarkInCamera(detection);
  auto edges = std::make_unique<EdgeCost>(image, input_.sequence.CameraOf(detection), in_camera,
                                          options_.edges);
  // Where an object's model edges are not visible in the image, as for the cuboid of a chair, the
  // edges that happen to be near carry no information.
  double support = edges->Support(in_camera);
  if (!input_.edges_weighed_at.empty()) {
    const Landmark other = Transform(variables_.PoseValue(detection.frame_index).Inverse(),
                                     *input_.edges_weighed_at[detection.object_index]);
    support =
        EdgeCost(image, input_.sequence.CameraOf(detection), other, options_.edges).Support(other);
  }
  edges->Weigh(view_weights_[index] * support * support);
  ImageBlocks blocks{kEdges, kNoEdgeCounts, 1, {}, edges->ConstantCost()};
  if (edges->NumPoints() > 0) {
    blocks.functions.push_back(
        std::make_unique<ImageResidual>(std::move(edges), in_camera.shape_exponents));
  }
  return blocks;
}

}  // namespace soslam
