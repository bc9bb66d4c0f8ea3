// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/held_views_term.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mapping/tangencies_of_four.h"

namespace soslam {
namespace {

using FourViews = HeldViewsTerm::FourViews;

SOSLAM_MULTIVERSION void AddUpViews(const std::vector<FourViews>& all, const BodyInWorld& body,
                                    const HuberLoss& loss, Hessian hessian,
                                    LandmarkSums<double>* totals) {
  SumsOfFour sums{};
  for (const FourViews& views : all) {
    DepthsOfFour depths;
    FindDepths(views.camera, views.optical_axis, views.least_depth_m, body, &depths);
    std::array<GradientOfFour, 4> gradients;
    std::array<WeightsOfFour, 4> weights;
    for (size_t side = 0; side < 4; ++side) {
      ExcessOfFour excess;
      FindExcess(views.sides[side].planes, body, depths, &excess, &gradients[side]);
      LossesOfFour losses;
      FindLosses(views.sides[side], excess.value, loss, hessian, &losses);
      sums.numbers[sums.kCost] += losses.cost;
      FindWeights(body, depths, excess, losses, hessian, &weights[side]);
      AddCurvature(body, depths, excess, losses, hessian, &sums);
    }
    AddGradients(gradients, weights, depths.by_centre, &sums);
  }
  AddCurvatureByAxes(body, hessian, &sums);
  AddUp(sums, totals);
}

}  // namespace

HeldViewsTerm::HeldViewsTerm(int variable, const double* landmark_in_world,
                             const std::vector<HeldView>& views, double huber_delta)
    : Term({variable}),
      landmark_in_world_(landmark_in_world),
      shape_exponent_(views.front().box.shape_exponent),
      loss_{huber_delta},
      views_((views.size() + 3) / 4) {
  for (size_t i = 0; i < 4 * views_.size(); ++i) {
    const HeldView& view = views[std::min(i, views.size() - 1)];
    FourViews& four = views_[i / 4];
    const size_t place = i % 4;
    const Eigen::Matrix3d world_from_camera = view.world_from_camera.rotation.toRotationMatrix();
    const auto set = [place](const Eigen::Vector3d& vector, ThreeFours* of_four) {
      for (size_t k = 0; k < 3; ++k) (*of_four)[k][place] = vector[static_cast<int>(k)];
    };
    set(view.world_from_camera.translation, &four.camera);
    set(world_from_camera.col(2), &four.optical_axis);
    four.least_depth_m[place] = view.box.least_depth_m;
    if (i >= views.size()) continue;
    for (int k = 0; k < view.box.num_edges; ++k) {
      const TangentBox::Edge& edge = view.box.edges[static_cast<size_t>(k)];
      four.sides[static_cast<size_t>(edge.side)].Set(place, world_from_camera * edge.plane, edge,
                                                     view.weight);
    }
  }
}

double HeldViewsTerm::Linearise(Hessian hessian, const TermPlaces& places) const {
  const BodyInWorld body(landmark_in_world_, shape_exponent_);
  LandmarkSums<double> sums;
  AddUpViews(views_, body, loss_, hessian, &sums);
  const LandmarkDerivatives found(sums, body.world_from_object);
  if (std::isfinite(found.cost) && places.gradient[0] != nullptr) {
    found.AddTo(places.gradient[0], places.hessian[0][0]);
  }
  return found.cost;
}

}  // namespace soslam
