// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <compare>
#include <numbers>

#include "initialisation/upright.h"
#include "mapping/choose_starts.h"
#include "mapping/view_weights.h"
#include "orientation/edge_alignment.h"
#include "orientation/texture_asymmetry.h"

namespace soslam {
namespace {

// Yaws closer than this lead to the same optimum.
constexpr double kYawBin = 6.0 * std::numbers::pi / 180.0;
// Enough to see an object from all sides that it is seen from.
constexpr size_t kMaxViews = 16;
constexpr size_t kMaxCandidates = 12;
// Tangent depths and visible edges depend on the landmark: fitted twice.
constexpr int kRounds = 2;

// What its box shows is in front of a camera: of two landmarks, first the one that is in more
// views.
struct FitCost {
  size_t views_behind;
  double cost;
  auto operator<=>(const FitCost&) const = default;
};

struct Candidate {
  Landmark landmark_in_world;
  FitCost cost;
};

// The cost of one object's landmark in the world over views of it, camera poses held.
class ObjectFit {
 public:
  ObjectFit(const BackEndInput& input, size_t object_index, const std::vector<int>& detections,
            const OptimiseOptions& options)
      : input_(input), prior_(input.priors[object_index]), options_(options) {
    const size_t views = std::min(kMaxViews, detections.size());
    for (size_t i = 0; i < views; ++i) views_.push_back(detections[i * detections.size() / views]);
    const Object& object = input.sequence.objects[object_index];
    plane_ = input.sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world;
  }

  const Plane& plane_in_world() const { return plane_; }

  FitCost Cost(const Landmark& landmark_in_world) const {
    const auto behind = std::count_if(views_.begin(), views_.end(), [&](int view) {
      return !IsInFront(InCamera(view, landmark_in_world));
    });
    double cost = 0.0;
    for (const auto& term : Terms(landmark_in_world)) {
      Eigen::VectorXd residuals(term->NumResiduals());
      term->Evaluate(landmark_in_world, residuals, nullptr);
      cost += 0.5 * residuals.squaredNorm();
    }
    cost += TextureCost(landmark_in_world);
    return {static_cast<size_t>(behind), cost};
  }

  std::optional<Candidate> Fit(const Landmark& start_in_world) const {
    Landmark landmark = start_in_world;
    for (int round = 0; round < kRounds; ++round) {
      const auto solution = FitUpright(plane_, landmark, Terms(landmark), /*yaw_is_free=*/true);
      if (!solution) return std::nullopt;
      landmark = solution->landmark_in_camera;
    }
    return Candidate{landmark, Cost(landmark)};
  }

 private:
  const Detection& DetectionOf(int view) const {
    return input_.sequence.detections[static_cast<size_t>(view)];
  }
  Rigid3d CameraFromWorld(int view) const {
    const auto frame = static_cast<size_t>(DetectionOf(view).frame_index);
    return input_.sequence.frames[frame].world_from_camera.Inverse();
  }
  Landmark InCamera(int view, const Landmark& landmark_in_world) const {
    return Transform(CameraFromWorld(view), landmark_in_world);
  }

  std::vector<double> Weights(const Landmark& landmark_in_world) const {
    return ViewWeights(input_.sequence, views_, landmark_in_world.Centre(),
                       options_.view_correlation_deg * std::numbers::pi / 180.0);
  }

  LandmarkTerms Terms(const Landmark& landmark_in_world) const {
    LandmarkTerms terms;
    if (prior_) terms.push_back(std::make_unique<RatioTerm>(*prior_));
    terms.push_back(std::make_unique<AxisTerm>(plane_, WorldAxis(plane_), options_.axes_weight));
    const std::vector<double> weights = Weights(landmark_in_world);
    for (size_t i = 0; i < views_.size(); ++i) {
      const Landmark in_camera = InCamera(views_[i], landmark_in_world);
      if (!IsInFront(in_camera)) continue;
      const auto add = [&](std::unique_ptr<const LandmarkTerm> term) {
        terms.push_back(std::make_unique<RobustViewTerm>(
            std::move(term), CameraFromWorld(views_[i]), options_.huber_delta, weights[i]));
      };
      const Camera& camera = input_.sequence.camera;
      const Detection& detection = DetectionOf(views_[i]);
      add(std::make_unique<BoxTerm>(
          BoxEdges(camera, detection.box, detection.is_bound, options_.detection_sigma_fraction),
          in_camera));
      const auto image = input_.edge_images.find(views_[i]);
      if (image != input_.edge_images.end()) {
        add(std::make_unique<EdgeTerm>(*image->second, camera, in_camera, options_.edges));
      }
    }
    return terms;
  }

  double TextureCost(const Landmark& landmark_in_world) const {
    const std::vector<double> weights = Weights(landmark_in_world);
    double cost = 0.0;
    for (size_t i = 0; i < views_.size(); ++i) {
      const auto image = input_.symmetry_images.find(views_[i]);
      if (image == input_.symmetry_images.end()) continue;
      cost += weights[i] * AsymmetryCost(*image->second, input_.sequence.camera,
                                         DetectionOf(views_[i]).box,
                                         InCamera(views_[i], landmark_in_world), options_.texture,
                                         options_.symmetry_options);
    }
    return cost;
  }

  const BackEndInput& input_;
  const std::optional<ShapePrior>& prior_;
  const OptimiseOptions& options_;
  std::vector<int> views_;
  Plane plane_;
};

// The cheapest of each bin of yaw, cheapest first.
std::vector<Candidate> BestOfEachYaw(const ObjectFit& fit, const std::vector<Landmark>& landmarks) {
  std::map<long, Candidate> best;
  for (const Landmark& landmark : landmarks) {
    const double yaw = Yaw(fit.plane_in_world().normal, landmark.frame_from_object.rotation);
    const long bin = std::lround(YawDifferenceModuloPi(yaw, 0.0) / kYawBin);
    const Candidate candidate{landmark, fit.Cost(landmark)};
    const auto [found, is_new] = best.emplace(bin, candidate);
    if (!is_new && candidate.cost < found->second.cost) found->second = candidate;
  }
  std::vector<Candidate> candidates;
  for (const auto& [bin, candidate] : best) candidates.push_back(candidate);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& one, const auto& other) { return one.cost < other.cost; });
  candidates.resize(std::min(candidates.size(), kMaxCandidates));
  return candidates;
}

}  // namespace

std::vector<std::optional<Landmark>> ChooseUprightStarts(const BackEndInput& input,
                                                         const LandmarkEstimates& estimates,
                                                         const OptimiseOptions& options) {
  const Sequence& sequence = input.sequence;
  std::vector<std::vector<Landmark>> hypotheses(sequence.objects.size());
  for (const ObservationEstimate& observation : estimates.observations) {
    const Detection& detection =
        sequence.detections[static_cast<size_t>(observation.detection_index)];
    const Frame& frame = sequence.frames[static_cast<size_t>(detection.frame_index)];
    for (const Hypothesis& hypothesis : observation.hypotheses) {
      hypotheses[static_cast<size_t>(detection.object_index)].push_back(
          Transform(frame.world_from_camera, hypothesis.landmark_in_camera));
    }
  }
  const auto detections = DetectionsByObject(sequence);
  std::vector<std::optional<Landmark>> starts(sequence.objects.size());
  for (size_t i = 0; i < starts.size(); ++i) {
    if (hypotheses[i].empty()) continue;
    const ObjectFit fit(input, i, detections[i], options);
    std::optional<Candidate> best;
    for (const Candidate& candidate : BestOfEachYaw(fit, hypotheses[i])) {
      const auto solution = fit.Fit(candidate.landmark_in_world);
      if (solution && (!best || solution->cost < best->cost)) best = solution;
    }
    if (best) starts[i] = best->landmark_in_world;
  }
  return starts;
}

}  // namespace soslam
