// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/fit_four_yaws.h"

#include <cmath>
#include <limits>
#include <optional>

#include "base/wide_loops.h"
#include "geometry/norm_of_four.h"
#include "geometry/support_function.h"
#include "initialisation/levenberg_marquardt.h"

namespace soslam {
namespace {

// The edges of the box as the four bodies see them.
struct alignas(kFourAlignment) Tangencies {
  double shape_exponent;
  // By edge. Of a residual at the ground's origin, over the weight: its value and its derivative by
  // the body's height.
  std::array<double, 4> at_origin;
  std::array<double, 4> by_height;
  std::array<Four, 4> weight;         // 1 / (m px)
  std::array<ThreeFours, 4> rounded;  // the normal in the object frame, RoundedDirection
  std::array<std::array<Four, 2>, 4> foot_basis;  // derivatives by the foot: orthonormal columns
};

// The fits to second order, as QuadraticModel has it; of the information, the lower triangle.
struct alignas(kFourAlignment) Model {
  Four cost{};
  std::array<Four, 2> foot{};  // the best one's negative, in its basis
  ThreeFours gradient{};
  std::array<ThreeFours, 3> information{};
};

// By edge.
struct Rows {
  std::array<Four, 4> residuals;
  std::array<ThreeFours, 4> by_log_half_axes;
};

// Of bodies whose foot is the ground's origin.
SOSLAM_IN_WIDE_LOOPS void RowsAtOrigin(const Tangencies& tangencies,
                                       const ThreeFours& log_half_axes, Rows* rows) {
  ThreeFours half_axes;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 4; ++k) half_axes[i][k] = std::exp(log_half_axes[i][k]);
  }
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

// Of bodies on their best foot: less what a foot explains of the rows.
SOSLAM_IN_WIDE_LOOPS void AddTangencies(const Tangencies& tangencies, const Rows& rows,
                                        Model* sum) {
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

SOSLAM_IN_WIDE_LOOPS void AddRatio(const RatioRows& ratio, const ThreeFours& log_half_axes,
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

SOSLAM_IN_WIDE_LOOPS void Evaluate(const Tangencies& tangencies, const RatioRows& ratio,
                                   const ThreeFours& log_half_axes, Model* model) {
  *model = Model();
  Rows rows;
  RowsAtOrigin(tangencies, log_half_axes, &rows);
  AddTangencies(tangencies, rows, model);
  AddRatio(ratio, log_half_axes, model);
}

SOSLAM_IN_WIDE_LOOPS void ReplaceModel(const FourMask& where, const Model& from, Model* to) {
  Replace(where, from.cost, &to->cost);
  Replace(where, from.foot, &to->foot);
  Replace(where, from.gradient, &to->gradient);
  for (size_t i = 0; i < 3; ++i) Replace(where, from.information[i], &to->information[i]);
}

// The x of A x = -b, by cofactors, and where A, which is symmetric, is positive definite.
SOSLAM_IN_WIDE_LOOPS void SolveForNegative(const std::array<ThreeFours, 3>& a, const ThreeFours& b,
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

// MinimiseSquares, line by line. Leaves the model at the minimum.
SOSLAM_WIDE_LOOPS void Minimise(const Tangencies& tangencies, const RatioRows& ratio,
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

// Of one body, at a place among the four. Returns what leads from its foot in the basis, which is
// the best one's negative, to that on the ground; none where the edges do not tell the foot.
std::optional<Eigen::Matrix2d> Place(const BoxOnGround& box, const StartAtYaw& start, size_t place,
                                     Tangencies* tangencies) {
  const Eigen::Array4d weights = (start.depths_m * box.sigma_px).inverse();
  // Gram and Schmidt's orthonormal basis of two columns.
  const Eigen::Vector4d by_x = weights * box.normals.col(0).array();
  const Eigen::Vector4d by_y = weights * box.normals.col(1).array();
  const double xx = by_x.norm();
  const Eigen::Vector4d first = by_x / xx;
  const double xy = first.dot(by_y);
  const Eigen::Vector4d rest = by_y - xy * first;
  const double yy = rest.norm();
  constexpr double kLeastShare = 1e-6;
  if (!(xx > kLeastShare * yy && yy > kLeastShare * xx)) return std::nullopt;

  const double cosine = std::cos(start.parameters[0]);
  const double sine = std::sin(start.parameters[0]);
  for (size_t edge = 0; edge < 4; ++edge) {
    const Eigen::Array3d rounded = RoundedDirection(TurnedBack(box.normals.row(edge), cosine, sine),
                                                    tangencies->shape_exponent);
    for (size_t i = 0; i < 3; ++i) tangencies->rounded[edge][i][place] = rounded[i];
    tangencies->weight[edge][place] = weights[edge];
    tangencies->foot_basis[edge][0][place] = first[edge];
    tangencies->foot_basis[edge][1][place] = rest[edge] / yy;
  }
  Eigen::Matrix2d foot_from_basis;
  foot_from_basis << -1.0 / xx, xy / (xx * yy), 0.0, -1.0 / yy;
  return foot_from_basis;
}

}  // namespace

std::array<FitAtYaw, 4> FitFourYaws(const BoxOnGround& box, const RatioRows& ratio,
                                    double shape_exponent, int max_iterations,
                                    const std::array<StartAtYaw, 4>& starts) {
  Tangencies tangencies{};
  tangencies.shape_exponent = shape_exponent;
  for (size_t edge = 0; edge < 4; ++edge) {
    tangencies.at_origin[edge] = box.at_origin[edge];
    tangencies.by_height[edge] = box.normals(edge, 2);
  }
  std::array<std::optional<Eigen::Matrix2d>, 4> foot_from_basis;
  alignas(kFourAlignment) ThreeFours log_half_axes;
  for (size_t k = 0; k < 4; ++k) {
    foot_from_basis[k] = Place(box, starts[k], k, &tangencies);
    for (size_t i = 0; i < 3; ++i) log_half_axes[i][k] = starts[k].parameters[3 + i];
  }
  Model at;
  Minimise(tangencies, ratio, max_iterations, &log_half_axes, &at);

  std::array<FitAtYaw, 4> fits;
  for (size_t k = 0; k < 4; ++k) {
    fits[k] = {std::numeric_limits<double>::quiet_NaN(), starts[k].parameters};
    if (!foot_from_basis[k] || !std::isfinite(at.cost[k])) continue;
    fits[k].cost = at.cost[k];
    fits[k].parameters << starts[k].parameters[0],
        *foot_from_basis[k] * Eigen::Vector2d(at.foot[0][k], at.foot[1][k]), log_half_axes[0][k],
        log_half_axes[1][k], log_half_axes[2][k];
  }
  return fits;
}

}  // namespace soslam
