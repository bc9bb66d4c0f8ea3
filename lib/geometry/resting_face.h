// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

namespace soslam {

// The face that an object rests on. Its own axes are those of the upright object: x the front, z
// up. Its object frame has z away from the support plane in any case: an object on its back has its
// own x axis along z, one on its side its own y axis.
enum class RestingFace { kBottom, kBack, kSide };
inline constexpr std::array kRestingFaces = {RestingFace::kBottom, RestingFace::kBack,
                                             RestingFace::kSide};
inline constexpr std::array kRestingFaceNames = {"bottom", "back", "side"};

// Rotation from the object frame to the object's own axes. Its entries are 0, 1 and -1.
Eigen::Matrix3d OwnFromObject(RestingFace face);

// Axis of the object frame along which the object's own z axis is.
constexpr Eigen::Index OwnHeightAxis(RestingFace face) {
  if (face == RestingFace::kBottom) return 2;
  return face == RestingFace::kBack ? 0 : 1;
}

// Half axes along the object frame's x, y and z of half axes along the object's own axes.
Eigen::Vector3d HalfAxesOnFace(const Eigen::Vector3d& own_half_axes, RestingFace face);

}  // namespace soslam
