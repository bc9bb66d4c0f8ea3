// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/fit_four_yaws.h"

#include <cmath>
#include <limits>

#include "base/exponential_of_four.h"
#include "base/wide_loops.h"
#include "geometry/support_function.h"
#include "geometry/support_of_four.h"
#include "initialisation/levenberg_marquardt.h"

namespace soslam {
namespace {

// Initial guesses of the four fits, one per SIMD lane.
struct alignas(kFourAlignment) FourStarts {
  FourHeadings headings;
  std::array<Four, 4> depths_m{};  // one entry per edge
  ThreeFours log_half_axes{};
};

// Tangency equations of the box edges for the four objects.
struct Tangencies {
  double shape_exponent;
  // Unweighted residuals with the foot at the ground's origin, one entry per edge: constant term,
  // and coefficient of the half height.
  Eigen::Array4d at_origin;
  Eigen::Array4d by_height;
  std::array<Four, 4> weight;         // 1 / (m px)
  std::array<ThreeFours, 4> rounded;  // |m_i| of normals m in the object frame, SquaredRounding
  // QR decomposition of the Jacobian by the foot: orthonormal columns Q, and R.
  std::array<std::array<Four, 2>, 4> foot_basis;
  Four r_xx, r_xy, r_yy;
};

// Second-order models of the four fits, as QuadraticModel; only the lower triangle of the
// information.
struct Model {
  ThreeFours half_axes{};
  Four cost{};
  std::array<Four, 2> foot{};  // Q^T r = -R (optimal foot)
  ThreeFours gradient{};
  std::array<ThreeFours, 3> information{};
};

// Residuals of the four box edges and their derivatives, one entry per edge.
struct Rows {
  std::array<Four, 4> residuals;
  std::array<ThreeFours, 4> by_log_half_axes;
};

// Residuals and derivatives with the foot at the ground's origin.
SOSLAM_FORCE_INLINE void RowsAtOrigin(const Tangencies& tangencies, const ThreeFours& half_axes,
                                      Rows* rows) {
  for (size_t edge = 0; edge < 4; ++edge) {
    const Four weight = tangencies.weight[edge];
    ThreeFours u;
    for (size_t i = 0; i < 3; ++i) u[i] = tangencies.rounded[edge][i] * half_axes[i];
    Four extent;
    ThreeFours& by_log_half_axes = rows->by_log_half_axes[edge];
    NormByLogarithms(tangencies.shape_exponent, u, &extent, &by_log_half_axes);
    const Four by_height = tangencies.by_height[edge] * half_axes[2];
    by_log_half_axes[2] += by_height;
    for (Four& derivative : by_log_half_axes) derivative *= weight;
    rows->residuals[edge] = weight * (tangencies.at_origin[edge] + by_height + extent);
  }
}

// Adds the costs at the optimal foot: projects the residuals and their Jacobian onto the complement
// of the Jacobian by the foot (variable projection).
SOSLAM_FORCE_INLINE void AddTangencies(const Tangencies& tangencies, const Rows& rows, Model* sum) {
  std::array<ThreeFours, 2> foot_by_log_half_axes{};
  for (size_t edge = 0; edge < 4; ++edge) {
    for (size_t k = 0; k < 2; ++k) {
      sum->foot[k] += tangencies.foot_basis[edge][k] * rows.residuals[edge];
      for (size_t i = 0; i < 3; ++i) {
        foot_by_log_half_axes[k][i] +=
            tangencies.foot_basis[edge][k] * rows.by_log_half_axes[edge][i];
      }
    }
  }
  for (size_t edge = 0; edge < 4; ++edge) {
    const auto& basis = tangencies.foot_basis[edge];
    const Four left = rows.residuals[edge] - (basis[0] * sum->foot[0] + basis[1] * sum->foot[1]);
    sum->cost += 0.5 * left * left;
    for (size_t i = 0; i < 3; ++i) {
      const ThreeFours& by_log_half_axes = rows.by_log_half_axes[edge];
      sum->gradient[i] += by_log_half_axes[i] * left;
      for (size_t j = 0; j <= i; ++j) {
        sum->information[i][j] += by_log_half_axes[i] * by_log_half_axes[j];
      }
    }
  }
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      for (const ThreeFours& by : foot_by_log_half_axes) sum->information[i][j] -= by[i] * by[j];
    }
  }
}

SOSLAM_FORCE_INLINE void AddRatio(const RatioRows& ratio, const ThreeFours& log_half_axes,
                                  Model* sum) {
  for (size_t row = 0; row < 2; ++row) {
    Four residual = Four{} - ratio.at_prior[row];
    for (size_t i = 0; i < 3; ++i) residual += ratio.by_log_half_axes(row, i) * log_half_axes[i];
    sum->cost += 0.5 * residual * residual;
    for (size_t i = 0; i < 3; ++i) sum->gradient[i] += ratio.by_log_half_axes(row, i) * residual;
  }
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j <= i; ++j) sum->information[i][j] += ratio.information(i, j);
  }
}

SOSLAM_FORCE_INLINE void Evaluate(const Tangencies& tangencies, const RatioRows& ratio,
                                  const ThreeFours& log_half_axes, Model* model) {
  *model = Model();
  Exponential(log_half_axes, &model->half_axes);
  Rows rows;
  RowsAtOrigin(tangencies, model->half_axes, &rows);
  AddTangencies(tangencies, rows, model);
  AddRatio(ratio, log_half_axes, model);
}

SOSLAM_FORCE_INLINE void ReplaceModel(const FourMask& where, const Model& from, Model* to) {
  Replace(where, from.half_axes, &to->half_axes);
  Replace(where, from.cost, &to->cost);
  Replace(where, from.foot, &to->foot);
  Replace(where, from.gradient, &to->gradient);
  for (size_t i = 0; i < 3; ++i) Replace(where, from.information[i], &to->information[i]);
}

// Solves A x = -b for symmetric A by cofactors; `is_definite` is set where A is positive definite.
SOSLAM_FORCE_INLINE void SolveForNegative(const std::array<ThreeFours, 3>& a, const ThreeFours& b,
                                          ThreeFours* x, FourMask* is_definite) {
  const Four c00 = a[1][1] * a[2][2] - a[2][1] * a[2][1];
  const Four c10 = a[2][1] * a[2][0] - a[1][0] * a[2][2];
  const Four c20 = a[1][0] * a[2][1] - a[1][1] * a[2][0];
  const Four c11 = a[0][0] * a[2][2] - a[2][0] * a[2][0];
  const Four c21 = a[1][0] * a[2][0] - a[0][0] * a[2][1];
  const Four c22 = a[0][0] * a[1][1] - a[1][0] * a[1][0];
  const Four determinant = a[0][0] * c00 + a[1][0] * c10 + a[2][0] * c20;
  *is_definite = (a[0][0] > 0.0) & (c22 > 0.0) & (determinant > 0.0);
  const Four scale = -1.0 / determinant;
  (*x)[0] = scale * (c00 * b[0] + c10 * b[1] + c20 * b[2]);
  (*x)[1] = scale * (c10 * b[0] + c11 * b[1] + c21 * b[2]);
  (*x)[2] = scale * (c20 * b[0] + c21 * b[1] + c22 * b[2]);
}

// MinimiseSquares, line by line, for four fits. `at` becomes the model at the minimum.
SOSLAM_FORCE_INLINE void Minimise(const Tangencies& tangencies, const RatioRows& ratio,
                                  int max_iterations, ThreeFours* log_half_axes, Model* at) {
  using namespace levenberg_marquardt;
  Evaluate(tangencies, ratio, *log_half_axes, at);
  Four damping = Four{} + kFirstDamping;
  Four growth = Four{} + kGrowth;
  FourMask is_under_way = at->cost < std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    std::array<ThreeFours, 3> damped = at->information;
    ThreeFours weights;
    for (size_t i = 0; i < 3; ++i) {
      const Four diagonal = at->information[i][i];
      weights[i] = damping * (diagonal > kMinDiagonal ? diagonal : Four{} + kMinDiagonal);
      damped[i][i] += weights[i];
    }
    ThreeFours step;
    FourMask is_definite;
    SolveForNegative(damped, at->gradient, &step, &is_definite);
    Four decrease{};
    ThreeFours moved;
    for (size_t i = 0; i < 3; ++i) {
      decrease += 0.5 * step[i] * (weights[i] * step[i] - at->gradient[i]);
      moved[i] = (*log_half_axes)[i] + step[i];
    }
    const FourMask is_worth_it = decrease > kNegligibleDecrease * (1.0 + at->cost);
    is_under_way &= (damping < kMaxDamping) & (~is_definite | is_worth_it);
    if (!Any(is_under_way)) break;

    Model there;
    Evaluate(tangencies, ratio, moved, &there);
    const Four gain = (at->cost - there.cost) / decrease;
    const FourMask is_better = is_under_way & is_definite & (gain > 0.0);
    Replace(is_better, moved, log_half_axes);
    ReplaceModel(is_better, there, at);
    const Four surprise = 2.0 * gain - 1.0;
    const Four fall = 1.0 - surprise * surprise * surprise;
    damping *= is_better ? (fall > kLeastFall ? fall : Four{} + kLeastFall) : growth;
    growth = is_better ? Four{} + kGrowth : 2.0 * growth;
  }
}

// Gram-Schmidt QR decomposition of the weighted Jacobian (4 x 2) by the foot.
SOSLAM_FORCE_INLINE void FindFootBasis(const BoxOnGround& box, Tangencies* tangencies) {
  Four squares{}, products{}, rest_squares{};
  for (int edge = 0; edge < 4; ++edge) {
    auto& [by_x, by_y] = tangencies->foot_basis[edge];
    by_x = tangencies->weight[edge] * box.normals(edge, 0);
    by_y = tangencies->weight[edge] * box.normals(edge, 1);
    squares += by_x * by_x;
  }
  SquareRoot(squares, &tangencies->r_xx);
  for (auto& [by_x, by_y] : tangencies->foot_basis) {
    by_x /= tangencies->r_xx;
    products += by_x * by_y;
  }
  tangencies->r_xy = products;
  for (auto& [by_x, by_y] : tangencies->foot_basis) {
    by_y -= products * by_x;
    rest_squares += by_y * by_y;
  }
  SquareRoot(rest_squares, &tangencies->r_yy);
  for (auto& [by_x, by_y] : tangencies->foot_basis) by_y /= tangencies->r_yy;
}

SOSLAM_FORCE_INLINE void Place(const BoxOnGround& box, double shape_exponent,
                               const FourStarts& starts, Tangencies* tangencies) {
  tangencies->shape_exponent = shape_exponent;
  tangencies->at_origin = box.at_origin;
  tangencies->by_height = box.normals.col(2);
  for (int edge = 0; edge < 4; ++edge) {
    tangencies->weight[edge] = 1.0 / (starts.depths_m[edge] * box.sigma_px[edge]);
    const ThreeFours normal = starts.headings.TurnedBack(box.normals.row(edge));
    FindRounded(shape_exponent, normal, &tangencies->rounded[edge]);
  }
  FindFootBasis(box, tangencies);
}

// Results of the four fits. The cost is NaN if the edges do not determine the foot, or not finite
// at the start.
struct alignas(kFourAlignment) FourFits {
  Four cost;
  std::array<Four, 2> foot;
  ThreeFours log_half_axes;
  Four nearest_depth_m;
};

SOSLAM_FORCE_INLINE void FindNearestDepth(const BoxOnGround& box, double shape_exponent,
                                          const FourHeadings& headings, const ThreeFours& half_axes,
                                          FourFits* fits) {
  ThreeFours reach, by_logarithms;
  FindRounded(shape_exponent, headings.TurnedBack(box.optical_axis), &reach);
  for (size_t i = 0; i < 3; ++i) reach[i] *= half_axes[i];
  Four extent;
  NormByLogarithms(shape_exponent, reach, &extent, &by_logarithms);
  const Eigen::Vector3d& axis = box.optical_axis;
  fits->nearest_depth_m = box.origin_depth + axis[0] * fits->foot[0] + axis[1] * fits->foot[1] +
                          axis[2] * half_axes[2] - extent;
}

SOSLAM_MULTIVERSION void Fit(const BoxOnGround& box, const RatioRows& ratio, double shape_exponent,
                             int max_iterations, const FourStarts& starts, FourFits* fits) {
  Tangencies tangencies;
  Place(box, shape_exponent, starts, &tangencies);
  fits->log_half_axes = starts.log_half_axes;
  Model at;
  Minimise(tangencies, ratio, max_iterations, &fits->log_half_axes, &at);

  constexpr double kLeastShare = 1e-6;
  const Four& xx = tangencies.r_xx;
  const Four& yy = tangencies.r_yy;
  const FourMask is_told = (xx > kLeastShare * yy) & (yy > kLeastShare * xx);
  const FourMask has_cost = at.cost < std::numeric_limits<double>::infinity();
  fits->cost = is_told & has_cost ? at.cost : Four{} + std::numeric_limits<double>::quiet_NaN();
  fits->foot[1] = -at.foot[1] / yy;
  fits->foot[0] = -(at.foot[0] + tangencies.r_xy * fits->foot[1]) / xx;
  FindNearestDepth(box, shape_exponent, starts.headings, at.half_axes, fits);
}

}  // namespace

std::array<FitAtYaw, 4> FitFourYaws(const BoxOnGround& box, const RatioRows& ratio,
                                    double shape_exponent, int max_iterations,
                                    const std::array<StartAtYaw, 4>& starts) {
  FourStarts four;
  for (size_t k = 0; k < starts.size(); ++k) {
    four.headings.Set(k, starts[k].heading);
    for (int edge = 0; edge < 4; ++edge) four.depths_m[edge][k] = starts[k].depths_m[edge];
    for (int i = 0; i < 3; ++i) four.log_half_axes[i][k] = starts[k].parameters[3 + i];
  }
  FourFits found;
  Fit(box, ratio, shape_exponent, max_iterations, four, &found);

  std::array<FitAtYaw, 4> fits;
  for (size_t k = 0; k < fits.size(); ++k) {
    fits[k] = {found.cost[k], starts[k].parameters, found.nearest_depth_m[k]};
    if (std::isnan(found.cost[k])) continue;
    fits[k].parameters.tail<5>() << found.foot[0][k], found.foot[1][k], found.log_half_axes[0][k],
        found.log_half_axes[1][k], found.log_half_axes[2][k];
  }
  return fits;
}

}  // namespace soslam
