// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "constraints/symmetry.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "symmetry/options.h"

namespace soslam {

// The pixels to compare, section V-D: corners in the box and/or a uniform grid over it, or its edge
// pixels, as far as their rays meet the landmark. Corners first, strongest first.
std::vector<Eigen::Vector2d> SamplePixels(const SymmetryImage& image, const Camera& camera,
                                          const Landmark& landmark_in_camera,
                                          const SymmetryOptions& options);

}  // namespace soslam
