// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "initialisation/semantic_table.h"
#include "planes/camera_attitude.h"
#include "planes/planes_estimate.h"

namespace soslam {

// How an object of that prior is mounted; without one it stands.
Mount MountOf(const std::optional<ShapePrior>& prior);

// What is known of down, z of what hangs: ceilings are level where floors are.
CameraAttitude DownOf(const CameraAttitude& attitude, const std::optional<PlanesEstimate>& floors);

// Both, with the objects of each on their own planes; parallel if they are to be.
PlanesEstimate JoinedPlanes(const PlanesEstimate& floors, const PlanesEstimate& ceilings,
                            bool parallel, const std::vector<std::optional<ShapePrior>>& priors);

}  // namespace soslam
