// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "soslam/constraints/landmark_cost.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

// The box without the bias of its edges. One-sided edges stay as they are.
Box WithoutBias(const Box& box, const std::array<bool, 4>& is_one_sided, const EdgeBias& bias);

// An edge of a detection's box, for a body of any shape exponents.
struct BoxEdge {
  // K^T l of the edge's line l, pointing out of the box: plane . x / x_z is the signed distance
  // (px) by which the projection of x (camera frame) lies outside the edge.
  Eigen::Vector3d plane;
  // True if the object may reach beyond the edge (the image border or a nearer object truncates
  // it).
  bool is_one_sided = false;
  double sigma_px = 1.0;
};

// Edges in the order left, top, right, bottom, of the box without its bias.
std::array<BoxEdge, 4> BoxEdges(const Camera& camera, const Box& box,
                                const std::array<bool, 4>& is_one_sided, double sigma_fraction,
                                const EdgeBias& bias = {});

// Depth of a tangent point, and its derivative by the depth of the body's centre: 0 if it is fixed.
struct TangentDepth {
  double depth_m;
  double d_centre_depth = 0.0;
};

// Depth of the point where an object is tangent to a plane parallel to the one behind an edge.
TangentDepth FindTangentDepth(const BoxEdge& edge, const Landmark& landmark_in_camera);

// Tangent depth to first order about a linearisation point: the depth of the centre times their
// ratio there. With fixed depths, a smaller world would have smaller residuals. A centre nearer
// than a tenth of its depth there, or behind the camera, counts as if it were at this tenth.
class TangentDepthRatio {
 public:
  TangentDepthRatio() = default;
  TangentDepthRatio(const BoxEdge& edge, const Landmark& linearisation_in_camera);
  TangentDepth At(const Landmark& landmark_in_camera) const;

 private:
  double ratio_ = 1.0;
  double min_centre_depth_m_ = 0.0;
};

// Signed distance (px / sigma) by which an object reaches outside a box edge: zero when the plane
// behind the edge is tangent to it. Equals h(n) + n . c + d of the plane in metres, divided by the
// depth of the tangent point (its other changes alter the residual by less than the residual's own
// size) and multiplied by the focal length. For a one-sided edge it is zero when positive. At p = 2
// it has the same zeros as the paper's eq. (3), as pi^T Q* pi = h^2 - (n . c + d)^2. `bias_px`
// moves the edge outwards before the comparison.
double Tangency(const BoxEdge& edge, const Landmark& landmark_in_camera, const TangentDepth& depth,
                double bias_px, LandmarkJacobian1* jacobian);

// Tangency without bias, with the tangent point at its own depth (FindTangentDepth), which counts
// as fixed in the Jacobian. None unless that is in front of the camera.
std::optional<double> TangencyAtOwnDepth(const BoxEdge& edge, const Landmark& landmark_in_camera,
                                         LandmarkJacobian1* jacobian);

// Square root of what the curvature of the body adds to the Hessian of the squared tangency, as two
// rows by a rotation vector in the camera frame. A body that reaches outside an edge, and turns
// towards its corner, reaches outside faster than its tangent point says: without these rows,
// Gauss-Newton steps overshoot at the corners of cuboids. Zero inside the edge, where this part is
// negative, and for ellipsoids, which have no corners.
Eigen::Matrix<double, 2, 3> TangencyCurvature(const BoxEdge& edge,
                                              const Landmark& landmark_in_camera, double depth_m,
                                              double tangency);

// Signed distance (px / sigma) by which an object's silhouette reaches outside a box edge. Tangency
// is its linearisation; this is exact, so that residual and Jacobian agree wherever the object is.
// Value and Jacobian are not numbers unless the tangent point is in front of the camera.
double OutlineExcess(const BoxEdge& edge, const Landmark& landmark_in_camera,
                     LandmarkJacobian1* jacobian);

// Tangencies of the four edges of one detection, with the TangentDepthRatio of each.
class BoxTerm final : public LandmarkTerm {
 public:
  BoxTerm(const std::array<BoxEdge, 4>& edges, const Landmark& linearisation_in_camera);
  int NumResiduals() const override { return 4; }
  void Evaluate(const Landmark& landmark_in_camera, Residuals residuals,
                Jacobian* jacobian) const override;

 private:
  std::array<BoxEdge, 4> edges_;
  std::array<TangentDepthRatio, 4> depths_;
};

// Signed distances (OutlineExcess) by which the silhouette reaches outside the four edges of one
// detection. Not finite if the object is not wholly in front of the camera.
class OutlineTerm final : public LandmarkTerm {
 public:
  explicit OutlineTerm(const std::array<BoxEdge, 4>& edges) : edges_(edges) {}
  int NumResiduals() const override { return 4; }
  void Evaluate(const Landmark& landmark_in_camera, Residuals residuals,
                Jacobian* jacobian) const override;

 private:
  std::array<BoxEdge, 4> edges_;
};

// The tangency of one box edge in the back end, with the TangentDepthRatio of the initial estimate.
//
// Residuals: 1 + 2, the tangency, and curvature rows: two zeros whose Jacobian is
// TangencyCurvature. Blocks: world_from_camera; landmark in the world; bias (px) of the detector at
// this side of boxes; logarithm of the factor of the focal lengths.
class TangencyResidual final
    : public ceres::SizedCostFunction<3, kPoseSize, kLandmarkSize, kBiasSize, kLogFocalSize> {
 public:
  static constexpr int kCurvatureRows = 2;  // the last ones

  // The tangent point of the initial estimate must be in front of the camera.
  TangencyResidual(const BoxEdge& edge, const Landmark& initial_in_camera);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  BoxEdge edge_;
  ShapeExponents shape_exponents_;
  TangentDepthRatio depth_;
};

}  // namespace soslam
