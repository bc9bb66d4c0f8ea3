// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/tangency_term.h"

#include <Eigen/Geometry>
#include <cmath>

#include "constraints/tangent_space.h"
#include "mapping/tangencies_of_four.h"

namespace soslam {
namespace {

using PoseGradient = Eigen::Matrix<double, kPoseDof, 1>;
using PosePose = Eigen::Matrix<double, kPoseDof, kPoseDof>;
template <int kRows>
using ByLandmark = Eigen::Matrix<double, kRows, kLandmarkDof>;
template <int kRows>
using ByPose = Eigen::Matrix<double, kRows, kPoseDof>;

struct CameraInWorld {
  explicit CameraInWorld(const double* world_from_camera)
      : rotation(Eigen::Quaterniond(world_from_camera).toRotationMatrix()),
        centre(world_from_camera + 4) {}

  Eigen::Matrix3d rotation;  // world from camera
  Eigen::Vector3d centre;
};

// Derivatives by the detector's bias, a row for each side.
struct alignas(kFourAlignment) BiasRows {
  Eigen::Vector4d gradient;
  Eigen::Vector4d curvatures;
  ByLandmark<kBiasSize> by_landmark;  // second ones; of these, turns are in the object frame
};

SOSLAM_FORCE_INLINE void FindBiasRows(const Four& per_px, const LossesOfFour& losses,
                                      const GradientOfFour& gradient, BiasRows* rows) {
  const Four by_excess = -per_px * losses.curvature;
  Store(-per_px * losses.slope, rows->gradient.data());
  Store(-per_px * by_excess, rows->curvatures.data());
  for (int i = 0; i < kLandmarkDof; ++i) {
    Store(by_excess * gradient[static_cast<size_t>(i)], rows->by_landmark.col(i).data());
  }
}

SOSLAM_MULTIVERSION void AddUpEdges(const FourEdges& edges, const Four& per_px,
                                    const CameraInWorld& camera, double least_depth_m,
                                    const double* bias_px, const BodyInWorld& body,
                                    const HuberLoss& loss, Hessian hessian,
                                    LandmarkSums<double>* totals, BiasRows* of_bias) {
  ThreeFours centre, optical_axis, planes;
  for (int i = 0; i < 3; ++i) {
    const auto component = static_cast<size_t>(i);
    centre[component] = Four{} + camera.centre[i];
    optical_axis[component] = Four{} + camera.rotation(i, 2);
    planes[component] = camera.rotation(i, 0) * edges.planes[0] +
                        camera.rotation(i, 1) * edges.planes[1] +
                        camera.rotation(i, 2) * edges.planes[2];
  }
  DepthsOfFour depths;
  FindDepths(centre, optical_axis, Four{} + least_depth_m, body, &depths);
  ExcessOfFour excess;
  std::array<GradientOfFour, 1> gradient;
  FindExcess(planes, body, depths, &excess, gradient.data());
  Four bias;
  Load(bias_px, &bias);
  LossesOfFour losses;
  FindLosses(edges, excess.value - per_px * bias, loss, hessian, &losses);
  std::array<WeightsOfFour, 1> weights;
  FindWeights(body, depths, excess, losses, hessian, weights.data());
  SumsOfFour sums{};
  sums.numbers[sums.kCost] = losses.cost;
  AddCurvature(body, depths, excess, losses, hessian, &sums);
  AddGradients(gradient, weights, depths.by_centre, &sums);
  AddCurvatureByAxes(body, hessian, &sums);
  AddUp(sums, totals);
  if (of_bias != nullptr) FindBiasRows(per_px, losses, gradient[0], of_bias);
}

// Derivatives (rows) by a rotation v of the camera that sees a landmark, from those by the
// landmark: the landmark rotates by -v about the centre of the camera.
template <int kRows>
Eigen::Matrix<double, kRows, 3> ByCameraTurn(const ByLandmark<kRows>& by_landmark,
                                             const Eigen::Vector3d& offset) {
  return by_landmark.template middleCols<3>(kByCentre).rowwise().cross(offset) -
         by_landmark.template middleCols<3>(kByTurn);
}

// The camera moves against the landmark.
void AddByPose(const LandmarkDerivatives& by_landmark, const Eigen::Vector3d& offset,
               Hessian hessian, const TermPlaces& places) {
  const auto& gradient = by_landmark.gradient;
  const auto by_centre = by_landmark.hessian.middleCols<3>(kByCentre);
  Eigen::Matrix<double, kLandmarkDof, 3> by_turn =
      ByCameraTurn<kLandmarkDof>(by_landmark.hessian, offset);
  if (hessian == Hessian::kNear) {
    // What the chain itself bends by: exp(-v) exp(w) is a turn by w - v - v x w / 2, and a step of
    // the centre turns by -v.
    by_turn.topRows<3>() -= 0.5 * Skew(gradient.segment<3>(kByTurn));
    by_turn.middleRows<3>(kByCentre) -= Skew(gradient.segment<3>(kByCentre));
  }
  Eigen::Map<PoseGradient> pose_gradient(places.gradient[0]);
  pose_gradient.head<3>() += ByCameraTurn<1>(gradient.transpose(), offset).transpose();
  pose_gradient.tail<3>() -= gradient.segment<3>(kByCentre);

  // Turns one after another: the mean of both orders.
  const Eigen::Matrix3d turn_turn =
      by_turn.middleRows<3>(kByCentre).colwise().cross(offset) - by_turn.topRows<3>();
  Eigen::Map<PosePose> square(places.hessian[0][0]);
  square.topLeftCorner<3, 3>() += 0.5 * (turn_turn + turn_turn.transpose());
  square.bottomLeftCorner<3, 3>() -= by_turn.middleRows<3>(kByCentre);
  square.bottomRightCorner<3, 3>() += by_centre.middleRows<3>(kByCentre);
  if (places.hessian[1][0] == nullptr) return;
  Eigen::Map<ByPose<kLandmarkDof>> mixed(places.hessian[1][0]);
  mixed.leftCols<3>() += by_turn;
  mixed.rightCols<3>() -= by_centre;
}

void AddBias(BiasRows rows, const Eigen::Matrix3d& world_from_object, const Eigen::Vector3d& offset,
             const TermPlaces& places) {
  rows.by_landmark.leftCols<3>() =
      rows.by_landmark.leftCols<3>().lazyProduct(world_from_object.transpose()).eval();
  Eigen::Map<Eigen::Vector4d>(places.gradient[2]) += rows.gradient;
  Eigen::Map<Eigen::Matrix4d>(places.hessian[2][2]).diagonal() += rows.curvatures;
  if (places.hessian[2][1] != nullptr) {
    Eigen::Map<ByLandmark<kBiasSize>>(places.hessian[2][1]) += rows.by_landmark;
  }
  if (places.hessian[2][0] == nullptr) return;
  Eigen::Map<ByPose<kBiasSize>> mixed(places.hessian[2][0]);
  mixed.leftCols<3>() += ByCameraTurn(rows.by_landmark, offset);
  mixed.rightCols<3>() -= rows.by_landmark.middleCols<3>(kByCentre);
}

}  // namespace

TangencyTerm::TangencyTerm(const std::array<int, 3>& variables, const Blocks& blocks,
                           const TangentBox& box, double huber_delta, double weight)
    : Term({variables.begin(), variables.end()}),
      blocks_(blocks),
      shape_exponent_(box.shape_exponent),
      least_depth_m_(box.least_depth_m),
      loss_{huber_delta} {
  for (int k = 0; k < box.num_edges; ++k) {
    const TangentBox::Edge& edge = box.edges[static_cast<size_t>(k)];
    const auto side = static_cast<size_t>(edge.side);
    edges_.Set(side, edge.plane, edge, weight);
    per_px_[side] = edge.per_px;
  }
}

double TangencyTerm::Linearise(Hessian hessian, const TermPlaces& places) const {
  const auto [of_pose, of_landmark, of_bias] = places.gradient;
  const CameraInWorld camera(blocks_.world_from_camera);
  const BodyInWorld body(blocks_.landmark_in_world, shape_exponent_);
  LandmarkSums<double> sums;
  BiasRows bias;
  AddUpEdges(edges_, per_px_, camera, least_depth_m_, blocks_.bias_px, body, loss_, hessian, &sums,
             of_bias != nullptr ? &bias : nullptr);
  const LandmarkDerivatives found(sums, body.world_from_object);
  if (!std::isfinite(found.cost)) return found.cost;

  const Eigen::Vector3d offset = body.centre - camera.centre;
  if (of_landmark != nullptr) found.AddTo(of_landmark, places.hessian[1][1]);
  if (of_pose != nullptr) AddByPose(found, offset, hessian, places);
  if (of_bias != nullptr) AddBias(bias, body.world_from_object, offset, places);
  return found.cost;
}

}  // namespace soslam
