// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/view_term.h"

#include <cmath>
#include <limits>
#include <utility>

#include "constraints/parameters.h"
#include "constraints/tangent_space.h"

namespace soslam {
namespace {

template <int kRows, int kColumns>
using Place = Eigen::Map<Eigen::Matrix<double, kRows, kColumns>>;

// d landmark in the camera / d world_from_camera, along the axes of the world: it turns and moves
// against the camera, and around it.
Eigen::Matrix<double, kLandmarkDof, kPoseDof> ByPose(const Eigen::Vector3d& offset_in_world) {
  Eigen::Matrix<double, kLandmarkDof, kPoseDof> by_pose;
  by_pose.setZero();
  by_pose.topRows<kPoseDof>().diagonal().setConstant(-1.0);
  by_pose.block<3, 3>(3, 0) = Skew(offset_in_world);
  return by_pose;
}

double FiniteOrInfinite(double cost) {
  return std::isfinite(cost) ? cost : std::numeric_limits<double>::infinity();
}

}  // namespace

ViewTerm::ViewTerm(const std::array<int, 2>& variables, const Blocks& blocks, double shape_exponent,
                   std::unique_ptr<const LandmarkCost> in_camera)
    : Term({variables.begin(), variables.end()}),
      blocks_(blocks),
      shape_exponent_(shape_exponent),
      in_camera_(std::move(in_camera)) {}

double ViewTerm::Cost() const {
  const std::array blocks = {blocks_.world_from_camera, blocks_.landmark_in_world};
  const RelativeObservation observation(blocks.data(), shape_exponent_);
  return FiniteOrInfinite(in_camera_->Value(observation.landmark_in_camera()));
}

double ViewTerm::Linearise(Hessian /*hessian*/, const TermPlaces& places) const {
  const std::array blocks = {blocks_.world_from_camera, blocks_.landmark_in_world};
  const RelativeObservation observation(blocks.data(), shape_exponent_);
  LandmarkModel in_camera;
  in_camera_->AddTo(observation.landmark_in_camera(), &in_camera);
  const double cost = FiniteOrInfinite(in_camera.cost);
  if (!std::isfinite(cost)) return cost;
  const LandmarkModel model =
      in_camera.Chained(LandmarkInCameraBy(observation.camera_from_world()));
  const auto [of_pose, of_landmark, none] = places.gradient;
  if (of_landmark != nullptr) {
    Place<kLandmarkDof, 1>(of_landmark) += model.gradient;
    Place<kLandmarkDof, kLandmarkDof>(places.hessian[1][1]) += model.information;
  }
  if (of_pose == nullptr) return cost;
  const auto by_pose = ByPose(observation.offset_in_world());
  const auto of_camera = model.Chained(by_pose);
  Place<kPoseDof, 1>(of_pose) += of_camera.gradient;
  Place<kPoseDof, kPoseDof>(places.hessian[0][0]) += of_camera.information;
  if (of_landmark != nullptr) {
    Place<kLandmarkDof, kPoseDof>(places.hessian[1][0]) += model.information.lazyProduct(by_pose);
  }
  return cost;
}

}  // namespace soslam
