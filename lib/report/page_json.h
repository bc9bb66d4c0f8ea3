// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "geometry/camera.h"
#include "geometry/landmark.h"

namespace soslam {

// Short forms for pages, to keep them small. Lengths are rounded to a tenth of a millimetre, pixels
// to a tenth, other numbers to five significant digits. Numbers that are not finite become null.

nlohmann::json PageNumber(double value);
nlohmann::json PageNumbers(const std::vector<double>& values);
nlohmann::json PageVector(const Eigen::Vector3d& metres);
// [x, y, z, qx, qy, qz, qw]
nlohmann::json PagePose(const Rigid3d& pose);
// {"pose": world_from_object, "half_axes": [a, b, c], "p": shape exponent}
nlohmann::json PageLandmark(const Landmark& landmark_in_world);
// [x, y, x, y, ...] px
nlohmann::json PagePixels(const std::vector<Eigen::Vector2d>& pixels);
// {"outline": pixels, "axes": [front, left, up as pixels from centre to face] or null}
nlohmann::json PageOutline(const Camera& camera, const Landmark& landmark_in_camera);

}  // namespace soslam
