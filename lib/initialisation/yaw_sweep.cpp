// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/yaw_sweep.h"

#include <limits>

#include "geometry/angles.h"
#include "initialisation/estimates_of_sequence.h"
#include "initialisation/fit_object.h"

namespace soslam {
namespace {

constexpr size_t kAllHypotheses = std::numeric_limits<size_t>::max();

std::vector<Hypothesis> HypothesesOf(const std::vector<ObjectFit>& fits) {
  std::vector<Hypothesis> hypotheses;
  for (const ObjectFit& fit : fits) hypotheses.push_back({fit.landmark, fit.cost.total});
  return hypotheses;
}

}  // namespace

LandmarkEstimates InitialiseUpright(const Sequence& sequence,
                                    const std::vector<std::optional<ShapePrior>>& priors,
                                    const UprightOptions& options, int threads,
                                    const std::vector<std::optional<YawPrior>>& yaw_priors,
                                    const PointsInFrames* points) {
  const auto estimator = [&](const ShapePrior& prior, int index) {
    const Detection& detection = sequence.detections[index];
    ObjectEvidence evidence =
        EvidenceInCamera(sequence, detection, prior, options.detection_sigma_fraction);
    evidence.axes_weight = options.axes_weight;
    if (!yaw_priors.empty()) evidence.yaw_prior = yaw_priors[index];
    const double yaw_step = options.yaw_grid_deg * kRadPerDeg;
    ObservationEstimate estimate;
    estimate.hypotheses = HypothesesOf(FitObject(evidence, yaw_step, kAllHypotheses));
    const auto of_points = points ? points->Of(index, estimate.hypotheses) : std::nullopt;
    if (of_points) {
      evidence.further = {InCamera(*of_points)};
      estimate.hypotheses = HypothesesOf(FitObject(evidence, yaw_step, kAllHypotheses));
    }
    if (estimate.hypotheses.empty()) estimate.failure = WhyNoSolution(evidence);
    return estimate;
  };
  return EstimateObservations(sequence, priors, threads, estimator);
}

}  // namespace soslam
