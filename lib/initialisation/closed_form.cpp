// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/closed_form.h"

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/wide_loops.h"
#include "geometry/support_of_four.h"

namespace soslam {
namespace {

// Each round reduces the error of the tangent depths by a factor of 100 or more.
constexpr int kMaxDepthRounds = 20;
constexpr double kDepthTolerance = 1e-10;

using FourEdges = std::array<Four, 4>;

// Coefficients of the equations at four yaws, one per SIMD lane.
struct FourBodies {
  FourEdges by_half_height{};        // a
  FourEdges depth_by_half_height{};  // tangent points, relative to the foot
  Four nearest_by_half_height{};     // the object's nearest point, likewise
};

// The equations after elimination of the foot.
struct FourSystems {
  FourEdges half_height_by_b;
  FourEdges null;  // n
  Four missing;    // n^T r, the same for the residuals r of all objects
};

struct alignas(kFourAlignment) FourSolutions {
  std::array<Four, 2> foot{};
  Four half_height{};
  FourEdges depths_m{};  // of the tangent points
};

SOSLAM_FORCE_INLINE void Place(const BoxEquations& equations, const FourHeadings& headings,
                               FourBodies* bodies) {
  const BoxOnGround& box = equations.box;
  const double p = equations.shape_exponent;
  const double height_of_axis = box.optical_axis.z();
  const ThreeFours axis = headings.TurnedBack(box.optical_axis);
  SupportOfFour support;
  for (size_t edge = 0; edge < 4; ++edge) {
    const Eigen::Vector3d normal = box.normals.row(static_cast<int>(edge));
    const ThreeFours in_object = headings.TurnedBack(normal);
    FindSupport(equations.proportions, p, in_object, &support);
    const ThreeFours contact = support.Contact(p, in_object);
    bodies->by_half_height[edge] = normal.z() + support.extent;
    bodies->depth_by_half_height[edge] =
        height_of_axis + axis[0] * contact[0] + axis[1] * contact[1] + axis[2] * contact[2];
  }
  FindSupport(equations.proportions, p, axis, &support);
  bodies->nearest_by_half_height = height_of_axis - support.extent;
}

SOSLAM_FORCE_INLINE void EliminateFoot(const BoxEquations& equations, const FourBodies& bodies,
                                       FourSystems* systems) {
  Four first{}, second{};  // N^T a
  for (size_t edge = 0; edge < 4; ++edge) {
    first += equations.without_foot(edge, 0) * bodies.by_half_height[edge];
    second += equations.without_foot(edge, 1) * bodies.by_half_height[edge];
  }
  const Four scale = 1.0 / (first * first + second * second);
  systems->missing = Four{};
  for (size_t edge = 0; edge < 4; ++edge) {
    const double one = equations.without_foot(edge, 0), other = equations.without_foot(edge, 1);
    systems->half_height_by_b[edge] = scale * (one * first + other * second);
    systems->null[edge] = other * first - one * second;
    systems->missing += systems->null[edge] * equations.box.at_origin[edge];
  }
}

// F foot + a c - b of the least squares solutions, tangent points at these depths.
SOSLAM_FORCE_INLINE void FindResiduals(const BoxOnGround& box, const FourSystems& systems,
                                       const FourEdges& depths_m, FourEdges* residuals) {
  Four along_null{};
  for (size_t edge = 0; edge < 4; ++edge) {
    const Four sigma = depths_m[edge] * box.sigma_px[edge];
    (*residuals)[edge] = sigma * sigma * systems.null[edge];
    along_null += (*residuals)[edge] * systems.null[edge];
  }
  const Four scale = systems.missing / along_null;
  for (Four& residual : *residuals) residual *= scale;
}

// Three equations have a solution, and the bound is met as it happens: where it is reached.
SOSLAM_FORCE_INLINE void ReplaceWhereBoundIsReached(const Eigen::Array4d& is_bound,
                                                    const FourSystems& systems,
                                                    FourEdges* residuals) {
  Four null{};
  for (size_t edge = 0; edge < 4; ++edge) {
    null += is_bound[edge] * systems.null[edge];
  }
  const Four at_bound = systems.missing / null;
  const FourMask is_reached = ~(at_bound < 0.0);
  for (size_t edge = 0; edge < 4; ++edge) {
    Replace(is_reached, is_bound[edge] * at_bound, &(*residuals)[edge]);
  }
}

SOSLAM_FORCE_INLINE FourSolutions SolveFor(const BoxEquations& equations, const FourBodies& bodies,
                                           const FourSystems& systems, const FourEdges& residuals) {
  const BoxOnGround& box = equations.box;
  FourSolutions solutions;
  FourEdges b;
  for (size_t edge = 0; edge < 4; ++edge) {
    b[edge] = residuals[edge] - box.at_origin[edge];
    solutions.half_height += systems.half_height_by_b[edge] * b[edge];
  }
  for (size_t edge = 0; edge < 4; ++edge) {
    const Four left = b[edge] - solutions.half_height * bodies.by_half_height[edge];
    for (size_t k = 0; k < 2; ++k) {
      solutions.foot[k] += equations.foot_by_b(k, edge) * left;
    }
  }
  return solutions;
}

// Leaves half heights at 0 where there is no body in front of the camera.
SOSLAM_MULTIVERSION void Solve(const BoxEquations& equations, const FourHeadings& headings,
                               FourSolutions* solutions) {
  const BoxOnGround& box = equations.box;
  FourBodies bodies;
  Place(equations, headings, &bodies);
  FourSystems systems;
  EliminateFoot(equations, bodies, &systems);
  const bool has_bound = (box.is_bound != 0.0).any();
  solutions->depths_m.fill(Four{} + 1.0);  // any value, as long as they are equal
  FourMask is_under_way = ~FourMask{};
  for (int round = 0; round < kMaxDepthRounds; ++round) {
    FourEdges residuals;
    FindResiduals(box, systems, solutions->depths_m, &residuals);
    if (has_bound) ReplaceWhereBoundIsReached(box.is_bound, systems, &residuals);
    FourSolutions next = SolveFor(equations, bodies, systems, residuals);
    const Four foot_depth_m =
        box.origin_depth + box.optical_axis[0] * next.foot[0] + box.optical_axis[1] * next.foot[1];
    const Four nearest_m = foot_depth_m + next.half_height * bodies.nearest_by_half_height;
    const FourMask is_possible = (next.half_height > 0.0) & (nearest_m > 0.0) &
                                 (nearest_m < std::numeric_limits<double>::infinity());
    Replace(~is_possible, Four{}, &next.half_height);
    FourMask is_settled = is_possible;
    for (size_t edge = 0; edge < 4; ++edge) {
      Four& depth_m = next.depths_m[edge];
      depth_m = foot_depth_m + next.half_height * bodies.depth_by_half_height[edge];
      const Four change = depth_m - solutions->depths_m[edge];
      is_settled &= ((change > 0.0 ? change : -change) < kDepthTolerance * depth_m);
    }
    Replace(is_under_way, next.foot, &solutions->foot);
    Replace(is_under_way, next.half_height, &solutions->half_height);
    Replace(is_under_way, next.depths_m, &solutions->depths_m);
    is_under_way &= is_possible & ~is_settled;
    if (!Any(is_under_way)) break;
  }
}

}  // namespace

BoxEquations::BoxEquations(const UprightObservation& observation)
    : box(observation.edges, Rigid3d(), UprightGround(observation.plane_in_camera)),
      proportions(observation.prior.ratio.x(), observation.prior.ratio.y(), 1.0),
      log_proportions(proportions.array().log()),
      shape_exponent(observation.prior.shape_exponent) {
  const Eigen::HouseholderQR<Eigen::Matrix<double, 4, 2>> of_foot(box.normals.leftCols<2>());
  const Eigen::Matrix4d orthonormal = of_foot.householderQ();
  without_foot = orthonormal.rightCols<2>();
  foot_by_b = of_foot.matrixQR().topRows<2>().triangularView<Eigen::Upper>().solve(
      orthonormal.leftCols<2>().transpose());
}

std::vector<std::optional<StartAtYaw>> ClosedForm::At(const std::vector<double>& yaws) const {
  std::vector<std::optional<StartAtYaw>> starts(yaws.size());
  if (!HasEnoughEdges()) return starts;
  for (size_t first = 0; first < yaws.size(); first += 4) {
    const size_t count = std::min<size_t>(4, yaws.size() - first);
    FourHeadings headings;
    std::array<Heading, 4> of_yaws;
    for (size_t k = 0; k < 4; ++k) {
      of_yaws[k] = Heading(yaws[std::min(first + k, yaws.size() - 1)]);
      headings.Set(k, of_yaws[k]);
    }
    FourSolutions solutions;
    Solve(equations_, headings, &solutions);
    for (size_t k = 0; k < count; ++k) {
      const double half_height = solutions.half_height[k];
      if (!(half_height > 0.0)) continue;
      StartAtYaw& start = starts[first + k].emplace();
      start.parameters << yaws[first + k], solutions.foot[0][k], solutions.foot[1][k],
          equations_.log_proportions + Eigen::Vector3d::Constant(std::log(half_height));
      start.heading = of_yaws[k];
      for (size_t edge = 0; edge < 4; ++edge) {
        start.depths_m[edge] = solutions.depths_m[edge][k];
      }
    }
  }
  return starts;
}

std::optional<Landmark> SolveAtYaw(const UprightObservation& observation, double yaw) {
  const auto solution = ClosedForm(observation).At(yaw);
  if (!solution) return std::nullopt;
  return UprightGround(observation.plane_in_camera)
      .LandmarkAt(solution->parameters, observation.prior.shape_exponent);
}

}  // namespace soslam
