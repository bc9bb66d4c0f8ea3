// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/mapping/initial_landmarks.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <memory>
#include <numbers>
#include <utility>

#include "soslam/base/parallel.h"
#include "soslam/base/upper_median.h"
#include "soslam/geometry/angles.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/initialisation/points_in_frames.h"
#include "soslam/mapping/check_input.h"

namespace soslam {
namespace {

// Yaws closer than this lead to the same optimum.
constexpr double kYawBin = 6.0 * kRadPerDeg;
constexpr double kYawStep = 3.0 * kRadPerDeg;
constexpr size_t kMinViews = 2;
// Most views of an object that its initial landmark is fitted to. Images and points are slow to
// fit: enough to see it from all sides that it is seen from. Boxes alone are bounded for long
// sequences, as the hypotheses of all single frames are compared in each view.
constexpr size_t kMaxViewsWithImages = 16;
constexpr size_t kMaxViewsOfBoxes = 500;
constexpr size_t kMaxCandidates = 12;
constexpr size_t kAllMinima = std::numeric_limits<size_t>::max();

// The evidence for an object in the world, from views of it (indices in Sequence::detections), with
// constant poses. Keeps references to its arguments.
ObjectEvidence EvidenceOfViews(const BackEndInput& input, size_t object_index,
                               const std::vector<int>& views, const OptimiseOptions& options) {
  const Sequence& sequence = input.sequence;
  ObjectEvidence evidence =
      EvidenceInWorld(sequence, views, input.priors[object_index], options.upright);
  WeighViews(options.upright.ViewCorrelation(), &evidence);
  evidence.ratio_is_free = !options.ratio;
  evidence.standing.height_m = options.standing_height_sigma_m;
  std::vector<std::pair<BoxView, std::shared_ptr<const ImageEvidence>>> compared;
  for (const auto& [index, image] : input.images) {
    const auto at = std::ranges::find(views, index);
    if (at == views.end()) continue;
    const BoxView& view = evidence.views[at - views.begin()];
    compared.emplace_back(view, image);
    evidence.further.push_back(
        {[&image = *image](const Landmark& in_camera) { return image.CostNear(in_camera); },
         view.camera_from_reference, view.weight});
  }
  if (!compared.empty()) {
    evidence.compared_cost = [compared](const Landmark& landmark, double limit) {
      double cost = 0.0;
      for (const auto& [view, image] : compared) {
        if (!(cost < limit)) break;
        cost += view.weight * image->ComparedCost(Transform(view.camera_from_reference, landmark));
      }
      return cost;
    };
  }
  return evidence;
}

// The cheapest of each bin of yaw, cheapest first.
std::vector<Landmark> BestOfEachYaw(const std::vector<Landmark>& landmarks,
                                    const ObjectEvidence& evidence) {
  std::map<long, std::pair<double, Landmark>> best;
  for (Landmark landmark : landmarks) {
    landmark.shape_exponents = evidence.Exponents();  // whatever it was found with
    landmark.rests_on = evidence.RestsOn();
    const double yaw = Yaw(evidence.plane.normal, landmark.frame_from_object.rotation);
    const long bin = std::lround(YawDifferenceModuloPi(yaw, FirstYaw(evidence)) / kYawBin);
    const auto known = best.find(bin);
    const double limit =
        known == best.end() ? std::numeric_limits<double>::infinity() : known->second.first;
    const double cost = EvaluateCost(evidence, landmark, limit).total;
    if (cost < limit) best.insert_or_assign(bin, std::pair(cost, landmark));
  }
  std::vector<std::pair<double, Landmark>> candidates;
  for (const auto& [bin, candidate] : best) candidates.push_back(candidate);
  std::ranges::stable_sort(candidates, {}, &std::pair<double, Landmark>::first);
  candidates.resize(std::min(candidates.size(), kMaxCandidates));
  std::vector<Landmark> starts;
  for (const auto& [cost, landmark] : candidates) starts.push_back(landmark);
  return starts;
}

// Hypotheses of any face are tried on all faces that the object may rest on, as a body seen from
// few sides may be called by either name.
std::optional<Landmark> ChooseLandmark(const BackEndInput& input, size_t object_index,
                                       const std::vector<int>& views,
                                       std::vector<Landmark> hypotheses,
                                       const OptimiseOptions& options) {
  const ObjectEvidence evidence = EvidenceOfViews(input, object_index, views, options);
  std::vector<ObjectEvidence> on_faces = OnEachFace(evidence);
  for (const ObjectEvidence& on_face : on_faces) {
    if (views.size() < kMinViews) continue;
    ObjectEvidence boxes = on_face;
    boxes.further.clear();
    boxes.compared_cost = nullptr;
    std::ranges::copy(ProfileOverYaw(boxes, kYawStep).Minima(kAllMinima),
                      std::back_inserter(hypotheses));
  }
  if (hypotheses.empty()) return std::nullopt;
  const double point_size_m = SizeForPoints(hypotheses);
  std::vector<std::vector<ObjectFit>> fits;
  for (ObjectEvidence& on_face : on_faces) {
    if (!input.points.empty()) {
      const PointsOfObject& points = input.points[object_index];
      for (const PointsInView& view : points) {
        on_face.further.push_back(InCamera(
            {view.points, point_size_m, PointWeight(points, options.points), options.points}));
        on_face.further.back().camera_from_reference =
            input.sequence.FrameOf(input.sequence.detections[view.detection_index])
                .world_from_camera.Inverse();
      }
    }
    fits.push_back(FitObject(on_face, BestOfEachYaw(hypotheses, on_face), {}));
    if (fits.back().empty()) continue;
    // The body a quarter turn on, and the same body called by its other horizontal axis.
    const Landmark turned = RotatedAboutZ(fits.back().front().landmark, 0.5 * std::numbers::pi);
    Landmark renamed = turned;
    std::swap(renamed.half_axes.x(), renamed.half_axes.y());
    fits.push_back(FitObject(on_face, {turned, renamed}, {}));
  }
  const auto best = MergeFits(std::move(fits), 1);
  return best.empty() ? std::nullopt : std::optional(best.front().landmark);
}

}  // namespace

std::vector<std::vector<Landmark>> HypothesesByObject(const Sequence& sequence,
                                                      const LandmarkEstimates& estimates) {
  std::vector<std::vector<Landmark>> hypotheses(sequence.objects.size());
  for (const ObservationEstimate& observation : estimates.observations) {
    const Detection& detection = sequence.detections[observation.detection_index];
    const Rigid3d& world_from_camera = sequence.FrameOf(detection).world_from_camera;
    for (const Hypothesis& hypothesis : observation.hypotheses) {
      hypotheses[detection.object_index].push_back(
          Transform(world_from_camera, hypothesis.landmark_in_camera));
    }
  }
  return hypotheses;
}

std::vector<std::optional<Landmark>> ChooseInitialLandmarks(const Sequence& sequence,
                                                            const LandmarkEstimates& estimates) {
  const auto detections = DetectionsByObject(sequence);
  const auto hypotheses = HypothesesByObject(sequence, estimates);
  std::vector<std::optional<Landmark>> initial_landmarks(sequence.objects.size());
  for (size_t i = 0; i < hypotheses.size(); ++i) {
    if (!sequence.objects[i].is_static) continue;
    double least = std::numeric_limits<double>::infinity();
    for (const Landmark& landmark : hypotheses[i]) {
      // Between box and outline, large where the outline does not exist.
      std::vector<double> distances;
      for (const int index : detections[i]) {
        const Detection& detection = sequence.detections[index];
        const Frame& frame = sequence.FrameOf(detection);
        distances.push_back(OutlineEdgeRms(sequence.CameraOf(frame),
                                           Transform(frame.world_from_camera.Inverse(), landmark),
                                           detection.box));
      }
      const double distance = UpperMedian(std::move(distances));
      if (initial_landmarks[i] && !(distance < least)) continue;
      initial_landmarks[i] = landmark;
      least = distance;
    }
  }
  for (const ObjectEstimate& object : estimates.objects) {
    if (object.landmark_in_world) {
      initial_landmarks[object.object_index] = object.landmark_in_world;
    }
  }
  for (auto& landmark : initial_landmarks) {
    if (landmark) landmark->shape_exponents = kEllipsoidExponent;
  }
  return initial_landmarks;
}

std::vector<std::optional<Landmark>> ChooseInitialUprightLandmarks(
    const BackEndInput& input, const LandmarkEstimates& estimates, const OptimiseOptions& options,
    int threads) {
  const Sequence& sequence = input.sequence;
  CheckBackEndInput(input, options);
  std::vector<std::vector<Landmark>> hypotheses = HypothesesByObject(sequence, estimates);
  for (const ObjectEstimate& object : estimates.objects) {
    if (!object.landmark_in_world) continue;
    hypotheses[object.object_index].push_back(*object.landmark_in_world);
  }
  const auto detections = DetectionsByObject(sequence);
  const bool has_boxes_alone = input.images.empty() && input.points.empty();
  const size_t max_views = has_boxes_alone ? kMaxViewsOfBoxes : kMaxViewsWithImages;
  std::vector<std::optional<Landmark>> initial_landmarks(sequence.objects.size());
  ParallelFor("objects", initial_landmarks.size(), threads, [&](size_t i) {
    if (detections[i].empty() || !sequence.objects[i].is_static) return;
    const std::vector<int> views = SpreadOver(detections[i], max_views);
    initial_landmarks[i] = ChooseLandmark(input, i, views, std::move(hypotheses[i]), options);
  });
  return initial_landmarks;
}

}  // namespace soslam
