// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "constraints/symmetry.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "orientation/options.h"

namespace soslam {

// Calls `add` with candidates of pixels to compare, section V-D: corners in the box and/or a
// uniform grid over it, or its edge pixels. Corners come first, strongest first. `add` returns
// whether the pixel's ray meets the landmark: at most options.max_corners corners do.
void ForEachSample(const SymmetryImage& image, const SymmetryOptions& options,
                   const std::function<bool(const Eigen::Vector2d&)>& add);

// The candidates whose rays meet a landmark.
std::vector<Eigen::Vector2d> SamplePixels(const SymmetryImage& image, const Camera& camera,
                                          const Landmark& landmark_in_camera,
                                          const SymmetryOptions& options);

}  // namespace soslam
