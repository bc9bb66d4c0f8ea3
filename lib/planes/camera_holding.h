// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace soslam {

// Possible camera holdings: the camera axis nearest to up and the axis that is level.
enum class CameraHolding {
  kLevel,
  kRolled90,  // clockwise about the optical axis, seen from behind the camera
  kRolled180,
  kRolled270,
  kLookingDown,
  kLookingDownRolled90,
};
inline constexpr std::array kCameraHoldings = {
    CameraHolding::kLevel,     CameraHolding::kRolled90,    CameraHolding::kRolled180,
    CameraHolding::kRolled270, CameraHolding::kLookingDown, CameraHolding::kLookingDownRolled90};
inline constexpr std::array kCameraHoldingNames = {
    "level", "rolled_90", "rolled_180", "rolled_270", "looking_down", "looking_down_rolled_90"};

constexpr const char* NameOf(CameraHolding holding) {
  return kCameraHoldingNames.at(static_cast<size_t>(holding));
}

// Two axes in the camera's frame: `level` is horizontal up to the roll's deviation; `up` is
// vertical when the third axis is horizontal too, up to the pitch's deviation.
struct HeldAxes {
  Eigen::Vector3d level;
  Eigen::Vector3d up;
};
HeldAxes AxesOf(CameraHolding holding);

}  // namespace soslam
