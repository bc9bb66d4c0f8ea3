// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/held_views_term.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "constraints/tangent_space.h"
#include "geometry/support_of_four.h"

namespace soslam {
namespace {

using FourViews = HeldViewsTerm::FourViews;

struct Body {
  Eigen::Matrix3d world_from_object;
  Eigen::Vector3d centre;
  Eigen::Vector3d half_axes;
  double shape_exponent;
};

// By the turn of the body in its own frame, its centre in the world and the logarithms of its half
// axes.
enum { kTurn = 0, kCentre = 3, kAxes = 6 };
using Gradient = std::array<Four, kLandmarkDof>;

struct alignas(kFourAlignment) Sums {
  Four cost{};
  Gradient gradient{};
  std::array<Gradient, kLandmarkDof> hessian{};  // the lower triangle
};

// The centres as four cameras see them.
struct Depths {
  ThreeFours offset;  // from the camera
  Four depth_m;
  Four inverse;
  ThreeFours by_centre;  // relative change; 0 where the depth is held
};

// What lies outside the plane behind an edge, over the centre's depth.
struct Excess {
  ThreeFours normal;  // m, of the plane in the object frame
  SupportOfFour support;
  ThreeFours by_turn;  // dh / dm x m
  Four value;
  Gradient gradient;
};

// What the losses make of four excesses.
struct Losses {
  Four cost;
  Four slope;
  Four curvature;
};

SOSLAM_IN_WIDE_LOOPS void FindDepths(const FourViews& views, const Body& body, Depths* depths) {
  Four depth{};
  for (size_t i = 0; i < 3; ++i) {
    depths->offset[i] = body.centre[static_cast<int>(i)] - views.camera[i];
    depth += views.optical_axis[i] * depths->offset[i];
  }
  const FourMask is_free = depth > views.least_depth_m;
  depths->depth_m = is_free ? depth : views.least_depth_m;
  depths->inverse = 1.0 / depths->depth_m;
  for (int i = 0; i < 3; ++i) {
    depths->by_centre[i] = is_free ? depths->inverse * views.optical_axis[i] : Four{};
  }
}

SOSLAM_IN_WIDE_LOOPS void FindExcess(const ThreeFours& plane, const Body& body,
                                     const Depths& depths, Excess* excess) {
  Four outside{};
  for (int i = 0; i < 3; ++i) {
    outside += plane[i] * depths.offset[i];
    excess->normal[i] = body.world_from_object(0, i) * plane[0] +
                        body.world_from_object(1, i) * plane[1] +
                        body.world_from_object(2, i) * plane[2];
  }
  const ThreeFours& m = excess->normal;
  SupportOfFour& support = excess->support;
  FindSupport(body.half_axes, body.shape_exponent, m, &support);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    excess->by_turn[i] = m[j] * m[k] * (support.shares[j] - support.shares[k]);
  }
  excess->value = (outside + support.extent) * depths.inverse;
  for (int i = 0; i < 3; ++i) {
    excess->gradient[kTurn + i] = depths.inverse * excess->by_turn[i];
    excess->gradient[kCentre + i] = depths.inverse * plane[i] - excess->value * depths.by_centre[i];
    excess->gradient[kAxes + i] = depths.inverse * support.by_log_half_axes[i];
  }
}

// Of a bound that is not reached, nothing. Excesses that are not finite make the cost so, even
// those without weight: nothing that is made of them is to be added.
SOSLAM_IN_WIDE_LOOPS void FindLosses(const FourViews& views, size_t side, const Four& excess,
                                     const HuberLoss& loss, bool is_near, Losses* losses) {
  const FourMask is_idle = (views.is_bound[side] > 0.0) & (excess > 0.0);
  const Four weight = is_idle ? Four{} : views.weights[side];
  const HuberLoss::FourValues values = loss(excess < 0.0 ? -excess : excess);
  losses->cost = weight * values.cost;
  losses->slope = weight * values.weight * excess;
  losses->curvature = weight * (is_near ? values.curvature : values.weight);
}

// Where the body turns past an edge or a face that should come nearer, it is held there. Not so
// where it should go away from it.
SOSLAM_IN_WIDE_LOOPS bool HasKinks(const Body& body, Hessian hessian) {
  return hessian == Hessian::kFar && body.shape_exponent < kEllipsoidExponent;
}

// What multiplies products of the gradient of an excess in the Hessian: d^2 cost / d excess^2, and
// where h bends, less what it bends by along its own gradient, by turns and half axes.
struct Weights {
  Four turn_turn;
  Four centre;  // by all
  Four axes;    // by turns and axes
  // By the centre and all, of the gradient times the relative change of the depth, which divides
  // all.
  Four depth;
};

SOSLAM_IN_WIDE_LOOPS void FindWeights(const Body& body, const Depths& depths, const Excess& excess,
                                      const Losses& losses, Hessian hessian, Weights* weights) {
  const Four less =
      losses.slope * depths.depth_m * (body.shape_exponent - 1.0) * excess.support.inverse;
  *weights = {losses.curvature, losses.curvature, losses.curvature, Four{}};
  if (hessian == Hessian::kNear) {
    weights->turn_turn -= less;
    weights->axes -= less;
    weights->depth = losses.slope;
  } else if (HasKinks(body, hessian)) {
    weights->turn_turn -= less > 0.0 ? less : Four{};
  }
}

// The products of gradients.
SOSLAM_IN_WIDE_LOOPS void AddProducts(const std::array<Excess, 4>& excesses,
                                      const std::array<Weights, 4>& weights,
                                      const ThreeFours& depth_by_centre, Sums* sums) {
  const auto add = [&](size_t i, size_t begin, size_t end, const std::array<Four, 4>& weighted) {
    for (size_t j = begin; j < end; ++j) {
      Four& sum = sums->hessian[i][j];
      for (size_t side = 0; side < 4; ++side) sum += weighted[side] * excesses[side].gradient[j];
    }
  };
  std::array<Four, 4> weighted;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t side = 0; side < 4; ++side) {
      weighted[side] = weights[side].turn_turn * excesses[side].gradient[kTurn + i];
    }
    add(kTurn + i, kTurn, kTurn + i + 1, weighted);
    for (size_t side = 0; side < 4; ++side) {
      weighted[side] = weights[side].axes * excesses[side].gradient[kAxes + i];
    }
    add(kAxes + i, kTurn, kTurn + 3, weighted);
    add(kAxes + i, kAxes, kAxes + i + 1, weighted);
    Four slope{};
    for (size_t side = 0; side < 4; ++side) {
      const Four& by_centre = excesses[side].gradient[kCentre + i];
      slope += weights[side].depth * by_centre;
      weighted[side] = weights[side].centre * by_centre - weights[side].depth * depth_by_centre[i];
    }
    add(kCentre + i, kTurn, kTurn + 3, weighted);
    add(kCentre + i, kCentre, kCentre + i + 1, weighted);
    for (size_t j = 0; j <= i; ++j) {
      sums->hessian[kCentre + i][kCentre + j] -= slope * depth_by_centre[j];
    }
    for (size_t j = 0; j < 3; ++j) {
      Four& sum = sums->hessian[kAxes + j][kCentre + i];
      for (size_t side = 0; side < 4; ++side) {
        sum += weighted[side] * excesses[side].gradient[kAxes + j];
      }
    }
  }
}

// By turns, what h grows by as the contact moves along the body: its second derivatives by m
// (CurvatureOfSupport). What those have along m itself is not seen by a turn. Less what
// FindWeights has of it.
SOSLAM_IN_WIDE_LOOPS void AddMoveOfContact(const Body& body, const Excess& excess,
                                           const Four& factor, Sums* sums) {
  const ThreeFours& m = excess.normal;
  const SupportOfFour& support = excess.support;
  const ThreeFours& shares = support.shares;
  const double p = body.shape_exponent;
  const Four rounding = SquaredRounding(p) * (shares[0] + shares[1] + shares[2]);
  ThreeFours diagonal;
  for (size_t i = 0; i < 3; ++i) {
    diagonal[i] = factor * (shares[i] + rounding);
    if (p == kEllipsoidExponent) continue;
    diagonal[i] -= factor * (2.0 - p) * shares[i] * m[i] * m[i] / support.squares[i];
  }
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    auto& turn_row = sums->hessian[kTurn + i];
    turn_row[kTurn + i] += diagonal[j] * m[k] * m[k] + diagonal[k] * m[j] * m[j];
    for (size_t l = 0; l < i; ++l) turn_row[kTurn + l] -= diagonal[3 - i - l] * m[i] * m[l];
  }
}

// All others of h: by turns of a contact q that stays, and by the half axes.
SOSLAM_IN_WIDE_LOOPS void AddOtherCurvature(const Body& body, const Excess& excess,
                                            const Four& factor, Sums* sums) {
  const ThreeFours& m = excess.normal;
  const SupportOfFour& support = excess.support;
  const double p = body.shape_exponent;
  const Four factor_of_axes = factor * p;
  ThreeFours q = support.Contact(p, m);
  for (size_t i = 0; i < 3; ++i) q[i] *= factor;
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    auto& turn_row = sums->hessian[kTurn + i];
    turn_row[kTurn + i] -= m[j] * q[j] + m[k] * q[k];
    for (size_t l = 0; l < i; ++l) turn_row[kTurn + l] += 0.5 * (m[i] * q[l] + m[l] * q[i]);

    auto& axis_row = sums->hessian[kAxes + i];
    const Four edge = factor_of_axes * support.shares[i] * m[i];
    axis_row[kTurn + j] -= edge * m[k];
    axis_row[kTurn + k] += edge * m[j];
    axis_row[kAxes + i] += factor_of_axes * support.by_log_half_axes[i];
  }
}

SOSLAM_WIDE_LOOPS void AddViews(const std::vector<FourViews>& all, const Body& body,
                                const HuberLoss& loss, Hessian hessian, Sums* sums) {
  const bool is_near = hessian == Hessian::kNear;
  for (const FourViews& views : all) {
    Depths depths;
    FindDepths(views, body, &depths);
    std::array<Excess, 4> excesses;
    std::array<Weights, 4> weights;
    Gradient gradient{};
    for (size_t side = 0; side < 4; ++side) {
      Excess& excess = excesses[side];
      FindExcess(views.planes[side], body, depths, &excess);
      Losses losses;
      FindLosses(views, side, excess.value, loss, is_near, &losses);
      sums->cost += losses.cost;
      for (size_t i = 0; i < kLandmarkDof; ++i) gradient[i] += losses.slope * excess.gradient[i];
      FindWeights(body, depths, excess, losses, hessian, &weights[side]);
      const Four factor = losses.slope * depths.inverse;
      if (is_near) {
        AddMoveOfContact(body, excess, factor, sums);
        AddOtherCurvature(body, excess, factor, sums);
      } else if (HasKinks(body, hessian)) {
        AddMoveOfContact(body, excess, factor > 0.0 ? factor : Four{}, sums);
      }
    }
    for (size_t i = 0; i < kLandmarkDof; ++i) sums->gradient[i] += gradient[i];
    AddProducts(excesses, weights, depths.by_centre, sums);
  }
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
    for (size_t side = 0; side < 4; ++side) {
      set(world_from_camera.col(2), &four.planes[side]);  // any but zero
      four.weights[side][place] = four.is_bound[side][place] = 0.0;
    }
    for (int k = 0; k < view.box.num_edges; ++k) {
      const TangentBox::Edge& edge = view.box.edges[static_cast<size_t>(k)];
      const auto side = static_cast<size_t>(edge.side);
      set(world_from_camera * edge.plane, &four.planes[side]);
      four.weights[side][place] = i < views.size() ? view.weight : 0.0;
      four.is_bound[side][place] = edge.is_bound ? 1.0 : 0.0;
    }
  }
}

double HeldViewsTerm::Linearise(Hessian hessian, const TermPlaces& places) const {
  const Body body = {
      Eigen::Quaterniond(landmark_in_world_).toRotationMatrix(),
      Eigen::Vector3d(landmark_in_world_ + 4),
      Eigen::Vector3d(landmark_in_world_ + kPoseSize).array().exp(),
      shape_exponent_,
  };
  Sums sums;
  AddViews(views_, body, loss_, hessian, &sums);
  const double cost = Sum(sums.cost);
  if (!std::isfinite(cost)) return std::numeric_limits<double>::infinity();
  if (places.gradient[0] == nullptr) return cost;

  Eigen::Map<Eigen::Matrix<double, kLandmarkDof, 1>> gradient(places.gradient[0]);
  Eigen::Map<Eigen::Matrix<double, kLandmarkDof, kLandmarkDof>> square(places.hessian[0][0]);
  const Eigen::Matrix3d& to_world = body.world_from_object;
  const Eigen::Vector3d by_turn(Sum(sums.gradient[0]), Sum(sums.gradient[1]),
                                Sum(sums.gradient[2]));
  gradient.head<3>() += to_world * by_turn;
  Eigen::Matrix<double, kLandmarkDof, 3> turn_columns;
  for (int i = 0; i < kLandmarkDof; ++i) {
    for (int j = 0; j < 3; ++j) {
      turn_columns(i, j) = Sum(sums.hessian[std::max(i, j)][std::min(i, j)]);
    }
    if (i < 3) continue;
    gradient[i] += Sum(sums.gradient[i]);
    for (int j = 3; j <= i; ++j) square(i, j) += Sum(sums.hessian[i][j]);
  }
  turn_columns = turn_columns.lazyProduct(to_world.transpose()).eval();
  turn_columns.topRows<3>() = (to_world * turn_columns.topRows<3>()).eval();
  square.leftCols<3>() += turn_columns;
  return cost;
}

}  // namespace soslam
