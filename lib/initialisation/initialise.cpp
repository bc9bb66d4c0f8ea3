// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/initialise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "geometry/angles.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "initialisation/cuboid_proposals.h"
#include "initialisation/cuboid_score.h"
#include "initialisation/fit_object.h"
#include "initialisation/object_evidence.h"
#include "initialisation/single_frame.h"
#include "initialisation/svd.h"

namespace soslam {
namespace {

constexpr size_t kMinViews = 3;
constexpr size_t kAllHypotheses = std::numeric_limits<size_t>::max();

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

// The detected objects, still without landmarks; those that move have failed.
std::vector<ObjectEstimate> DetectedObjects(const Sequence& sequence,
                                            const std::vector<std::vector<int>>& detections) {
  std::vector<ObjectEstimate> objects;
  for (size_t i = 0; i < detections.size(); ++i) {
    if (detections[i].empty()) continue;
    ObjectEstimate object;
    object.object_index = static_cast<int>(i);
    object.observations = static_cast<int>(detections[i].size());
    if (!sequence.objects[i].is_static) object.failure = kMovingObject;
    objects.push_back(object);
  }
  return objects;
}

std::vector<Plane> TangentPlanesInWorld(const Sequence& sequence,
                                        const std::vector<int>& detections) {
  std::vector<Plane> planes;
  for (const int index : detections) {
    const Detection& detection = sequence.detections[index];
    const Frame& frame = sequence.frames[detection.frame_index];
    for (const Eigen::Vector3d& line : detection.box.EdgeLines()) {
      planes.push_back(
          Transform(frame.world_from_camera, sequence.CameraOf(frame).BackProject(line)));
    }
  }
  return planes;
}

std::vector<Hypothesis> HypothesesOf(const std::vector<ObjectFit>& fits) {
  std::vector<Hypothesis> hypotheses;
  for (const ObjectFit& fit : fits) hypotheses.push_back({fit.landmark, fit.cost.total});
  return hypotheses;
}

}  // namespace

LandmarkEstimates InitialiseSingleFrame(const Sequence& sequence,
                                        const std::vector<std::optional<Eigen::Vector2d>>& ratios,
                                        const InitialiseOptions& options, int threads) {
  const auto estimator = [&](const Eigen::Vector2d& ratio, int index) {
    const Detection& detection = sequence.detections[index];
    return InitialiseFromSingleFrame(
        {sequence.CameraOf(detection), detection.box, detection.plane_in_camera, ratio,
         SceneAxisInCamera(sequence, detection)},
        options);
  };
  return EstimateObservations(sequence, ratios, threads, estimator);
}

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

LandmarkEstimates InitialiseMultiView(const Sequence& sequence,
                                      const std::vector<std::optional<ShapePrior>>& priors,
                                      const InitialiseOptions& options, int threads) {
  LandmarkEstimates estimates;
  const auto detections = DetectionsByObject(sequence);
  estimates.objects = DetectedObjects(sequence, detections);
  ParallelFor("objects", static_cast<int>(estimates.objects.size()), threads, [&](int i) {
    ObjectEstimate& object = estimates.objects[i];
    if (!object.failure.empty()) return;
    const auto index = static_cast<size_t>(object.object_index);
    ObjectEvidence evidence = EvidenceInWorld(sequence, detections[index], priors[index],
                                              options.upright.detection_sigma_fraction);
    WeighViews(options.view_correlation_deg * kRadPerDeg, &evidence);
    evidence.axes_weight = options.upright.axes_weight;
    const auto fits = FitObject(evidence, options.upright.yaw_grid_deg * kRadPerDeg, 1);
    if (!fits.empty()) {
      object.landmark_in_world = fits.front().landmark;
    } else {
      object.failure = "not_determined_by_its_views";
    }
  });
  return estimates;
}

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

LandmarkEstimates InitialiseSvd(const Sequence& sequence) {
  LandmarkEstimates estimates;
  const auto detections = DetectionsByObject(sequence);
  estimates.objects = DetectedObjects(sequence, detections);
  for (ObjectEstimate& object : estimates.objects) {
    if (!object.failure.empty()) continue;
    const std::vector<int>& own = detections[static_cast<size_t>(object.object_index)];
    if (own.size() < kMinViews) {
      object.failure = "fewer_than_three_views";
    } else if (const auto found = LandmarkFromTangentPlanes(TangentPlanesInWorld(sequence, own))) {
      object.landmark_in_world = found->landmark;
      object.proper_ellipsoid = found->proper;
    } else {
      object.failure = "no_finite_quadric";
    }
  }
  return estimates;
}

}  // namespace soslam
