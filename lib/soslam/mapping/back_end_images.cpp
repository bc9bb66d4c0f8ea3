// SPDX-License-Identifier: BSD-3-Clause
// Residuals of texture, edges and points of BackEndProblem.
#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "soslam/base/parallel.h"
#include "soslam/constraints/landmark_cost.h"
#include "soslam/mapping/back_end_problem.h"

namespace soslam {
namespace {

constexpr const char* kNoPoints = "objects_without_points";

}  // namespace

void BackEndProblem::RenewImageResiduals() {
  for (auto* blocks : {&image_blocks_, &point_blocks_}) {
    for (const ceres::ResidualBlockId block : *blocks) problem_.RemoveResidualBlock(block);
    blocks->clear();
  }
  summary_.constant_cost = 0.0;
  for (const std::string& name : image_residuals_) summary_.residuals.erase(name);
  for (const std::string& reason : images_without_residuals_) summary_.gated.erase(reason);
  summary_.gated.erase(kNoPoints);
  const auto is_used = [&](int detection_index) {
    const auto& detection = input_.sequence.detections[detection_index];
    return input_.initial_landmarks[detection.object_index].has_value();
  };
  std::vector<size_t> detections;
  std::vector<std::function<ImageBlocks()>> makers;
  for (const auto& [index, image] : input_.images) {
    if (!is_used(index)) continue;
    detections.push_back(index);
    makers.push_back(
        [this, index = detections.back(), &image = *image] { return BlocksOfImage(index, image); });
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
  auto& [residuals, of_points] = blocks;
  summary_.constant_cost += residuals.constant_cost;
  if (residuals.functions.empty()) {
    ++summary_.gated[residuals.why_none];
    images_without_residuals_.insert(residuals.why_none);
    return;
  }
  summary_.residuals[residuals.name] += residuals.count;
  image_residuals_.insert(residuals.name);
  const Detection& detection = input_.sequence.detections[index];
  auto& added = of_points ? point_blocks_ : image_blocks_;
  // Costs of bodies of any shape are bounded.
  ceres::LossFunction* loss = IsTangency() ? nullptr : &loss_;
  for (auto& function : residuals.functions) {
    added.push_back(problem_.AddResidualBlock(function.release(), loss, Pose(detection),
                                              LandmarkOf(detection)));
  }
}

BackEndProblem::ImageBlocks BackEndProblem::BlocksOfImage(size_t index,
                                                          const ImageEvidence& image) const {
  const Detection& detection = input_.sequence.detections[index];
  std::optional<Landmark> weighed_at;
  if (!input_.images_weighed_at.empty()) {
    weighed_at = input_.images_weighed_at[detection.object_index];
  }
  if (weighed_at) {
    weighed_at = Transform(variables_.PoseValue(detection.frame_index).Inverse(), *weighed_at);
  }
  return {image.ResidualsAt(LandmarkInCamera(detection), weighed_at ? &*weighed_at : nullptr,
                            view_weights_[index])};
}

PointCost BackEndProblem::MakePointCost(size_t object_index, const PointsInView& view,
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

std::vector<PointPosterior> BackEndProblem::ComputePosteriors(size_t object_index) const {
  std::vector<PointPosterior> points;
  if (input_.points.empty() || !input_.initial_landmarks[object_index]) return points;
  for (const PointsInView& view : input_.points[object_index]) {
    const Landmark in_camera = LandmarkInCamera(input_.sequence.detections[view.detection_index]);
    std::ranges::copy(MakePointCost(object_index, view, in_camera).Posteriors(in_camera),
                      std::back_inserter(points));
  }
  std::ranges::stable_sort(points, {}, &PointPosterior::point);
  return points;
}

BackEndProblem::ImageBlocks BackEndProblem::PointBlocks(size_t object_index,
                                                        const PointsInView& view) const {
  const Detection& detection = input_.sequence.detections[view.detection_index];
  const Landmark in_camera = LandmarkInCamera(detection);
  auto points = std::make_unique<PointCost>(MakePointCost(object_index, view, in_camera));
  ImageBlocks blocks{{"points", "", {}, static_cast<int>(view.points.size())}, true};
  blocks.residuals.functions.push_back(
      std::make_unique<ImageResidual>(std::move(points), in_camera.shape_exponents));
  return blocks;
}

}  // namespace soslam
