// SPDX-License-Identifier: BSD-3-Clause
#include "planes/camera_holding.h"

#include <stdexcept>

namespace soslam {

HeldAxes AxesOf(CameraHolding holding) {
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d y = Eigen::Vector3d::UnitY();
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  switch (holding) {
    case CameraHolding::kLevel:
      return {x, -y};
    case CameraHolding::kRolled90:
      return {y, -x};
    case CameraHolding::kRolled180:
      return {x, y};
    case CameraHolding::kRolled270:
      return {y, x};
    case CameraHolding::kLookingDown:
      return {x, -z};
    case CameraHolding::kLookingDownRolled90:
      return {y, -z};
  }
  throw std::logic_error("holding without axes");
}

}  // namespace soslam
