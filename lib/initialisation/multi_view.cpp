// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/multi_view.h"

#include "base/parallel.h"
#include "geometry/angles.h"
#include "initialisation/estimates_of_sequence.h"
#include "initialisation/fit_object.h"

namespace soslam {

LandmarkEstimates InitialiseMultiView(const Sequence& sequence,
                                      const std::vector<std::optional<ShapePrior>>& priors,
                                      const UprightOptions& options, double view_correlation_deg,
                                      int threads) {
  LandmarkEstimates estimates;
  const auto detections = DetectionsByObject(sequence);
  estimates.objects = DetectedObjects(sequence, detections);
  ParallelFor("objects", static_cast<int>(estimates.objects.size()), threads, [&](int i) {
    ObjectEstimate& object = estimates.objects[i];
    if (!object.failure.empty()) return;
    const auto index = static_cast<size_t>(object.object_index);
    ObjectEvidence evidence = EvidenceInWorld(sequence, detections[index], priors[index],
                                              options.detection_sigma_fraction);
    WeighViews(view_correlation_deg * kRadPerDeg, &evidence);
    evidence.axes_weight = options.axes_weight;
    const auto fits = FitObject(evidence, options.yaw_grid_deg * kRadPerDeg, 1);
    if (!fits.empty()) {
      object.landmark_in_world = fits.front().landmark;
    } else {
      object.failure = "not_determined_by_its_views";
    }
  });
  return estimates;
}

}  // namespace soslam
