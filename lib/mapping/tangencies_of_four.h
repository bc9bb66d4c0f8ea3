// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "base/wide_loops.h"
#include "constraints/huber.h"
#include "geometry/mirror_mapping.h"
#include "geometry/support_of_four.h"
#include "mapping/tangent_box.h"
#include "mapping/term.h"

namespace soslam {

// The tangencies of edges to one body, four side by side in wide registers, and the sum of their
// losses to second order. Which four, those of a box or those of one side in four views, is up to
// who asks.

struct BodyInWorld {
  // `landmark_in_world` is a block (parameters.h).
  BodyInWorld(const double* landmark_in_world, double shape_exponent);

  Eigen::Matrix3d world_from_object;
  Eigen::Vector3d centre;     // m
  Eigen::Vector3d half_axes;  // m
  double shape_exponent;
};

// Derivatives by the turn of the body in its own frame, its centre in the world and the logarithms
// of its half axes begin there.
enum { kByTurn = 0, kByCentre = 3, kByAxes = 6 };

// A cost, its gradient and, column by column, the Hessian's three block columns from the diagonal
// on. Of blocks on the diagonal, the lower triangle counts.
template <typename Number>
struct LandmarkSums {
  static constexpr size_t kCost = 0;
  static constexpr size_t kGradient = 1;
  static constexpr size_t kHessianByTurn = kGradient + kLandmarkDof;
  static constexpr size_t kHessianByCentre = kHessianByTurn + 9 * 3;
  static constexpr size_t kHessianByAxes = kHessianByCentre + 6 * 3;
  static constexpr size_t kCount = kHessianByAxes + 3 * 3;

  SOSLAM_FORCE_INLINE Number* Gradient() { return &numbers[kGradient]; }
  // i >= j.
  SOSLAM_FORCE_INLINE Number& Hessian(size_t i, size_t j) {
    if (j < kByCentre) return numbers[kHessianByTurn + 9 * j + i];
    if (j < kByAxes) return numbers[kHessianByCentre + 6 * (j - kByCentre) + i - kByCentre];
    return numbers[kHessianByAxes + 3 * (j - kByAxes) + i - kByAxes];
  }

  alignas(kFourAlignment) std::array<Number, kCount> numbers;
};
using SumsOfFour = LandmarkSums<Four>;

SOSLAM_FORCE_INLINE void AddUp(const SumsOfFour& sums, LandmarkSums<double>* totals) {
  static_assert(SumsOfFour::kCount % 4 == 0);
  for (size_t i = 0; i < sums.numbers.size(); i += 4) {
    Four total;
    SumEach(&sums.numbers[i], &total);
    Store(total, &totals->numbers[i]);
  }
}

// The same by the landmark's steps (tangent_space.h), all in the world.
struct LandmarkDerivatives {
  LandmarkDerivatives(const LandmarkSums<double>& sums, const Eigen::Matrix3d& world_from_object);

  using Gradient = Eigen::Matrix<double, kLandmarkDof, 1>;
  using Square = Eigen::Matrix<double, kLandmarkDof, kLandmarkDof>;

  // To where a term's go; the cost has to be finite.
  void AddTo(double* to_gradient, double* to_hessian) const;

  double cost;  // infinite where it is not finite
  Gradient gradient;
  Square hessian;  // whole by turn and centre, of the rest the lower triangle
};

// The body's centre as cameras see it.
struct DepthsOfFour {
  ThreeFours offset;  // m in the world, from the camera
  Four depth_m;
  Four inverse;          // 1 / depth
  ThreeFours by_centre;  // relative change; 0 where the depth is held
};

SOSLAM_FORCE_INLINE void FindDepths(const ThreeFours& camera, const ThreeFours& optical_axis,
                                    const Four& least_depth_m, const BodyInWorld& body,
                                    DepthsOfFour* depths) {
  Four depth{};
  for (size_t i = 0; i < 3; ++i) {
    depths->offset[i] = body.centre[static_cast<int>(i)] - camera[i];
    depth += optical_axis[i] * depths->offset[i];
  }
  const FourMask is_free = depth > least_depth_m;
  depths->depth_m = is_free ? depth : least_depth_m;
  depths->inverse = 1.0 / depths->depth_m;
  for (size_t i = 0; i < 3; ++i) {
    depths->by_centre[i] = is_free ? depths->inverse * optical_axis[i] : Four{};
  }
}

// What lies outside the planes behind edges, over the centre's depth.
struct ExcessOfFour {
  // Products of components of the plane's normal m in the object frame: m_i^2, and m_j m_k of the
  // two others.
  ThreeFours squares, products;
  SupportOfFour support;
  Four value;  // in standard deviations of the edge, before a bias of the detector
};
// Gradient of an excess, in the order of kByTurn, kByCentre and kByAxes.
using GradientOfFour = std::array<Four, kLandmarkDof>;

// `plane` is in the world (TangentBox::Edge).
SOSLAM_FORCE_INLINE void FindExcess(const ThreeFours& plane, const BodyInWorld& body,
                                    const DepthsOfFour& depths, ExcessOfFour* excess,
                                    GradientOfFour* gradient) {
  Four outside{};
  ThreeFours m;
  for (int i = 0; i < 3; ++i) {
    outside += plane[i] * depths.offset[i];
    m[i] = body.world_from_object(0, i) * plane[0] + body.world_from_object(1, i) * plane[1] +
           body.world_from_object(2, i) * plane[2];
  }
  SupportOfFour& support = excess->support;
  FindSupport(body.half_axes, body.shape_exponent, m, &support);
  excess->value = (outside + support.extent) * depths.inverse;
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    excess->squares[i] = m[i] * m[i];
    excess->products[i] = m[j] * m[k];
    const Four by_turn =  // dh / dm x m
        excess->products[i] * (support.shares[j] - support.shares[k]);
    (*gradient)[kByTurn + i] = depths.inverse * by_turn;
    (*gradient)[kByCentre + i] = depths.inverse * plane[i] - excess->value * depths.by_centre[i];
    (*gradient)[kByAxes + i] = depths.inverse * support.by_log_half_axes[i];
  }
}

// What the losses make of four excesses.
struct LossesOfFour {
  Four cost;
  Four slope;
  Four curvature;
};

// Losses of four excesses; zero for a bound edge with a positive excess. An excess that is not
// finite makes the cost not finite, even if its weight is zero: no other result computed from it
// may be added.
SOSLAM_FORCE_INLINE void FindLosses(const FourEdges& edges, const Four& excess,
                                    const HuberLoss& loss, Hessian hessian, LossesOfFour* losses) {
  const FourMask is_idle = (edges.is_bound > 0.0) & (excess > 0.0);
  const Four weight = is_idle ? Four{} : edges.weights;
  const HuberLoss::FourValues values = loss(excess < 0.0 ? -excess : excess);
  losses->cost = weight * values.cost;
  losses->slope = weight * values.weight * excess;
  losses->curvature = weight * (hessian == Hessian::kNear ? values.curvature : values.weight);
}

// Where the body turns past an edge or a face that should come nearer, it is held there. Not so
// where it should go away from it.
SOSLAM_FORCE_INLINE bool HasKinks(const BodyInWorld& body, Hessian hessian) {
  return hessian == Hessian::kFar && body.shape_exponent < kEllipsoidExponent;
}

// What multiplies the gradient of an excess, and products of it in the Hessian: d^2 cost / d
// excess^2, and where h bends, less what it bends by along its own gradient, by turns and half
// axes.
struct WeightsOfFour {
  Four slope;
  Four turn_turn;
  Four centre;  // by all
  Four axes;    // by turns and axes
  // Weight of the products, by the centre and all, of the gradient with the relative change of the
  // depth, which divides all excesses.
  Four depth;
};

SOSLAM_FORCE_INLINE void FindWeights(const BodyInWorld& body, const DepthsOfFour& depths,
                                     const ExcessOfFour& excess, const LossesOfFour& losses,
                                     Hessian hessian, WeightsOfFour* weights) {
  const Four less =
      losses.slope * depths.depth_m * (body.shape_exponent - 1.0) * excess.support.inverse;
  *weights = {losses.slope, losses.curvature, losses.curvature, losses.curvature, Four{}};
  if (hessian == Hessian::kNear) {
    weights->turn_turn -= less;
    weights->axes -= less;
    weights->depth = losses.slope;
  } else if (HasKinks(body, hessian)) {
    weights->turn_turn -= less > 0.0 ? less : Four{};
  }
}

// Adds the products of the i-th component of a weighted gradient with the components from begin to
// end to the Hessian.
template <size_t kSets>
SOSLAM_FORCE_INLINE void AddProducts(size_t i, size_t begin, size_t end,
                                     const std::array<Four, kSets>& weighted,
                                     const std::array<GradientOfFour, kSets>& gradients,
                                     SumsOfFour* sums) {
  for (size_t j = begin; j < end; ++j) {
    Four& sum = sums->Hessian(i, j);
    for (size_t set = 0; set < kSets; ++set) sum += weighted[set] * gradients[set][j];
  }
}

// The products of which one is by the i-th component of the centre, which the depth depends on.
template <size_t kSets>
SOSLAM_FORCE_INLINE void AddProductsByCentre(size_t i,
                                             const std::array<GradientOfFour, kSets>& gradients,
                                             const std::array<WeightsOfFour, kSets>& weights,
                                             const ThreeFours& depth_by_centre, SumsOfFour* sums) {
  std::array<Four, kSets> weighted;
  Four slope{};
  for (size_t set = 0; set < kSets; ++set) {
    const Four& by_centre = gradients[set][kByCentre + i];
    slope += weights[set].depth * by_centre;
    weighted[set] = weights[set].centre * by_centre - weights[set].depth * depth_by_centre[i];
  }
  AddProducts(kByCentre + i, kByTurn, kByTurn + 3, weighted, gradients, sums);
  AddProducts(kByCentre + i, kByCentre, kByCentre + i + 1, weighted, gradients, sums);
  for (size_t j = 0; j <= i; ++j) {
    sums->Hessian(kByCentre + i, kByCentre + j) -= slope * depth_by_centre[j];
  }
  for (size_t j = 0; j < 3; ++j) {
    Four& sum = sums->Hessian(kByAxes + j, kByCentre + i);
    for (size_t set = 0; set < kSets; ++set) sum += weighted[set] * gradients[set][kByAxes + j];
  }
}

// The sum of the gradients of `kSets` times four edges at the same depths, and their products.
template <size_t kSets>
SOSLAM_FORCE_INLINE void AddGradients(const std::array<GradientOfFour, kSets>& gradients,
                                      const std::array<WeightsOfFour, kSets>& weights,
                                      const ThreeFours& depth_by_centre, SumsOfFour* sums) {
  for (size_t i = 0; i < kLandmarkDof; ++i) {
    Four& sum = sums->Gradient()[i];
    for (size_t set = 0; set < kSets; ++set) sum += weights[set].slope * gradients[set][i];
  }
  std::array<Four, kSets> weighted;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t set = 0; set < kSets; ++set) {
      weighted[set] = weights[set].turn_turn * gradients[set][kByTurn + i];
    }
    AddProducts(kByTurn + i, kByTurn, kByTurn + i + 1, weighted, gradients, sums);
    for (size_t set = 0; set < kSets; ++set) {
      weighted[set] = weights[set].axes * gradients[set][kByAxes + i];
    }
    AddProducts(kByAxes + i, kByTurn, kByTurn + 3, weighted, gradients, sums);
    AddProducts(kByAxes + i, kByAxes, kByAxes + i + 1, weighted, gradients, sums);
    AddProductsByCentre(i, gradients, weights, depth_by_centre, sums);
  }
}

// Adds second derivatives of h by rotations of the object, as the contact moves along it. With
// r_i^2 = m_i^2 + e^2 |m|^2, shares l_i / r_i^2 of l_i = dh / ds_i, g_i = (m_i e_i + e^2 m) / r_i
// and the contact c = dh / dm, the second derivatives of h by m are
//   sum_i l_i / r_i^2 (e_i e_i^T + e^2 I - (2 - p) g_i g_i^T) - (p - 1) / h c c^T,
// the last term of which is in FindWeights; their part along m itself has no effect on rotations.
// With `contact_turns`, also adds those of a contact q that is fixed to the object.
SOSLAM_FORCE_INLINE void AddCurvatureByTurns(const BodyInWorld& body, const ExcessOfFour& excess,
                                             const Four& factor, bool contact_turns,
                                             SumsOfFour* sums) {
  const SupportOfFour& support = excess.support;
  const ThreeFours& shares = support.shares;
  const double p = body.shape_exponent;
  const Four rounding = SquaredRounding(p) * (shares[0] + shares[1] + shares[2]);
  ThreeFours moving, staying{};  // q_i = staying_i m_i
  for (size_t i = 0; i < 3; ++i) {
    moving[i] = factor * (shares[i] + rounding);
    if (contact_turns) staying[i] = moving[i];
    if (p == kEllipsoidExponent) continue;
    moving[i] -= (2.0 - p) * factor * shares[i] * excess.squares[i] * support.inverse_squares[i];
  }
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    sums->Hessian(kByTurn + i, kByTurn + i) +=
        (moving[j] - staying[k]) * excess.squares[k] + (moving[k] - staying[j]) * excess.squares[j];
    sums->Hessian(kByTurn + std::max(j, k), kByTurn + std::min(j, k)) +=
        (0.5 * (staying[j] + staying[k]) - moving[i]) * excess.products[i];
  }
}

// Adds the mixed second derivatives of h by rotations and half axes.
SOSLAM_FORCE_INLINE void AddMixedCurvature(const BodyInWorld& body, const ExcessOfFour& excess,
                                           const Four& factor, SumsOfFour* sums) {
  const SupportOfFour& support = excess.support;
  const Four factor_of_axes = factor * body.shape_exponent;
  for (size_t i = 0; i < 3; ++i) {
    const size_t j = (i + 1) % 3, k = (i + 2) % 3;
    const Four edge = factor_of_axes * support.shares[i];
    sums->Hessian(kByAxes + i, kByTurn + j) -= edge * excess.products[j];
    sums->Hessian(kByAxes + i, kByTurn + k) += edge * excess.products[k];
  }
}

// Adds the part of the Hessian that is not a product of gradients, except that by the half axes
// alone.
SOSLAM_FORCE_INLINE void AddCurvature(const BodyInWorld& body, const DepthsOfFour& depths,
                                      const ExcessOfFour& excess, const LossesOfFour& losses,
                                      Hessian hessian, SumsOfFour* sums) {
  const Four factor = losses.slope * depths.inverse;
  if (hessian == Hessian::kNear) {
    AddCurvatureByTurns(body, excess, factor, /*contact_turns=*/true, sums);
    AddMixedCurvature(body, excess, factor, sums);
  } else if (HasKinks(body, hessian)) {
    const Four held = factor > 0.0 ? factor : Four{};
    AddCurvatureByTurns(body, excess, held, /*contact_turns=*/false, sums);
  }
}

// Adds the part of the Hessian by the half axes alone that is not a product of gradients: h has p
// times its gradient on the diagonal. Called once at the end, for the sums of all edges.
SOSLAM_FORCE_INLINE void AddCurvatureByAxes(const BodyInWorld& body, Hessian hessian,
                                            SumsOfFour* sums) {
  if (hessian != Hessian::kNear) return;
  for (size_t i = kByAxes; i < kLandmarkDof; ++i) {
    sums->Hessian(i, i) += body.shape_exponent * sums->Gradient()[i];
  }
}

}  // namespace soslam
