// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "geometry/rigid3.h"

namespace soslam {

// Absolute trajectory error, m: the root mean square distance between estimated and true camera
// centres after the rigid alignment that makes it smallest (Umeyama, no scale). Frames without
// truth are left out. None with fewer than three true poses.
std::optional<double> AbsoluteTrajectoryError(
    const std::vector<Rigid3d>& world_from_camera,
    const std::vector<std::optional<Rigid3d>>& true_world_from_camera);

}  // namespace soslam
