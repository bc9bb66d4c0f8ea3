// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "soslam/model/map_points.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Image point without lens distortion; none where that has no inverse.
std::optional<Eigen::Vector2d> UndistortedPixel(const Sequence& sequence,
                                                const PointObservation& observation);

// An undistorted pixel of a frame as points are stored: of the image file.
PointObservation StoredObservation(const Sequence& sequence, const Frame& frame,
                                   const Eigen::Vector2d& pixel);

// The points with undistorted pixels, without observations whose distortion has no inverse.
std::vector<MapPoint> WithoutDistortion(const Sequence& sequence, std::vector<MapPoint> points);

}  // namespace soslam
