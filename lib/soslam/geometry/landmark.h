// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <optional>

#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/plane.h"
#include "soslam/geometry/rigid3.h"
#include "soslam/geometry/support_function.h"

namespace soslam {

// The face that an object rests on. Its own axes are those of the upright object: x the front, z
// up. Its object frame has z away from the support plane in any case: an object on its back has its
// own x axis along z, one on its side its own y axis.
enum class RestingFace { kBottom, kBack, kSide };
inline constexpr std::array kRestingFaces = {RestingFace::kBottom, RestingFace::kBack,
                                             RestingFace::kSide};
inline constexpr std::array kRestingFaceNames = {"bottom", "back", "side"};
inline constexpr const auto& NamesOf(RestingFace) { return kRestingFaceNames; }

// Rotation from the object frame to the object's own axes. Its entries are 0, 1 and -1.
Eigen::Matrix3d OwnFromObject(RestingFace face);

// Axis (0, 1, 2) of the object frame along which one of the object's own axes is.
constexpr Eigen::Index AxisOfOwn(Eigen::Index own_axis, RestingFace face) {
  if (face == RestingFace::kBack) return 2 - own_axis;
  return face == RestingFace::kSide && own_axis > 0 ? 3 - own_axis : own_axis;
}

// Half axes along the object frame's x, y and z of half axes along the object's own axes.
Eigen::Vector3d HalfAxesOnFace(const Eigen::Vector3d& own_half_axes, RestingFace face);

// An object as a convex superquadric, in the paper an ellipsoid: 9 degrees of freedom and two shape
// exponents. Variables name their frame: landmark_in_world, landmark_in_camera. Object frame:
// origin at the centre, z away from the support plane, x the front, so that the mirror plane of a
// symmetric object that stands is its xz plane. See RestingFace for objects that lie.
struct Landmark {
  Rigid3d frame_from_object;
  Eigen::Vector3d half_axes = Eigen::Vector3d::Ones();  // (a, b, c) along x, y, z, metres, > 0
  ShapeExponents shape_exponents = kEllipsoidExponent;  // of SupportFunction, in [1, 2]
  RestingFace rests_on = RestingFace::kBottom;

  const Eigen::Vector3d& Centre() const { return frame_from_object.translation; }
};

// A landmark whose pose has this name: "world_from_object".
template <typename Visitor>
void DescribeLandmark(Visitor& visit, Landmark& landmark, const char* pose) {
  ShapeExponents& exponents = landmark.shape_exponents;
  visit.Field(pose, &landmark.frame_from_object, "origin at the centre, z away from the plane");
  visit.Field("half_axes", &landmark.half_axes,
              "half axes (a, b, c) along the object's x, y, z, metres", kPositive);
  DescribeExponents(visit, exponents, kEllipsoidExponent);
  visit.OrAbsent("rests_on", &landmark.rests_on,
                 "face that the object rests on; z is away from its support plane in any case: on "
                 "its back, its own front is along z; on its side, its own left");
}
inline constexpr auto kInWorld = [](auto& visit, Landmark& landmark) {
  DescribeLandmark(visit, landmark, "world_from_object");
};
inline constexpr auto kInCamera = [](auto& visit, Landmark& landmark) {
  DescribeLandmark(visit, landmark, "camera_from_object");
};

// The geometric mean of the half axes: the size of the body, whatever its shape.
double MeanHalfAxis(const Landmark& landmark);

// A landmark in the target frame.
Landmark Transform(const Rigid3d& target_from_source, const Landmark& landmark_in_source);

// A body in the frame of its own axes, whose xz plane is the mirror plane of a symmetric
// object; it rests on its bottom there.
Landmark InOwnAxes(const Landmark& landmark);

// Dual quadric of the ellipsoid with the landmark's half axes, whatever its exponents: Q* = Z
// diag(a^2, b^2, c^2, -1) Z^T, Z = frame_from_object; pi^T Q* pi = 0 iff the plane pi is tangent.
Eigen::Matrix4d DualQuadric(const Landmark& landmark);

// The landmark of a dual quadric (any scale and sign). Half axes come in ascending order along x,
// y, z of a right-handed frame. `proper` is false when the quadric is not an ellipsoid; the
// absolute values of its squared half axes are then used (Nicholson et al. 2019). None when centre
// or axes are not finite.
struct DualQuadricLandmark {
  Landmark landmark;
  bool proper;
};
std::optional<DualQuadricLandmark> LandmarkFromDualQuadric(const Eigen::Matrix4d& dual_quadric);

// Support point of the landmark in a direction (of any length), and its extent there: the largest
// direction . x over the body. All in the landmark's frame.
struct SupportPoint {
  Eigen::Vector3d point;
  double extent;
};
SupportPoint FindSupportPoint(const Landmark& landmark, const Eigen::Vector3d& direction);

// The support plane: tangent to the landmark at the end of its -z axis, with its z axis as normal.
Plane ComputeSupportPlane(const Landmark& landmark);

// True if all numbers are finite and the half axes positive.
bool HasExtent(const Landmark& landmark);

// True if the whole landmark is in front of the camera.
bool IsInFront(const Landmark& landmark_in_camera);

// The silhouette's extreme point in an image direction: `end_px` is the largest direction . pixel
// (px; unit direction), `point` the tangent point (camera frame) that attains it. The search starts
// at `start`, any point of the landmark; it is faster the nearer that is to the result. None when
// an iterate is behind the camera.
struct SilhouettePoint {
  Eigen::Vector3d point;
  double end_px;
};
std::optional<SilhouettePoint> FindSilhouettePoint(const Camera& camera,
                                                   const Landmark& landmark_in_camera,
                                                   const Eigen::Vector2d& direction,
                                                   const Eigen::Vector3d& start);
// The silhouette's extreme point beyond a line l of the image, whose normal has unit length:
// `plane` is K^T l, `end_px` the signed distance of the point from the line.
std::optional<SilhouettePoint> FindSilhouettePoint(const Eigen::Vector3d& plane,
                                                   const Landmark& landmark_in_camera,
                                                   const Eigen::Vector3d& start);

// The tight box around the landmark's silhouette; not cut at the image border. None unless the
// whole landmark is in front of the camera.
std::optional<Box> OutlineBox(const Camera& camera, const Landmark& landmark_in_camera);

// The root mean square distance (px) between the edges of the landmark's outline box and those of
// `box`; infinite unless the whole landmark is in front of the camera.
double OutlineEdgeRms(const Camera& camera, const Landmark& landmark_in_camera, const Box& box);

// Depth at which a ray first meets the surface (eq. 13): origin + depth * direction, depth > 0.
// Empty when the ray misses the surface, or the surface is behind the origin or around it.
std::optional<double> NearestIntersection(const Landmark& landmark, const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction);

// Upright orientations: z along the support normal. Yaw is the angle (rad) of the object's x axis
// about that normal, counted from a horizontal direction fixed by the normal alone.
Eigen::Quaterniond UprightRotation(const Eigen::Vector3d& support_normal, double yaw);
// The yaw of a rotation's x axis, in (-pi, pi]; the counterpart of UprightRotation.
double Yaw(const Eigen::Vector3d& support_normal, const Eigen::Quaterniond& frame_from_object);
// d yaw / d rotation vector, applied from the left: the normal, for upright landmarks. Not finite
// where the x axis is along the normal, and there is no yaw.
Eigen::RowVector3d YawJacobian(const Eigen::Vector3d& support_normal,
                               const Eigen::Quaterniond& frame_from_object);

// The landmark rotated about its own z axis by `angle` (rad); centre and half axes stay.
Landmark RotatedAboutZ(const Landmark& landmark, double angle);

// The difference of two yaws modulo pi, in [-pi/2, pi/2): an xz mirror plane has no front or back.
double YawDifferenceModuloPi(double yaw, double other);

// The nine degrees of freedom of a landmark in tangent space: rotation vector (in the frame that
// the landmark is given in, applied from the left, rad), centre (m), log half axes. Derivatives by
// a landmark are with respect to these, in this order; residuals mostly have the landmark in the
// camera frame.
inline constexpr int kLandmarkDof = 9;
using LandmarkStep = Eigen::Matrix<double, kLandmarkDof, 1>;
using LandmarkJacobian1 = Eigen::Matrix<double, 1, kLandmarkDof>;

// The landmark to which a step leads.
Landmark ApplyStep(const Landmark& landmark, const LandmarkStep& step);

}  // namespace soslam
