// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "geometry/box.h"
#include "geometry/camera.h"
#include "geometry/landmark.h"
#include "image/edge_maps.h"
#include "symmetry/options.h"

namespace soslam {

// The pixels to compare, section V-D: corners in the box and/or a uniform grid over it, as far as
// their rays meet the landmark. Corners first, strongest first.
std::vector<Eigen::Vector2d> SamplePixels(const EdgeMaps& maps, const Camera& camera,
                                          const Landmark& landmark_in_camera, const Box& box,
                                          const SymmetryOptions& options);

}  // namespace soslam
