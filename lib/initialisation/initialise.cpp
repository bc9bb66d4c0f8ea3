// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/initialise.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "geometry/angles.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "initialisation/cuboid_proposals.h"
#include "initialisation/cuboid_score.h"
#include "initialisation/multi_view.h"
#include "initialisation/single_frame.h"
#include "initialisation/svd.h"
#include "initialisation/yaw_sweep.h"

namespace soslam {
namespace {

constexpr size_t kMinViews = 3;

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

// All local optima of the sweeps over yaw of one observation, on each face that the object may rest
// on, lowest cost first.
std::vector<Hypothesis> SweepFaces(const std::vector<UprightObservation>& on_faces,
                                   double yaw_step) {
  std::vector<Hypothesis> hypotheses;
  const YawObjective objective;
  for (const UprightObservation& observation : on_faces) {
    const YawSweep sweep = SweepYaw(observation, objective, yaw_step);
    for (const UprightSolution& optimum :
         LocalOptima(observation, objective, sweep, sweep.yaw.size())) {
      hypotheses.push_back({optimum.landmark, optimum.cost});
    }
  }
  std::ranges::stable_sort(hypotheses, {},
                           [](const Hypothesis& one) { return RankOfCost(one.cost); });
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
    ObservationEstimate estimate;
    std::vector<UprightObservation> on_faces;
    for (const auto& on_face : OnPossibleFaces(prior)) {
      on_faces.push_back(MakeUprightObservation(sequence, detection, *on_face, options));
      if (!yaw_priors.empty()) on_faces.back().yaw_prior = yaw_priors[index];
    }
    const double yaw_step = options.yaw_grid_deg * kRadPerDeg;
    estimate.hypotheses = SweepFaces(on_faces, yaw_step);
    const auto evidence = points ? points->Of(index, estimate.hypotheses) : std::nullopt;
    if (evidence) {
      for (UprightObservation& on_face : on_faces) on_face.points = evidence;
      estimate.hypotheses = SweepFaces(on_faces, yaw_step);
    }
    if (estimate.hypotheses.empty()) estimate.failure = WhyNoSolution(on_faces.back());
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
    MultiViewObservation observation = MakeMultiViewObservation(
        sequence, detections[index], priors[index], options.upright.detection_sigma_fraction);
    WeighViews(options.view_correlation_deg * kRadPerDeg, &observation);
    observation.axes_weight = options.upright.axes_weight;
    std::optional<UprightSolution> best;
    for (const auto& on_face : OnPossibleFaces(priors[index])) {
      observation.prior = on_face;
      const auto found = SolveViews(observation, options.upright.yaw_grid_deg * kRadPerDeg);
      if (found && (!best || found->cost < best->cost)) best = found;
    }
    if (best) {
      object.landmark_in_world = best->landmark;
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
