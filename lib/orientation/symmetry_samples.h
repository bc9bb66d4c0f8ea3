// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "constraints/symmetry.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "orientation/symmetry_options.h"

namespace soslam {

// The candidates of pixels to compare, provided that their rays meet a landmark, section V-D:
// corners in the box and/or a uniform grid over it, or its edge pixels. Corners first, strongest
// first.
struct SampleCandidates {
  SampleCandidates(const SymmetryImage& image, const SymmetryOptions& options);

  std::vector<Eigen::Vector2d> corners;
  // Limit on the corners whose rays meet the landmark. If there are no more corners in all, every
  // candidate whose ray meets the landmark is compared.
  size_t max_corners;
  std::vector<Eigen::Vector2d> others;
};

// The candidates whose rays meet the landmark.
std::vector<Eigen::Vector2d> SamplePixels(const SymmetryImage& image, const Camera& camera,
                                          const Landmark& landmark_in_camera,
                                          const SymmetryOptions& options);

}  // namespace soslam
