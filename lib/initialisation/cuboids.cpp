// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/cuboids.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.h"
#include "initialisation/cuboid_proposals.h"

namespace soslam {
namespace {

// The best proposal at each yaw, lowest cost first.
std::vector<Hypothesis> BestCuboids(const CuboidView& view, const CuboidEvidence& evidence,
                                    const CuboidOptions& options) {
  const auto proposals = ProposeCuboids(view, options.yaw_samples, options.corner_samples);
  std::vector<CuboidErrors> errors;
  for (const CuboidProposal& proposal : proposals) {
    errors.push_back(ErrorsOf(view, proposal.landmark_in_camera, evidence, options));
  }
  const std::vector<double> costs = CuboidCosts(errors, options);
  std::vector<Hypothesis> best;
  for (size_t i = 0; i < proposals.size(); ++i) {
    const Hypothesis hypothesis = {proposals[i].landmark_in_camera, costs[i]};
    if (i == 0 || proposals[i].yaw != proposals[i - 1].yaw) {
      best.push_back(hypothesis);
    } else if (hypothesis.cost < best.back().cost) {
      best.back() = hypothesis;
    }
  }
  std::ranges::stable_sort(best, {}, &Hypothesis::cost);
  return best;
}

}  // namespace

LandmarkEstimates InitialiseCuboids(const Sequence& sequence,
                                    const std::function<EdgeMaps(const Frame&)>& edges_of,
                                    const CuboidOptions& options, int threads) {
  LandmarkEstimates estimates;
  estimates.observations.resize(sequence.detections.size());
  std::vector<std::vector<int>> of_frame(sequence.frames.size());  // indices of detections
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    of_frame[sequence.detections[i].frame_index].push_back(static_cast<int>(i));
  }
  ParallelFor("frames", static_cast<int>(of_frame.size()), threads, [&](int frame_index) {
    if (of_frame[frame_index].empty()) return;
    const Frame& frame = sequence.frames[frame_index];
    const EdgeMaps maps = frame.image.empty() ? EdgeMaps() : edges_of(frame);
    for (const int i : of_frame[frame_index]) {
      const Detection& detection = sequence.detections[i];
      ObservationEstimate& estimate = estimates.observations[i];
      estimate.detection_index = i;
      if (maps.distance.empty()) {
        estimate.failure = "frame_without_image";
      } else if (!std::isfinite(maps.distance.at<float>(0, 0))) {
        estimate.failure = "no_edges";
      } else {
        estimate.hypotheses =
            BestCuboids({sequence.CameraOf(detection), detection.box, detection.plane_in_camera},
                        EvidenceInBox(maps, detection.box, options.min_segment_fraction), options);
        if (estimate.hypotheses.empty()) estimate.failure = "no_solution";
      }
    }
  });
  return estimates;
}

}  // namespace soslam
