// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planes/planes_estimate.h"

namespace soslam {

// Ground planes for cameras that a vehicle holds level at a known height (m): y = height in each
// camera's frame. The ground of a long trajectory is not one plane, so each object gets its own:
// the mean of the planes of the cameras that see it (of all cameras when none does).
PlanesEstimate PlanesBelowCameras(const Sequence& sequence, double height_m);

// The ground plane in the camera's frame.
Plane GroundInCamera(double height_m);

}  // namespace soslam
