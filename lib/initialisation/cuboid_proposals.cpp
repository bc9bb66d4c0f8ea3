// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/cuboid_proposals.h"

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <numbers>

namespace soslam {
namespace {

using Vector5 = Eigen::Matrix<double, 5, 1>;
using Matrix5 = Eigen::Matrix<double, 5, 5>;

// The direction of the view along the plane, of any length.
Eigen::Vector3d HorizontalRay(const CuboidView& view) {
  const Eigen::Vector3d ray = view.camera.Ray(view.box.Centre());
  const Eigen::Vector3d& up = view.plane_in_camera.normal;
  return ray - up.dot(ray) * up;
}

// The planes through the camera and the box's edges, with normals into the box.
std::array<Eigen::Vector3d, 4> InwardNormals(const CuboidView& view) {
  std::array<Eigen::Vector3d, 4> normals;
  const auto lines = view.box.EdgeLines();
  const Eigen::Vector3d ray = view.camera.Ray(view.box.Centre());
  for (size_t i = 0; i < lines.size(); ++i) {
    normals[i] = view.camera.BackProject(lines[i]).normal;
    if (normals[i].dot(ray) < 0.0) normals[i] = -normals[i];
  }
  return normals;
}

double Sign(double value) { return value < 0.0 ? -1.0 : 1.0; }

// The condition that a corner is in a plane through the camera: row . unknowns = value. Unknowns:
// foot along x and y from the plane's point nearest to the camera, half axes along x and y, height.
struct Equation {
  Vector5 row;
  double value;
};

Equation CornerInPlane(const Eigen::Matrix3d& axes, const Eigen::Vector3d& corner,
                       const Eigen::Vector3d& plane_normal, const Plane& support) {
  const Eigen::Vector3d along = axes.transpose() * plane_normal;
  Equation equation;
  equation.row << along.x(), along.y(), corner.x() * along.x(), corner.y() * along.y(),
      (corner.z() > 0.0 ? along.z() : 0.0);
  equation.value = support.offset * along.z();
  return equation;
}

// The top corner farthest along the view, as signs along the axes.
Eigen::Vector3d FarthestTopCorner(const CuboidView& view, const Eigen::Matrix3d& axes) {
  // At the yaw that faces the camera two corners are equally far, up to rounding.
  constexpr double kTie = 1e-9;
  const Eigen::Vector3d along = axes.transpose() * HorizontalRay(view).normalized();
  return {Sign(along.x() - kTie), Sign(along.y() - kTie), 1.0};
}

}  // namespace

double YawFacingCamera(const CuboidView& view) {
  const Eigen::Vector3d& up = view.plane_in_camera.normal;
  const Eigen::Vector3d in_ground =
      UprightRotation(up, 0.0).conjugate() * Eigen::Vector3d(-HorizontalRay(view));
  return std::atan2(in_ground.y(), in_ground.x());
}

std::optional<Landmark> CuboidAt(const CuboidView& view, double yaw, double corner_column_px) {
  const Plane& support = view.plane_in_camera;
  const Eigen::Quaterniond rotation = UprightRotation(support.normal, yaw);
  const Eigen::Matrix3d axes = rotation.toRotationMatrix();

  Matrix5 rows;
  Vector5 values;
  int count = 0;
  const auto add = [&](const Equation& equation) {
    rows.row(count) = equation.row.transpose();
    values[count++] = equation.value;
  };
  for (const Eigen::Vector3d& inward : InwardNormals(view)) {
    const Eigen::Vector3d touching = -(axes.transpose() * inward).unaryExpr(&Sign);
    add(CornerInPlane(axes, touching, inward, support));
  }
  const Eigen::Vector3d column(1.0, 0.0, -corner_column_px);
  add(CornerInPlane(axes, FarthestTopCorner(view, axes), view.camera.BackProject(column).normal,
                    support));

  const Eigen::FullPivLU<Matrix5> decomposition(rows);
  if (!decomposition.isInvertible()) return std::nullopt;
  const Vector5 solution = decomposition.solve(values);
  if (!solution.allFinite() || !(solution.tail<3>().minCoeff() > 0.0)) return std::nullopt;

  Landmark cuboid;
  cuboid.shape_exponents = kCuboidExponent;
  cuboid.half_axes = {solution[2], solution[3], 0.5 * solution[4]};
  cuboid.frame_from_object = {
      rotation, axes * Eigen::Vector3d(solution[0], solution[1], cuboid.half_axes.z()) -
                    support.offset * support.normal};
  if (!IsInFront(cuboid)) return std::nullopt;
  return cuboid;
}

std::vector<CuboidProposal> ProposeCuboids(const CuboidView& view, int yaw_samples,
                                           int corner_samples) {
  const double facing = YawFacingCamera(view);
  std::vector<CuboidProposal> proposals;
  for (int i = 0; i < yaw_samples; ++i) {
    const double yaw = facing + 0.5 * std::numbers::pi * ((i + 0.5) / yaw_samples - 0.5);
    for (int k = 0; k < corner_samples; ++k) {
      const double column = view.box.x_min + (k + 0.5) / corner_samples * view.box.Width();
      const auto cuboid = CuboidAt(view, yaw, column);
      if (cuboid) proposals.push_back({yaw, *cuboid});
    }
  }
  return proposals;
}

}  // namespace soslam
