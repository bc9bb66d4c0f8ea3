// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"
#include "soslam/planes/options.h"
#include "soslam/planes/planes_estimate.h"
#include "soslam/planes/up_prior.h"

namespace soslam {

// Planes under the most probable camera orientation.
struct PlanesAndOrientation {
  PlanesEstimate estimate;
  Sequence level;  // the sequence with poses that have the same up everywhere
};

// Throws NothingUsableError: nothing tells where a plane is.
[[noreturn]] void ThrowNoPlane(const std::string& sequence);

// Finds the planes for each camera orientation in kCameraOrientations; returns the most probable
// result. `views`: per frame, with the segments among which vertical edges are searched; empty to
// not use vertical edges.
PlanesAndOrientation EstimatePlanesAndOrientation(
    const Sequence& sequence, const std::vector<SegmentView>& views,
    const std::vector<std::optional<ShapePrior>>& priors, const PlanesOptions& options,
    int threads);

}  // namespace soslam
