// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "model/truth.h"

namespace soslam {

// How a body differs from the true one as a solid: its axes get those names with which they are
// nearest the true ones, so that a body whose axes are named otherwise is the same. Logarithms are
// of estimate over truth.
struct BodyErrors {
  double iou = 0.0;
  double centre_m = 0.0;
  double centre_relative = 0.0;  // centre_m over the mean side of the true body, a cube's as large
  Eigen::Vector3d log_size = Eigen::Vector3d::Zero();  // along the true x, y, z
  double log_scale = 0.0;                              // of the cube root of the volume
  double up_deg = 0.0;            // between the z axes as they are named, 180 for upside down
  std::optional<double> yaw_deg;  // between the x axes about the true z; none of a body of rotation
  bool is_quarter_turned = false;  // its own x axis is named y
};

BodyErrors CompareBodies(const Landmark& estimate, const GroundTruth& truth,
                         const Landmark& truth_in_frame);

// The estimate with its axes named as above.
Landmark NamedLike(const Landmark& estimate, const Landmark& truth);

// The plane that a landmark stands on against that of the true body.
struct PlaneErrors {
  double offset_m = 0.0;  // its height over the true foot, along its own normal
  double tilt_deg = 0.0;
};
PlaneErrors ComparePlane(const Plane& plane, const Landmark& truth);

// Whether the estimate is farther from the plane that it should stand on than the truth is: then
// its height is wrong, rather than the plane.
bool StandsOffItsPlane(const Landmark& estimate, const Plane& plane, const Landmark& truth);

// The parts that make up a body on its plane.
enum class BodyPart {
  kPlane,  // what is up, and how high its foot is
  kSize,
  kYaw,
  kPlace,  // where its foot is on the plane
};
inline constexpr const char* kBodyPartNames[] = {"plane", "size", "yaw", "place"};

// The part that is most to blame: which alone, taken from the truth, raises IoU most.
struct WrongPart {
  BodyPart part = BodyPart::kPlane;
  double iou = 0.0;  // with the part corrected
};
// `camera_centre`: from where it was seen, about. A body whose plane is corrected goes straight
// onto it, or along the line of sight, with its size, as a body would whose boxes had been put onto
// that plane: whichever helps more. None where no part alone helps.
std::optional<WrongPart> FindWrongPart(const Landmark& estimate, const GroundTruth& truth,
                                       const Landmark& truth_in_frame,
                                       const Eigen::Vector3d& camera_centre);

}  // namespace soslam
