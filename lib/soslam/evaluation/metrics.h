// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/evaluation/held_out.h"
#include "soslam/evaluation/landmark_errors.h"
#include "soslam/evaluation/map_quality.h"
#include "soslam/model/estimates.h"
#include "soslam/model/metrics.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Single-frame estimates are compared in the frame of their camera, with the truth of that frame if
// there is one, so that trajectory errors have no effect; estimates over several frames in the
// world, without objects that move. Objects without ground truth or detections are left out. The
// trajectory error is computed for sequences of one segment only. `alignment` is that of
// map_quality.
Metrics EvaluateLandmarks(const Sequence& sequence, const LandmarkEstimates& estimates,
                          AlignmentKind alignment = AlignmentKind::kAuto);
Metrics EvaluateMap(const Sequence& sequence, const MapEstimate& map,
                    AlignmentKind alignment = AlignmentKind::kAuto);

}  // namespace soslam
