// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "benchmark/paper_baseline.h"

// The residuals of paper_baseline.h, as functors for ceres' numeric derivatives.
namespace soslam::paper {

// A landmark's nine numbers: rotation vector applied from the left, shift of the centre, change of
// the half axes, all from the start. A pose's six: rotation vector and shift of world_from_camera.
inline constexpr int kLandmarkSize = 9;
inline constexpr int kPoseSize = 6;

struct Ellipsoid {
  Ellipsoid(const Landmark& start, const double* parameters);
  // Z diag(a^2, b^2, c^2, -1) Z^T.
  Eigen::Matrix4d DualQuadric() const;

  Eigen::Matrix3d rotation;  // world_from_object
  Eigen::Vector3d centre;
  Eigen::Vector3d half_axes;
};

// camera_from_world, 4 x 4.
Eigen::Matrix4d CameraFromWorld(const Rigid3d& start, const double* parameters);

// Eq. (2) to (4). Blocks: pose, landmark.
struct DetectionResiduals {
  bool operator()(const double* pose, const double* landmark, double* residuals) const;

  Camera camera;
  View view;
  Landmark start;
  double weight;
};

// Eq. (5) to (11): support, then scale ratio. Block: landmark.
struct PriorResiduals {
  bool operator()(const double* landmark, double* residuals) const;

  Plane plane;
  Eigen::Vector2d ratio;
  Landmark start;
  double angle_weight;
  double tangency_weight;
};

// Relative pose of two views against the odometry's. Blocks: both poses.
struct OdometryResiduals {
  bool operator()(const double* first, const double* second, double* residuals) const;

  Rigid3d first_start;
  Rigid3d second_start;
  double rotation_weight;
  double translation_weight;
};

// Eq. (24), one residual for each of the pixels: the nearest edges are looked up in every
// evaluation, the quadric is made once for all pixels. Blocks: pose, landmark.
class SymmetryResiduals {
 public:
  // Pixels of which both points are visible on the start: corners and a uniform grid, section V-D.
  SymmetryResiduals(const Camera& camera, const View& view, const Landmark& start, double weight);

  int NumResiduals() const { return static_cast<int>(pixels_.size()); }
  bool operator()(double const* const* blocks, double* residuals) const;

 private:
  // An ellipsoid as the camera sees it.
  struct Surface {
    Eigen::Matrix4d quadric;
    Eigen::Vector3d centre;
    Eigen::Vector3d mirror_normal;
  };
  Surface SurfaceAt(const double* pose, const double* landmark) const;
  // P-dagger, eq. (13).
  std::optional<Eigen::Vector3d> PointOf(const Surface& surface,
                                         const Eigen::Vector2d& pixel) const;
  static Eigen::Vector3d Mirrored(const Surface& surface, const Eigen::Vector3d& point);
  bool IsVisible(const Surface& surface, const Eigen::Vector3d& point) const;
  // The distance to the nearest edge on the tangent plane, eq. (23).
  std::optional<double> Descriptor(const Surface& surface, const Eigen::Vector2d& pixel,
                                   const Eigen::Vector3d& point) const;
  std::optional<double> Difference(const Surface& surface, const Eigen::Vector2d& pixel) const;

  Camera camera_;
  View view_;
  Landmark start_;
  double weight_;
  std::vector<Eigen::Vector2d> pixels_;
};

}  // namespace soslam::paper
