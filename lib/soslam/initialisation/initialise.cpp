// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/initialise.h"

#include <limits>

#include "soslam/base/parallel.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/initialisation/svd.h"

namespace soslam {
namespace {

constexpr size_t kAllHypotheses = std::numeric_limits<size_t>::max();
constexpr size_t kMinViewsOfSvd = 3;

// An estimate per detection, each from the value of its object; a failure where that has none.
template <typename Value, typename Estimator>
LandmarkEstimates EstimateObservations(const Sequence& sequence,
                                       const std::vector<std::optional<Value>>& of_objects,
                                       int threads, const Estimator& estimator) {
  LandmarkEstimates estimates;
  estimates.observations.resize(sequence.detections.size());
  ParallelFor("detections", sequence.detections.size(), threads, [&](size_t i) {
    ObservationEstimate& estimate = estimates.observations[i];
    const auto& value = of_objects[sequence.detections[i].object_index];
    if (value) {
      estimate = estimator(*value, i);
    } else {
      estimate.failure = "no_ratio_for_label";
    }
    estimate.detection_index = static_cast<int>(i);
  });
  return estimates;
}

// The detected objects, still without landmarks; those that move have failed. `detections`: see
// DetectionsByObject.
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

std::vector<Hypothesis> UprightHypotheses(const ObjectEvidence& evidence,
                                          const UprightOptions& options) {
  std::vector<Hypothesis> hypotheses;
  for (const ObjectFit& fit : FitObject(evidence, options.YawStep(), kAllHypotheses)) {
    hypotheses.push_back({fit.landmark, fit.cost.total});
  }
  return hypotheses;
}

}  // namespace

LandmarkEstimates InitialiseSingleFrame(const Sequence& sequence,
                                        const std::vector<std::optional<Eigen::Vector2d>>& ratios,
                                        const SingleFrameOptions& options, int threads) {
  const auto estimator = [&](const Eigen::Vector2d& ratio, size_t index) {
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
  const auto estimator = [&](const ShapePrior& prior, size_t index) {
    const Detection& detection = sequence.detections[index];
    ObjectEvidence evidence = EvidenceInCamera(sequence, detection, prior, options);
    if (!yaw_priors.empty()) evidence.yaw_prior = yaw_priors[index];
    ObservationEstimate estimate;
    estimate.hypotheses = UprightHypotheses(evidence, options);
    const auto of_points =
        points ? points->Of(static_cast<int>(index), estimate.hypotheses) : std::nullopt;
    if (of_points) {
      evidence.further = {InCamera(*of_points)};
      estimate.hypotheses = UprightHypotheses(evidence, options);
    }
    if (estimate.hypotheses.empty()) estimate.failure = WhyNoSolution(evidence);
    return estimate;
  };
  return EstimateObservations(sequence, priors, threads, estimator);
}

LandmarkEstimates InitialiseMultiView(const Sequence& sequence,
                                      const std::vector<std::optional<ShapePrior>>& priors,
                                      const UprightOptions& options, int threads) {
  LandmarkEstimates estimates;
  const auto detections = DetectionsByObject(sequence);
  estimates.objects = DetectedObjects(sequence, detections);
  ParallelFor("objects", estimates.objects.size(), threads, [&](size_t i) {
    ObjectEstimate& object = estimates.objects[i];
    if (!object.failure.empty()) return;
    const int index = object.object_index;
    ObjectEvidence evidence = EvidenceInWorld(sequence, detections[index], priors[index], options);
    WeighViews(options.ViewCorrelation(), &evidence);
    const auto fits = FitObject(evidence, options.YawStep(), 1);
    if (!fits.empty()) {
      object.landmark_in_world = fits.front().landmark;
    } else {
      object.failure = "not_determined_by_its_views";
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
    const std::vector<int>& own = detections[object.object_index];
    std::vector<Plane> planes_in_world;
    for (const int index : own) {
      const Detection& detection = sequence.detections[index];
      const Frame& frame = sequence.FrameOf(detection);
      for (const Eigen::Vector3d& line : detection.box.EdgeLines()) {
        planes_in_world.push_back(
            Transform(frame.world_from_camera, sequence.CameraOf(frame).BackProject(line)));
      }
    }
    if (own.size() < kMinViewsOfSvd) {
      object.failure = "fewer_than_three_views";
    } else if (const auto found = LandmarkFromTangentPlanes(planes_in_world)) {
      object.landmark_in_world = found->landmark;
      object.proper_ellipsoid = found->proper;
    } else {
      object.failure = "no_finite_quadric";
    }
  }
  return estimates;
}

}  // namespace soslam
