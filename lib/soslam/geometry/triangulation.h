// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/geometry/camera.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {

struct Ray {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;  // of unit length
};

// The point of least squared distance from all rays. None where the rays hardly differ: the
// smallest eigenvalue of the mean projector across them, about the mean squared angle (rad) between
// them, must be above `least_spread`.
std::optional<Eigen::Vector3d> NearestPointToRays(const std::vector<Ray>& rays,
                                                  double least_spread);

// Least squares point of planes; of several, that nearest to the frame's origin.
class PointOnPlanes {
 public:
  void Add(const Plane& plane, double weight = 1.0);
  Eigen::Vector3d Solve() const;

 private:
  Eigen::Matrix3d normal_matrix_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right_side_ = Eigen::Vector3d::Zero();
};

// Pixel of a point in one camera, without lens distortion.
struct PointView {
  Camera camera;
  Rigid3d camera_from_world;
  Eigen::Vector2d pixel;
};

// Point that is seen in several views.
struct TriangulatedPoint {
  Eigen::Vector3d position_in_world;
  Eigen::Matrix3d covariance;  // m^2, of pixels with independent errors of 1 px
  double mean_error_px;        // reprojection error
};

// The point of lowest reprojection error (Huber loss beyond `huber_px`), found from the point
// nearest to all rays. None with fewer than two views, where the rays hardly differ, and
// where the point is not in front of all cameras.
std::optional<TriangulatedPoint> Triangulate(const std::vector<PointView>& views, double huber_px);

// Distance (px) between a view's pixel and the projection of a point; infinite behind the camera.
double ReprojectionError(const PointView& view, const Eigen::Vector3d& point_in_world);

// Inverse covariance (1 / m^2) of a point in front of all cameras, of pixels with independent
// errors of 1 px.
Eigen::Matrix3d PointInformation(const std::vector<PointView>& views,
                                 const Eigen::Vector3d& point_in_world);
// Smallest standard deviation (px) that is assumed of the pixels of a point, whatever its
// reprojection error.
inline constexpr double kLeastPixelSigma = 0.5;

// Largest angle (rad) at a point between the directions to two of the cameras.
double LargestAngle(const std::vector<Eigen::Vector3d>& camera_centres,
                    const Eigen::Vector3d& point_in_world);

}  // namespace soslam
