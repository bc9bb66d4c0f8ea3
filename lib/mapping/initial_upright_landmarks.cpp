// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <compare>
#include <limits>
#include <map>

#include "base/parallel.h"
#include "geometry/angles.h"
#include "initialisation/multi_view.h"
#include "initialisation/upright.h"
#include "mapping/initial_landmarks.h"
#include "orientation/edge_alignment.h"
#include "orientation/texture_asymmetry.h"

namespace soslam {
namespace {

// Yaws closer than this lead to the same optimum.
constexpr double kYawBin = 6.0 * kRadPerDeg;
constexpr double kYawStep = 3.0 * kRadPerDeg;
constexpr size_t kMinViews = 2;
// Enough to see an object from all sides that it is seen from.
constexpr size_t kMaxViews = 16;
constexpr size_t kMaxCandidates = 12;
// Tangent depths and visible edges depend on the landmark: fitted twice.
constexpr int kRounds = 2;

// An object is in front of all cameras with a box of it: landmarks that are in more views come
// first.
struct FitCost {
  size_t views_behind;
  double cost;
  auto operator<=>(const FitCost&) const = default;  // NOLINT(modernize-use-nullptr): clang 14
};

struct Candidate {
  Landmark landmark_in_world;
  FitCost cost;
};

// Higher than that of any landmark.
constexpr FitCost kCostOfNone = {std::numeric_limits<size_t>::max(),
                                 std::numeric_limits<double>::infinity()};

// The cost of one object's landmark in the world over views of it, with constant poses.
class ObjectFit {
 public:
  // `views` index Sequence::detections. The prior is that of the object on one face.
  ObjectFit(const BackEndInput& input, size_t object_index, const std::vector<int>& views,
            const std::optional<ShapePrior>& prior, const OptimiseOptions& options)
      : input_(input),
        options_(options),
        object_index_(object_index),
        detections_(views),
        boxes_(MakeMultiViewObservation(input.sequence, views, prior,
                                        options.detection_sigma_fraction)) {
    WeighViews(options.view_correlation_deg * kRadPerDeg, &boxes_);
    boxes_.ratio_is_free = !options.ratio;
    boxes_.axes_weight = options.axes_weight;
    boxes_.huber_delta = options.huber_delta;
    for (size_t i = 0; i < detections_.size(); ++i) {
      const auto image = input.symmetry_images.find(detections_[i]);
      if (image == input.symmetry_images.end()) continue;
      textures_.push_back({i,
                           {*image->second, input.sequence.CameraOf(Of(i)), options.texture,
                            options.symmetry_options}});
    }
  }

  const MultiViewObservation& boxes() const { return boxes_; }

  // One for all landmarks (SizeForPoints).
  void SetPointSize(double size_m) { point_size_m_ = size_m; }

  std::optional<Candidate> IfCheaperThan(const FitCost& other,
                                         const Landmark& landmark_in_world) const {
    const auto behind = std::ranges::count_if(boxes_.views, [&](const BoxView& view) {
      return !IsInFront(Transform(view.camera_from_world, landmark_in_world));
    });
    FitCost cost{static_cast<size_t>(behind),
                 TotalCost(Terms(landmark_in_world), landmark_in_world)};
    for (const Texture& texture : textures_) {
      if (!(cost < other)) return std::nullopt;
      const BoxView& view = boxes_.views[texture.view];
      cost.cost += view.weight *
                   texture.asymmetry.Cost(Transform(view.camera_from_world, landmark_in_world));
    }
    return cost < other ? std::optional(Candidate{landmark_in_world, cost}) : std::nullopt;
  }

  std::optional<Landmark> Fit(const Landmark& start_in_world) const {
    const Plane& plane = boxes_.plane_in_world;
    Landmark landmark = start_in_world;
    for (int round = 0; round < kRounds; ++round) {
      const auto solution = FitUpright(plane, landmark, Terms(landmark), /*yaw_is_free=*/true);
      if (!solution) return std::nullopt;
      landmark = solution->landmark;
    }
    for (int round = 0; MayLean() && round < kRounds; ++round) {
      const auto solution = FitLeaning(plane, landmark, Terms(landmark));
      if (!solution) return std::nullopt;
      landmark = solution->landmark;
    }
    return landmark;
  }

 private:
  struct Texture {
    size_t view;
    TextureAsymmetry asymmetry;
  };

  const Detection& Of(size_t view) const { return input_.sequence.detections[detections_[view]]; }

  bool MayLean() const { return boxes_.prior && boxes_.prior->attitude == Attitude::kFree; }

  LandmarkCosts Terms(const Landmark& landmark_in_world) const {
    LandmarkCosts terms = ViewTerms(boxes_, landmark_in_world);
    if (MayLean()) {
      terms.push_back(std::make_unique<LeaningTerm>(
          boxes_.plane_in_world, StandingSigmas{.height_m = options_.standing_height_sigma_m}));
    }
    for (size_t i = 0; i < detections_.size(); ++i) {
      const BoxView& view = boxes_.views[i];
      const Landmark in_camera = Transform(view.camera_from_world, landmark_in_world);
      const auto image = input_.edge_images.find(detections_[i]);
      if (image == input_.edge_images.end() || !IsInFront(in_camera)) continue;
      terms.push_back(std::make_unique<ViewCost>(
          std::make_unique<EdgeCost>(image->second, input_.sequence.CameraOf(Of(i)), in_camera,
                                     options_.edges),
          view.camera_from_world, view.weight));
    }
    AddPoints(landmark_in_world, &terms);
    return terms;
  }

  void AddPoints(const Landmark& landmark_in_world, LandmarkCosts* terms) const {
    if (input_.points.empty()) return;
    const PointsOfObject& points = input_.points[object_index_];
    const double weight = PointWeight(points, options_.points);
    for (const PointsInView& view : points) {
      const Detection& detection = input_.sequence.detections[view.detection_index];
      const Rigid3d camera_from_world =
          input_.sequence.FrameOf(detection).world_from_camera.Inverse();
      const Landmark in_camera = Transform(camera_from_world, landmark_in_world);
      terms->push_back(std::make_unique<ViewCost>(
          std::make_unique<PointCost>(view.points, in_camera, point_size_m_, options_.points,
                                      weight),
          camera_from_world, 1.0));
    }
  }

  const BackEndInput& input_;
  const OptimiseOptions& options_;
  size_t object_index_;
  std::vector<int> detections_;
  MultiViewObservation boxes_;
  double point_size_m_ = 1.0;
  std::vector<Texture> textures_;
};

// The cheapest of each bin of yaw, cheapest first.
std::vector<Candidate> BestOfEachYaw(const std::vector<Landmark>& landmarks, const ObjectFit& fit) {
  std::map<long, Candidate> best;
  const double first_yaw = FirstYaw(fit.boxes());
  for (Landmark landmark : landmarks) {
    landmark.shape_exponents = fit.boxes().Exponents();  // whatever it was found with
    landmark.rests_on = fit.boxes().RestsOn();
    const double yaw = Yaw(fit.boxes().plane_in_world.normal, landmark.frame_from_object.rotation);
    const long bin = std::lround(YawDifferenceModuloPi(yaw, first_yaw) / kYawBin);
    const auto known = best.find(bin);
    const auto candidate =
        fit.IfCheaperThan(known == best.end() ? kCostOfNone : known->second.cost, landmark);
    if (candidate) best.insert_or_assign(bin, *candidate);
  }
  std::vector<Candidate> candidates;
  for (const auto& [bin, candidate] : best) candidates.push_back(candidate);
  std::ranges::stable_sort(candidates, {}, &Candidate::cost);
  candidates.resize(std::min(candidates.size(), kMaxCandidates));
  return candidates;
}

// `fits`: one for each face that the object may rest on. Hypotheses of any face are tried on all of
// them, as a body seen from few sides may be called by either name.
std::optional<Landmark> ChooseLandmark(std::vector<Landmark> hypotheses,
                                       std::vector<ObjectFit>* fits) {
  for (const ObjectFit& fit : *fits) {
    if (fit.boxes().views.size() < kMinViews) continue;
    for (const UprightSolution& solution : SweepViews(fit.boxes(), kYawStep)) {
      hypotheses.push_back(solution.landmark);
    }
  }
  if (hypotheses.empty()) return std::nullopt;
  const double point_size_m = SizeForPoints(hypotheses);
  std::optional<Candidate> best;
  for (ObjectFit& fit : *fits) {
    fit.SetPointSize(point_size_m);
    for (const Candidate& start : BestOfEachYaw(hypotheses, fit)) {
      const auto landmark = fit.Fit(start.landmark_in_world);
      if (!landmark) continue;
      const auto candidate = fit.IfCheaperThan(best ? best->cost : kCostOfNone, *landmark);
      if (candidate) best = candidate;
    }
  }
  return best ? std::optional(best->landmark_in_world) : std::nullopt;
}

}  // namespace

std::vector<std::optional<Landmark>> ChooseInitialUprightLandmarks(
    const BackEndInput& input, const LandmarkEstimates& estimates, const OptimiseOptions& options,
    int threads) {
  const Sequence& sequence = input.sequence;
  std::vector<std::vector<Landmark>> hypotheses = HypothesesByObject(sequence, estimates);
  for (const ObjectEstimate& object : estimates.objects) {
    if (!object.landmark_in_world) continue;
    hypotheses[object.object_index].push_back(*object.landmark_in_world);
  }
  const auto detections = DetectionsByObject(sequence);
  std::vector<std::optional<Landmark>> initial_landmarks(sequence.objects.size());
  ParallelFor("objects", static_cast<int>(initial_landmarks.size()), threads, [&](int index) {
    const auto i = static_cast<size_t>(index);
    if (detections[i].empty() || !sequence.objects[i].is_static) return;
    const std::vector<int> views = SpreadOver(detections[i], kMaxViews);
    std::vector<ObjectFit> fits;
    for (const auto& on_face : OnPossibleFaces(input.priors[i])) {
      fits.emplace_back(input, i, views, on_face, options);
    }
    initial_landmarks[i] = ChooseLandmark(hypotheses[i], &fits);
  });
  return initial_landmarks;
}

}  // namespace soslam
