// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/closed_form.h"

#include <Eigen/LU>
#include <cmath>

namespace soslam {
namespace {

// Each round takes the error of the tangent depths to a hundredth, or less.
constexpr int kMaxDepthRounds = 20;
constexpr double kDepthTolerance = 1e-10;

// n with n^T A = 0: the determinants of A without each of its rows, signs alternating.
Eigen::Array4d LeftNullVector(const Eigen::Matrix<double, 4, 3>& a) {
  const Eigen::Vector3d one = a.row(0), two = a.row(1), three = a.row(2), four = a.row(3);
  const Eigen::Vector3d first = one.cross(two);
  const Eigen::Vector3d last = three.cross(four);
  return {two.dot(last), -one.dot(last), first.dot(four), -first.dot(three)};
}

}  // namespace

// Of one yaw, in foot x, foot y and c.
struct ClosedForm::System {
  Eigen::Vector3d Solve(const Eigen::Array4d& residuals) const {
    Eigen::Vector3d right_side;
    for (int i = 0; i < 3; ++i) {
      const int row = i < left_out ? i : i + 1;
      right_side[i] = b[row] + residuals[row];
    }
    return inverse * right_side;
  }

  Eigen::Array4d b;
  Eigen::Array4d null;                 // n
  int left_out;                        // of the equations, that which the others determine best
  Eigen::Matrix3d inverse;             // of the others' rows of A
  Eigen::Matrix<double, 4, 3> depths;  // of the tangent points, over that of the ground's origin
  Eigen::RowVector3d nearest;          // of the body's point nearest to the camera's plane
};

ClosedForm::ClosedForm(const UprightObservation& observation)
    : box_(observation.edges, Rigid3d(), UprightGround(observation.plane_in_camera)),
      proportions_(observation.prior.ratio.x(), observation.prior.ratio.y(), 1.0),
      shape_exponent_(observation.prior.shape_exponent) {}

ClosedForm::System ClosedForm::SystemAt(double yaw) const {
  const double cosine = std::cos(yaw);
  const double sine = std::sin(yaw);
  const auto support_towards = [&](const Eigen::Vector3d& direction) {
    return SupportFunction(proportions_, shape_exponent_, TurnedBack(direction, cosine, sine));
  };
  const Eigen::Vector3d axis_in_object = TurnedBack(box_.optical_axis, cosine, sine);
  System system;
  system.b = -box_.at_origin;
  Eigen::Matrix<double, 4, 3> a = box_.normals;
  system.depths.rowwise() = box_.optical_axis.transpose();
  for (int i = 0; i < 4; ++i) {
    const SupportValue support = support_towards(box_.normals.row(i));
    a(i, 2) += support.extent;
    system.depths(i, 2) += axis_in_object.dot(support.contact);
  }
  system.nearest = box_.optical_axis;
  system.nearest[2] -= support_towards(box_.optical_axis).extent;
  system.null = LeftNullVector(a);
  system.null.abs().maxCoeff(&system.left_out);
  Eigen::Matrix3d others;
  for (int i = 0; i < 3; ++i) others.row(i) = a.row(i < system.left_out ? i : i + 1);
  system.inverse = others.inverse();
  return system;
}

// A x - b of the least squares solution x, tangent points at these depths.
Eigen::Array4d ClosedForm::Residuals(const System& system, const Eigen::Array4d& depths_m) const {
  const double missing = -(system.null * system.b).sum();  // n^T (A x - b), for any x
  if (box_.is_bound.sum() > 0.0) {
    // Three equations have a solution, and the bound is met as it happens.
    Eigen::Array4d at_bound = box_.is_bound * missing / (box_.is_bound * system.null).sum();
    if (!(at_bound.sum() < 0.0)) return at_bound;
  }
  const Eigen::Array4d direction = (depths_m * box_.sigma_px).square() * system.null;
  return direction * (missing / (system.null * direction).sum());
}

std::optional<StartAtYaw> ClosedForm::At(double yaw) const {
  if (!HasEnoughEdges()) return std::nullopt;
  const System system = SystemAt(yaw);
  Eigen::Array4d depths_m = Eigen::Array4d::Ones();  // while they are equal, of any size
  Eigen::Vector3d solution;
  for (int round = 0; round < kMaxDepthRounds; ++round) {
    solution = system.Solve(Residuals(system, depths_m));
    if (!solution.allFinite() || !(solution.z() > 0.0)) return std::nullopt;
    if (!(box_.origin_depth + system.nearest * solution > 0.0)) return std::nullopt;
    const Eigen::Array4d before = depths_m;
    depths_m = box_.origin_depth + (system.depths * solution).array();
    if (((depths_m - before).abs() < kDepthTolerance * depths_m).all()) break;
  }
  StartAtYaw start{UprightVector(), depths_m};
  start.parameters << yaw, solution.head<2>(), (solution.z() * proportions_).array().log().matrix();
  return start;
}

std::optional<Landmark> SolveAtYaw(const UprightObservation& observation, double yaw) {
  const auto solution = ClosedForm(observation).At(yaw);
  if (!solution) return std::nullopt;
  return UprightGround(observation.plane_in_camera)
      .LandmarkAt(solution->parameters, observation.prior.shape_exponent);
}

}  // namespace soslam
