// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "base/parallel.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// An estimate per detection, each from the value of its object; a failure where that has none.
template <typename Value, typename Estimator>
LandmarkEstimates EstimateObservations(const Sequence& sequence,
                                       const std::vector<std::optional<Value>>& of_objects,
                                       int threads, const Estimator& estimator) {
  LandmarkEstimates estimates;
  estimates.observations.resize(sequence.detections.size());
  ParallelFor("detections", static_cast<int>(sequence.detections.size()), threads, [&](int i) {
    ObservationEstimate& estimate = estimates.observations[i];
    const auto& value = of_objects[sequence.detections[i].object_index];
    if (value) {
      estimate = estimator(*value, i);
    } else {
      estimate.failure = "no_ratio_for_label";
    }
    estimate.detection_index = i;
  });
  return estimates;
}

// The detected objects, still without landmarks; those that move have failed. `detections`: see
// DetectionsByObject.
std::vector<ObjectEstimate> DetectedObjects(const Sequence& sequence,
                                            const std::vector<std::vector<int>>& detections);

}  // namespace soslam
