// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/constraints/tangency.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "soslam/geometry/support_function.h"

namespace soslam {

Box WithoutBias(const Box& box, const std::array<bool, 4>& is_one_sided, const EdgeBias& bias) {
  const auto outside_px = [&](size_t side, double extent_px) {
    return is_one_sided[side] ? 0.0 : bias[side] * extent_px;
  };
  return {box.x_min + outside_px(0, box.Width()), box.y_min + outside_px(1, box.Height()),
          box.x_max - outside_px(2, box.Width()), box.y_max - outside_px(3, box.Height())};
}

namespace {

// Lower limit of sigma: boxes of a few pixels are not more precise than this.
constexpr double kMinSigmaPx = 1.0;

constexpr double kMinDepthShare = 0.1;  // of the depth at the linearisation point

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::array<BoxEdge, 4> BoxEdges(const Camera& camera, const Box& box,
                                const std::array<bool, 4>& is_one_sided, double sigma_fraction,
                                const EdgeBias& bias) {
  const Eigen::Matrix3d to_plane = camera.Intrinsics().transpose();
  const auto lines = WithoutBias(box, is_one_sided, bias).EdgeLines();
  std::array<BoxEdge, 4> edges;
  for (size_t i = 0; i < edges.size(); ++i) {
    const double outwards = i < 2 ? -1.0 : 1.0;
    const double side = i % 2 == 0 ? box.Width() : box.Height();
    edges[i] = {outwards * (to_plane * lines[i]), is_one_sided[i],
                std::max(kMinSigmaPx, sigma_fraction * side)};
  }
  return edges;
}

namespace {

// Support of a body in the direction of the plane behind an edge.
struct EdgeSupport {
  EdgeSupport(const BoxEdge& edge, const Landmark& landmark_in_camera) {
    const Eigen::Quaterniond& rotation = landmark_in_camera.frame_from_object.rotation;
    value = SupportFunction(landmark_in_camera.half_axes, landmark_in_camera.shape_exponents,
                            rotation.conjugate() * edge.plane);
    from_centre = rotation * value.point;
  }

  SupportValue value;
  Eigen::Vector3d from_centre;  // the support point, along the axes of the camera
};

double EvaluateTangency(const EdgeSupport& support, const BoxEdge& edge,
                        const Landmark& landmark_in_camera, const TangentDepth& depth,
                        double bias_px, LandmarkJacobian1* jacobian) {
  const double weight = 1.0 / (depth.depth_m * edge.sigma_px);
  const double outside =
      weight * (edge.plane.dot(landmark_in_camera.Centre()) + support.value.extent);
  const double residual = outside - bias_px / edge.sigma_px;
  const bool is_free = edge.is_one_sided && residual > 0.0;
  if (jacobian != nullptr) {
    jacobian->head<3>() = support.from_centre.cross(edge.plane);
    jacobian->segment<3>(3) = edge.plane;
    jacobian->tail<3>() = support.value.d_log_half_axes;
    *jacobian *= weight;
    (*jacobian)[5] -= outside / depth.depth_m * depth.d_centre_depth;
    if (is_free) jacobian->setZero();
  }
  return is_free ? 0.0 : residual;
}

}  // namespace

double Tangency(const BoxEdge& edge, const Landmark& landmark_in_camera, const TangentDepth& depth,
                double bias_px, LandmarkJacobian1* jacobian) {
  return EvaluateTangency({edge, landmark_in_camera}, edge, landmark_in_camera, depth, bias_px,
                          jacobian);
}

std::optional<double> TangencyAtOwnDepth(const BoxEdge& edge, const Landmark& landmark_in_camera,
                                         LandmarkJacobian1* jacobian) {
  const EdgeSupport support(edge, landmark_in_camera);
  const double depth_m = landmark_in_camera.Centre().z() + support.from_centre.z();
  if (!(depth_m > 0.0)) return std::nullopt;
  return EvaluateTangency(support, edge, landmark_in_camera, {depth_m}, 0.0, jacobian);
}

// A rotation w of the body in its own frame turns the plane's normal m by m x w.
Eigen::Matrix<double, 2, 3> TangencyCurvature(const BoxEdge& edge,
                                              const Landmark& landmark_in_camera, double depth_m,
                                              double tangency) {
  if (!(tangency > 0.0) || landmark_in_camera.shape_exponents == kEllipsoidExponent) {
    return Eigen::Matrix<double, 2, 3>::Zero();
  }
  const Eigen::Matrix3d camera_from_object =
      landmark_in_camera.frame_from_object.rotation.toRotationMatrix();
  const Eigen::Vector3d m = camera_from_object.transpose() * edge.plane;
  Eigen::Matrix<double, 3, 2> across;  // an orthonormal basis of the directions across m
  across.col(0) = m.unitOrthogonal();
  across.col(1) = m.normalized().cross(across.col(0));
  const Eigen::Matrix2d hessian =
      across.transpose() *
      SupportHessian(landmark_in_camera.half_axes, landmark_in_camera.shape_exponents, m) * across;
  Eigen::Matrix2d root;  // upper Cholesky factor of a matrix that may be singular
  root(0, 0) = std::sqrt(std::max(0.0, hessian(0, 0)));
  root(0, 1) = root(0, 0) > 0.0 ? hessian(0, 1) / root(0, 0) : 0.0;
  root(1, 0) = 0.0;
  root(1, 1) = std::sqrt(std::max(0.0, hessian(1, 1) - root(0, 1) * root(0, 1)));
  const double weight = tangency / (depth_m * edge.sigma_px);
  return std::sqrt(weight) * root * across.transpose() * Skew(m) * camera_from_object.transpose();
}

TangentDepth FindTangentDepth(const BoxEdge& edge, const Landmark& landmark_in_camera) {
  return {FindSupportPoint(landmark_in_camera, edge.plane).point.z()};
}

TangentDepthRatio::TangentDepthRatio(const BoxEdge& edge, const Landmark& linearisation_in_camera)
    : ratio_(FindTangentDepth(edge, linearisation_in_camera).depth_m /
             linearisation_in_camera.Centre().z()),
      min_centre_depth_m_(kMinDepthShare * linearisation_in_camera.Centre().z()) {}

TangentDepth TangentDepthRatio::At(const Landmark& landmark_in_camera) const {
  const double centre_depth_m = landmark_in_camera.Centre().z();
  if (!(centre_depth_m > min_centre_depth_m_)) return {ratio_ * min_centre_depth_m_};
  return {ratio_ * centre_depth_m, ratio_};
}

double OutlineExcess(const BoxEdge& edge, const Landmark& landmark_in_camera,
                     LandmarkJacobian1* jacobian) {
  const auto silhouette = FindSilhouettePoint(
      edge.plane, landmark_in_camera, FindSupportPoint(landmark_in_camera, edge.plane).point);
  const double excess_px = silhouette ? silhouette->end_px : kNaN;
  const bool is_free = edge.is_one_sided && excess_px > 0.0;
  if (jacobian != nullptr) {
    jacobian->setConstant(silhouette ? 0.0 : kNaN);
    if (silhouette && !is_free) {
      BoxEdge tangent = edge;
      tangent.is_one_sided = false;
      tangent.plane.z() -= excess_px;
      Tangency(tangent, landmark_in_camera, {silhouette->point.z()}, 0.0, jacobian);
    }
  }
  return is_free ? 0.0 : excess_px / edge.sigma_px;
}

BoxTerm::BoxTerm(const std::array<BoxEdge, 4>& edges, const Landmark& linearisation_in_camera)
    : edges_(edges) {
  for (size_t i = 0; i < edges.size(); ++i) depths_[i] = {edges[i], linearisation_in_camera};
}

void BoxTerm::Evaluate(const Landmark& landmark_in_camera, Residuals residuals,
                       Jacobian* jacobian) const {
  for (size_t i = 0; i < edges_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    LandmarkJacobian1 d_landmark;
    residuals[row] = Tangency(edges_[i], landmark_in_camera, depths_[i].At(landmark_in_camera), 0.0,
                              jacobian != nullptr ? &d_landmark : nullptr);
    if (jacobian != nullptr) jacobian->row(row) = d_landmark;
  }
}

void OutlineTerm::Evaluate(const Landmark& landmark_in_camera, Residuals residuals,
                           Jacobian* jacobian) const {
  if (!IsInFront(landmark_in_camera)) {
    residuals.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (jacobian != nullptr) jacobian->setConstant(std::numeric_limits<double>::quiet_NaN());
    return;
  }
  for (size_t i = 0; i < edges_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    LandmarkJacobian1 d_landmark;
    residuals[row] = OutlineExcess(edges_[i], landmark_in_camera, &d_landmark);
    if (jacobian != nullptr) jacobian->row(row) = d_landmark;
  }
}

TangencyResidual::TangencyResidual(const BoxEdge& edge, const Landmark& initial_in_camera)
    : edge_(edge),
      shape_exponents_(initial_in_camera.shape_exponents),
      depth_(edge, initial_in_camera) {}

bool TangencyResidual::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const RelativeObservation observation(blocks, shape_exponents_);
  const Landmark& landmark = observation.landmark_in_camera();
  if (!landmark.half_axes.allFinite())
    return false;  // the step was too large: the solver shortens it
  const TangentDepth depth = depth_.At(landmark);
  LandmarkJacobian1 d_tangency;
  BoxEdge edge = edge_;
  edge.plane.head<2>() *= std::exp(*blocks[3]);
  const double tangency = Tangency(edge, landmark, depth, *blocks[2], &d_tangency);
  if (!std::isfinite(tangency)) return false;
  Eigen::Map<Eigen::Vector3d>(residuals) << tangency, 0.0, 0.0;
  if (jacobians == nullptr) return true;
  Eigen::Matrix<double, 3, kLandmarkDof> d_landmark;
  d_landmark.setZero();
  d_landmark.row(0) = d_tangency;
  d_landmark.bottomLeftCorner<kCurvatureRows, 3>() =
      TangencyCurvature(edge, landmark, depth.depth_m, tangency);
  observation.WriteJacobians<3>(d_landmark, blocks, jacobians);
  const bool is_free = edge_.is_one_sided && !(tangency < 0.0);
  using Column = Eigen::Map<Eigen::Vector3d>;
  if (jacobians[2] != nullptr) {
    Column{jacobians[2]} = Eigen::Vector3d(is_free ? 0.0 : -1.0 / edge_.sigma_px, 0.0, 0.0);
  }
  if (jacobians[3] != nullptr) {
    const Eigen::Vector3d tangent_point = FindSupportPoint(landmark, edge.plane).point;
    const double d_log_focal =
        edge.plane.head<2>().dot(tangent_point.head<2>()) / (depth.depth_m * edge.sigma_px);
    Column{jacobians[3]} = Eigen::Vector3d(is_free ? 0.0 : d_log_focal, 0.0, 0.0);
  }
  return true;
}

}  // namespace soslam
