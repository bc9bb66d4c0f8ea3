// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "planes/planes_estimate.h"

namespace soslam {

// The ground for cameras that a vehicle holds level at a known height (m): y = height in each
// camera's frame. The ground of a long drive is no plane, so each object gets one of its own: the
// mean of those of the cameras that see it (of all, when none does).
PlanesEstimate PlanesBelowCameras(const Sequence& sequence, double height_m);

// The same ground in the camera's frame.
Plane GroundInCamera(double height_m);

}  // namespace soslam
