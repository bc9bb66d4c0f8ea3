// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/fits_at_yaws.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "geometry/support_function.h"
#include "initialisation/levenberg_marquardt.h"

// In a function that is compiled for wide registers, so that it is too.
#define SOSLAM_INLINE [[gnu::always_inline]] inline

namespace soslam {
namespace {

using Lanes = FitsAtYaws::Lanes;
using Mask = decltype(Four{} < Four{});
using ThreeFours = std::array<Four, 3>;

// The fits to second order, as QuadraticModel has it; of the information, the lower triangle.
struct Model {
  Four cost{};
  std::array<Four, 2> foot{};  // the best one's negative, in its basis
  ThreeFours gradient{};
  std::array<ThreeFours, 3> information{};
};

// h = || u ||_p and dh / d log (a, b, c), u proportional to the half axes.
SOSLAM_INLINE void Support(double p, const ThreeFours& u, Four* h, ThreeFours* by_log_half_axes) {
  if (p == kCuboidExponent) {
    *h = u[0] + u[1] + u[2];
    *by_log_half_axes = u;
    return;
  }
  if (p == kEllipsoidExponent) {
    const Four squares = u[0] * u[0] + u[1] * u[1] + u[2] * u[2];
    for (size_t k = 0; k < FitsAtYaws::kYaws; ++k) (*h)[k] = std::sqrt(squares[k]);
    for (size_t i = 0; i < 3; ++i) (*by_log_half_axes)[i] = u[i] * u[i] / *h;
    return;
  }
  for (size_t k = 0; k < FitsAtYaws::kYaws; ++k) {
    const Eigen::Array3d u_of_one(u[0][k], u[1][k], u[2][k]);
    double norm = 0.0;
    const Eigen::Array3d by_u = NormByComponents(u_of_one, p, &norm);
    (*h)[k] = norm;
    for (size_t i = 0; i < 3; ++i) (*by_log_half_axes)[i][k] = by_u[i] * u_of_one[i];
  }
}

SOSLAM_INLINE void AddTangencies(const Lanes& lanes, const ThreeFours& log_half_axes, Model* sum) {
  ThreeFours half_axes;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < FitsAtYaws::kYaws; ++k) half_axes[i][k] = std::exp(log_half_axes[i][k]);
  }
  // Of a body whose foot is the ground's origin.
  std::array<Four, 4> residuals;
  std::array<ThreeFours, 4> by_log_half_axes;
  for (size_t edge = 0; edge < 4; ++edge) {
    const Four weight = lanes.weight[edge];
    ThreeFours u;
    for (size_t i = 0; i < 3; ++i) u[i] = lanes.rounded[edge][i] * half_axes[i];
    Four extent;
    Support(lanes.shape_exponent, u, &extent, &by_log_half_axes[edge]);
    const Four by_height = lanes.by_height[edge] * half_axes[2];
    by_log_half_axes[edge][2] += by_height;
    residuals[edge] = weight * (lanes.at_origin[edge] + by_height + extent);
    for (size_t i = 0; i < 3; ++i) by_log_half_axes[edge][i] *= weight;
  }
  // What a foot explains of them.
  std::array<ThreeFours, 2> foot_by_log_half_axes{};
  for (size_t edge = 0; edge < 4; ++edge) {
    for (size_t k = 0; k < 2; ++k) {
      sum->foot[k] += lanes.foot_basis[edge][k] * residuals[edge];
      for (size_t i = 0; i < 3; ++i) {
        foot_by_log_half_axes[k][i] += lanes.foot_basis[edge][k] * by_log_half_axes[edge][i];
      }
    }
  }
  for (size_t edge = 0; edge < 4; ++edge) {
    const auto& basis = lanes.foot_basis[edge];
    const Four left = residuals[edge] - (basis[0] * sum->foot[0] + basis[1] * sum->foot[1]);
    sum->cost += 0.5 * left * left;
    for (size_t i = 0; i < 3; ++i) {
      const Four by_i = by_log_half_axes[edge][i];
      sum->gradient[i] += by_i * left;
      for (size_t j = 0; j <= i; ++j) {
        sum->information[i][j] += by_i * by_log_half_axes[edge][j];
      }
    }
  }
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      for (const ThreeFours& by : foot_by_log_half_axes) sum->information[i][j] -= by[i] * by[j];
    }
  }
}

SOSLAM_INLINE void AddRatio(const RatioRows& ratio, const ThreeFours& log_half_axes, Model* sum) {
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

SOSLAM_INLINE void Evaluate(const Lanes& lanes, const RatioRows& ratio,
                            const ThreeFours& log_half_axes, Model* model) {
  *model = Model();
  AddTangencies(lanes, log_half_axes, model);
  AddRatio(ratio, log_half_axes, model);
}

SOSLAM_INLINE void Replace(const Mask& where, const Four& from, Four* to) {
  *to = where ? from : *to;
}

SOSLAM_INLINE void Replace(const Mask& where, const ThreeFours& from, ThreeFours* to) {
  for (size_t i = 0; i < 3; ++i) Replace(where, from[i], &(*to)[i]);
}

SOSLAM_INLINE void Replace(const Mask& where, const Model& from, Model* to) {
  Replace(where, from.cost, &to->cost);
  for (size_t k = 0; k < 2; ++k) Replace(where, from.foot[k], &to->foot[k]);
  Replace(where, from.gradient, &to->gradient);
  for (size_t i = 0; i < 3; ++i) Replace(where, from.information[i], &to->information[i]);
}

// The x of A x = -b of symmetric A, by cofactors.
SOSLAM_INLINE void SolveForNegative(const std::array<ThreeFours, 3>& a, const ThreeFours& b,
                                    ThreeFours* x) {
  const Four c00 = a[1][1] * a[2][2] - a[2][1] * a[2][1];
  const Four c10 = a[2][1] * a[2][0] - a[1][0] * a[2][2];
  const Four c20 = a[1][0] * a[2][1] - a[1][1] * a[2][0];
  const Four c11 = a[0][0] * a[2][2] - a[2][0] * a[2][0];
  const Four c21 = a[1][0] * a[2][0] - a[0][0] * a[2][1];
  const Four c22 = a[0][0] * a[1][1] - a[1][0] * a[1][0];
  const Four scale = -1.0 / (a[0][0] * c00 + a[1][0] * c10 + a[2][0] * c20);
  (*x)[0] = scale * (c00 * b[0] + c10 * b[1] + c20 * b[2]);
  (*x)[1] = scale * (c10 * b[0] + c11 * b[1] + c21 * b[2]);
  (*x)[2] = scale * (c20 * b[0] + c21 * b[1] + c22 * b[2]);
}

SOSLAM_INLINE bool Any(const Mask& mask) { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }

// MinimiseSquares, line by line.
SOSLAM_WIDE_LOOPS void MinimiseLanes(const RatioRows& ratio, int max_iterations, Lanes* lanes) {
  Model at;
  Evaluate(*lanes, ratio, lanes->log_half_axes, &at);
  Four damping = Four{} + kFirstDamping;
  Four growth = Four{} + kFirstGrowth;
  Mask is_under_way = Four{} == Four{};
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    std::array<ThreeFours, 3> damped = at.information;
    ThreeFours weights;
    for (size_t i = 0; i < 3; ++i) {
      const Four diagonal = at.information[i][i];
      weights[i] = damping * (diagonal > kMinDiagonal ? diagonal : Four{} + kMinDiagonal);
      damped[i][i] += weights[i];
    }
    ThreeFours step;
    SolveForNegative(damped, at.gradient, &step);
    Four decrease{};
    ThreeFours moved;
    for (size_t i = 0; i < 3; ++i) {
      decrease += 0.5 * step[i] * (weights[i] * step[i] - at.gradient[i]);
      moved[i] = lanes->log_half_axes[i] + step[i];
    }
    is_under_way &= (decrease > kNegligibleDecrease * (1.0 + at.cost)) & (damping < kMaxDamping);
    if (!Any(is_under_way)) break;

    Model there;
    Evaluate(*lanes, ratio, moved, &there);
    const Four gain = (at.cost - there.cost) / decrease;
    const Mask is_better = is_under_way & (gain > 0.0);
    Replace(is_better, moved, &lanes->log_half_axes);
    Replace(is_better, there, &at);
    const Four surprise = 2.0 * gain - 1.0;
    const Four fall = 1.0 - surprise * surprise * surprise;
    damping *= is_better ? (fall > kLeastFall ? fall : Four{} + kLeastFall) : growth;
    growth = is_better ? Four{} + kFirstGrowth : 2.0 * growth;
  }
  lanes->foot = at.foot;
  lanes->cost = at.cost;
}

}  // namespace

// What is left of the second ratio once the first is known: the inverse Cholesky factor of their
// covariance.
RatioRows::RatioRows(const ShapePrior& prior) {
  const double correlation = prior.log_correlation;
  const double unexplained = std::sqrt(1.0 - correlation * correlation);
  Eigen::Matrix2d whiten;
  whiten << 1.0, 0.0, -correlation / unexplained, 1.0 / unexplained;
  whiten *= prior.log_sigma.cwiseInverse().asDiagonal();
  by_log_half_axes << whiten, -whiten.rowwise().sum();
  at_prior = whiten * prior.ratio.array().log().matrix();
  information = by_log_half_axes.transpose() * by_log_half_axes;
}

FitsAtYaws::FitsAtYaws(const BoxOnGround& box, const RatioRows& ratio, double shape_exponent)
    : box_(box), ratio_(ratio) {
  lanes_.shape_exponent = shape_exponent;
  for (size_t edge = 0; edge < 4; ++edge) {
    lanes_.at_origin[edge] = box.at_origin[edge];
    lanes_.by_height[edge] = box.normals(edge, 2);
  }
}

void FitsAtYaws::Start(size_t place, const Eigen::Array4d& depths_m,
                       const UprightVector& parameters) {
  yaw_[place] = parameters[0];
  for (size_t i = 0; i < 3; ++i) lanes_.log_half_axes[i][place] = parameters[3 + i];
  const Eigen::Array4d weights = (depths_m * box_.sigma_px).inverse();
  // Gram and Schmidt's orthonormal basis of two columns.
  const Eigen::Vector4d by_x = weights * box_.normals.col(0).array();
  const Eigen::Vector4d by_y = weights * box_.normals.col(1).array();
  const double xx = by_x.norm();
  const Eigen::Vector4d first = by_x / xx;
  const double xy = first.dot(by_y);
  const Eigen::Vector4d rest = by_y - xy * first;
  const double yy = rest.norm();
  const Eigen::Vector4d second = rest / yy;
  foot_from_basis_[place] << -1.0 / xx, xy / (xx * yy), 0.0, -1.0 / yy;

  constexpr double kLeastShare = 1e-6;
  const bool tell_the_foot = xx > kLeastShare * yy && yy > kLeastShare * xx;
  const double cosine = std::cos(yaw_[place]);
  const double sine = std::sin(yaw_[place]);
  for (size_t edge = 0; edge < 4; ++edge) {
    const Eigen::Array3d rounded =
        RoundedDirection(TurnedBack(box_.normals.row(edge), cosine, sine), lanes_.shape_exponent);
    for (size_t i = 0; i < 3; ++i) lanes_.rounded[edge][i][place] = rounded[i];
    lanes_.weight[edge][place] =
        tell_the_foot ? weights[edge] : std::numeric_limits<double>::quiet_NaN();
    lanes_.foot_basis[edge][0][place] = first[edge];
    lanes_.foot_basis[edge][1][place] = second[edge];
  }
}

void FitsAtYaws::Minimise(int max_iterations) { MinimiseLanes(ratio_, max_iterations, &lanes_); }

UprightVector FitsAtYaws::Parameters(size_t place) const {
  const Eigen::Vector2d in_basis(lanes_.foot[0][place], lanes_.foot[1][place]);
  UprightVector parameters;
  parameters << yaw_[place], foot_from_basis_[place] * in_basis, lanes_.log_half_axes[0][place],
      lanes_.log_half_axes[1][place], lanes_.log_half_axes[2][place];
  return parameters;
}

}  // namespace soslam
