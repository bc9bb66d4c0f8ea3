// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/refine_by_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "geometry/angles.h"
#include "geometry/landmark.h"
#include "initialisation/fit_object.h"
#include "initialisation/object_points.h"
#include "initialisation/yaw_prior.h"
#include "model/occlusion.h"
#include "orientation/refine_by_turning.h"
#include "orientation/texture_asymmetry.h"

namespace soslam {
namespace {

// Further hypotheses are far less likely.
constexpr size_t kMaxHypotheses = 6;

// The orientation profile of an object that rests on one face.
class OrientationProfile {
 public:
  OrientationProfile(const Sequence& sequence, const Detection& detection,
                     const std::shared_ptr<const FrameEdges>& edges, const ShapePrior& prior,
                     const ProfileOptions& options, const SymmetryOptions& symmetry_options,
                     const std::optional<PointEvidence>& points)
      : options_(options),
        symmetry_options_(symmetry_options),
        camera_(sequence.CameraOf(detection)),
        symmetry_image_(edges->maps, detection.box),
        asymmetry_(symmetry_image_, camera_, options.texture, symmetry_options),
        evidence_(EvidenceInCamera(sequence, detection, prior,
                                   options.upright.detection_sigma_fraction)) {
    evidence_.axes_weight = options.upright.axes_weight;
    if (points) evidence_.further.push_back(InCamera(*points));
    if (options.edge_alignment) {
      const auto image = std::make_shared<const EdgeImage>(
          EdgeImage{edges, detection.box, BoxesInFront(sequence, detection)});
      evidence_.further.push_back({[this, image](const Landmark& in_camera) {
                                     return std::make_unique<EdgeCost>(image, camera_, in_camera,
                                                                       options_.edges);
                                   },
                                   Rigid3d()});
    }
    if (options.texture_symmetry) {
      evidence_.compared_cost = [this](const Landmark& landmark, double /*limit*/) {
        return asymmetry_.Cost(landmark);
      };
    }
  }
  OrientationProfile(const OrientationProfile&) = delete;
  OrientationProfile& operator=(const OrientationProfile&) = delete;

  // Without the observation's place in the sequence.
  RefinedObservation Refine() const {
    RefinedObservation result;
    const YawProfile profile =
        ProfileOverYaw(evidence_, options_.upright.yaw_grid_deg * kRadPerDeg);
    std::vector<YawProfile::Optimum> optima;
    for (const ObjectFit& fit :
         FitObject(evidence_, profile.Minima(kMaxHypotheses), {kMaxHypotheses, profile.Step()})) {
      result.estimate.hypotheses.push_back({fit.landmark, fit.cost.total});
      optima.push_back({YawOf(fit.landmark), fit.cost.total});
    }
    if (result.estimate.hypotheses.empty()) {
      result.estimate.failure = WhyNoSolution(evidence_);
      return result;
    }
    const Landmark& best = result.estimate.hypotheses.front().landmark_in_camera;
    RecordCurves(profile, &result.record);
    RecordPairs(best, &result.record);
    result.record.refined_yaw = YawOf(best);
    // The mirror plane of an object on its side is horizontal.
    if (options_.texture_symmetry && evidence_.RestsOn() != RestingFace::kSide) {
      result.record.mirror_planes =
          MirrorPlanes(profile.yaw, result.record.cost.at("texture_symmetry"),
                       result.record.refined_yaw, options_.texture);
    }
    result.record.yaw_sigma = profile.StandardDeviation(optima);
    return result;
  }

 private:
  double YawOf(const Landmark& landmark) const {
    return Yaw(evidence_.plane.normal, landmark.frame_from_object.rotation);
  }

  void RecordPairs(const Landmark& landmark, SymmetryRecord* record) const {
    const auto texture = asymmetry_.Find(landmark);
    if (!texture) return;
    const SymmetryDescriptor descriptor(symmetry_options_.descriptor, symmetry_image_, camera_,
                                        InOwnAxes(landmark));
    for (const Eigen::Vector2d& pixel : texture->pixels) {
      const auto pair = descriptor.Evaluate(pixel, std::nullopt, false, texture->mirror_plane);
      if (!pair) continue;  // at the border of the image, by rounding
      record->samples.push_back(pixel.cast<float>());
      record->mirrored.push_back(pair->mirror_pixel.cast<float>());
    }
  }

  void RecordCurves(const YawProfile& profile, SymmetryRecord* record) const {
    record->yaw = profile.yaw;
    record->cost["total"] = profile.Costs();
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const auto& fit : profile.fits) {
      if (options_.edge_alignment) {
        record->cost["edge_alignment"].push_back(fit ? fit->cost.further : none);
      }
      if (options_.texture_symmetry) {
        record->cost["texture_symmetry"].push_back(fit ? fit->cost.compared : none);
      }
    }
  }

  const ProfileOptions& options_;
  const SymmetryOptions& symmetry_options_;
  Camera camera_;
  SymmetryImage symmetry_image_;
  TextureAsymmetry asymmetry_;
  ObjectEvidence evidence_;
};

// Joins the hypotheses of two faces; the record is that of the better one, if equal of the first.
RefinedObservation Joined(RefinedObservation one, RefinedObservation other) {
  const auto rank = [](const RefinedObservation& observation) {
    const std::vector<Hypothesis>& hypotheses = observation.estimate.hypotheses;
    return hypotheses.empty() ? std::numeric_limits<float>::infinity()
                              : RankOfCost(hypotheses.front().cost);
  };
  if (rank(other) < rank(one)) std::swap(one, other);
  std::vector<Hypothesis>& hypotheses = one.estimate.hypotheses;
  std::ranges::copy(other.estimate.hypotheses, std::back_inserter(hypotheses));
  std::ranges::stable_sort(
      hypotheses, {}, [](const Hypothesis& hypothesis) { return RankOfCost(hypothesis.cost); });
  hypotheses.resize(std::min(hypotheses.size(), kMaxHypotheses));
  return one;
}

}  // namespace

RefinedObservation RefineByProfile(const Sequence& sequence, int detection_index,
                                   const std::shared_ptr<const FrameEdges>& edges,
                                   const std::optional<ShapePrior>& prior,
                                   const ProfileOptions& options,
                                   const SymmetryOptions& symmetry_options,
                                   const std::optional<PointEvidence>& points) {
  const Detection& detection = sequence.detections[detection_index];
  std::optional<RefinedObservation> joined;
  for (const auto& on_face : OnPossibleFaces(prior)) {
    if (!on_face) continue;
    RefinedObservation refined =
        OrientationProfile(sequence, detection, edges, *on_face, options, symmetry_options, points)
            .Refine();
    joined = joined ? Joined(std::move(*joined), std::move(refined)) : std::move(refined);
  }
  RefinedObservation result = joined.value_or(RefinedObservation());
  if (!joined) result.estimate.failure = "no_ratio_for_label";
  result.estimate.detection_index = detection_index;
  result.record.frame_id = sequence.frames[detection.frame_index].id;
  result.record.object_id = sequence.objects[detection.object_index].id;
  result.record.true_yaw = TrueYaw(sequence, detection);
  return result;
}

namespace {

// A texture counts as symmetric when its cost is below this fraction of the largest possible cost,
// that is when most of its pairs are symmetric.
constexpr double kSymmetricShare = 0.5;

}  // namespace

std::optional<int> MirrorPlanes(const std::vector<double>& grid,
                                const std::vector<double>& texture_cost, double yaw,
                                const TextureOptions& options) {
  const auto is_symmetric = [&](double at) -> std::optional<bool> {
    size_t nearest = 0;
    for (size_t i = 1; i < grid.size(); ++i) {
      if (std::abs(YawDifferenceModuloPi(grid[i], at)) <
          std::abs(YawDifferenceModuloPi(grid[nearest], at))) {
        nearest = i;
      }
    }
    // The grid may be coarser than the minimum is wide, so its neighbours are included.
    const size_t n = grid.size();
    double lowest = options.asymmetry_cost;
    for (const size_t i : {nearest + n - 1, nearest, nearest + 1}) {
      lowest = std::fmin(lowest, texture_cost[i % n]);
    }
    if (lowest == options.asymmetry_cost) return std::nullopt;
    return lowest < kSymmetricShare * options.asymmetry_cost;
  };
  const auto at_yaw = is_symmetric(yaw);
  if (!at_yaw) return std::nullopt;
  if (!*at_yaw) return 0;
  const auto across = is_symmetric(yaw + 0.5 * std::numbers::pi);
  if (!across) return std::nullopt;
  return *across ? 2 : 1;
}

}  // namespace soslam
