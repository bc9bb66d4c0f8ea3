// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/refine_by_profile.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <utility>

#include "soslam/geometry/landmark.h"
#include "soslam/initialisation/fit_object.h"
#include "soslam/initialisation/points_in_frames.h"
#include "soslam/initialisation/yaw_prior.h"
#include "soslam/model/occlusion.h"
#include "soslam/orientation/texture_asymmetry.h"

namespace soslam {
namespace {

// Further hypotheses are far less likely.
constexpr size_t kMaxHypotheses = 6;
// A texture counts as symmetric when its cost is below this fraction of the largest possible cost,
// that is when most of its pairs are symmetric.
constexpr double kSymmetricShare = 0.5;

// The orientation profile of an object that rests on one face, without the observation's place in
// the sequence.
RefinedObservation RefineOnFace(const Sequence& sequence, const Detection& detection,
                                const std::shared_ptr<const FrameEdges>& edges,
                                const ShapePrior& prior, const ProfileOptions& options,
                                const SymmetryOptions& symmetry_options,
                                const std::optional<PointEvidence>& points) {
  const Camera& camera = sequence.CameraOf(detection);
  const SymmetryImage symmetry_image(edges->maps, detection.box);
  const TextureAsymmetry asymmetry(symmetry_image, camera, options.texture, symmetry_options);
  ObjectEvidence evidence = EvidenceInCamera(sequence, detection, prior, options.upright);
  if (points) evidence.further.push_back(InCamera(*points));
  if (options.edge_alignment) {
    const auto image = std::make_shared<const EdgeImage>(
        EdgeImage{edges, detection.box, BoxesInFront(sequence, detection)});
    const auto cost_at = [&camera, &options, image](const Landmark& in_camera) {
      return std::make_unique<EdgeCost>(image, camera, in_camera, options.edges);
    };
    evidence.further.push_back({cost_at, Rigid3d()});
  }
  if (options.texture_symmetry) {
    evidence.compared_cost = [&asymmetry](const Landmark& landmark, double /*limit*/) {
      return asymmetry.Cost(landmark);
    };
  }
  const YawProfile profile = ProfileOverYaw(evidence, options.upright.YawStep());
  RefinedObservation result;
  std::vector<YawProfile::Optimum> optima;
  for (const ObjectFit& fit :
       FitObject(evidence, profile.Minima(kMaxHypotheses), {kMaxHypotheses, profile.Step()})) {
    result.estimate.hypotheses.push_back({fit.landmark, fit.cost.total});
    const double yaw = Yaw(evidence.plane.normal, fit.landmark.frame_from_object.rotation);
    optima.push_back({yaw, fit.cost.total});
  }
  if (optima.empty()) {
    result.estimate.failure = WhyNoSolution(evidence);
    return result;
  }
  SymmetryRecord& record = result.record;
  record.yaw = profile.yaw;
  record.cost["total"] = profile.Costs();
  const double none = std::numeric_limits<double>::quiet_NaN();
  for (const auto& fit : profile.fits) {
    if (options.edge_alignment) {
      record.cost["edge_alignment"].push_back(fit ? fit->cost.further : none);
    }
    if (options.texture_symmetry) {
      record.cost["texture_symmetry"].push_back(fit ? fit->cost.compared : none);
    }
  }
  const Landmark& best = result.estimate.hypotheses.front().landmark_in_camera;
  if (const auto texture = asymmetry.Find(best)) {
    const SymmetryDescriptor descriptor(symmetry_options.descriptor, symmetry_image, camera,
                                        InOwnAxes(best));
    for (const Eigen::Vector2d& pixel : texture->pixels) {
      // Empty at the border of the image, by rounding.
      RecordPair(pixel, descriptor.Evaluate(pixel, std::nullopt, false, texture->mirror_plane),
                 &record);
    }
  }
  record.refined_yaw = optima.front().yaw;
  // The mirror plane of an object on its side is horizontal.
  if (options.texture_symmetry && evidence.RestsOn() != RestingFace::kSide) {
    record.mirror_planes = MirrorPlanes(profile.yaw, record.cost.at("texture_symmetry"),
                                        optima.front().yaw, options.texture);
  }
  record.yaw_sigma = profile.StandardDeviation(optima);
  return result;
}

}  // namespace

RefinedObservation RefineByProfile(const Sequence& sequence, int detection_index,
                                   const std::shared_ptr<const FrameEdges>& edges,
                                   const std::optional<ShapePrior>& prior,
                                   const ProfileOptions& options,
                                   const SymmetryOptions& symmetry_options,
                                   const std::optional<PointEvidence>& points) {
  const Detection& detection = sequence.detections[detection_index];
  const auto rank = [](const RefinedObservation& observation) {
    const std::vector<Hypothesis>& hypotheses = observation.estimate.hypotheses;
    return hypotheses.empty() ? std::numeric_limits<float>::infinity()
                              : RankOfCost(hypotheses.front().cost);
  };
  // The hypotheses of all faces; the record is that of the best one, if equal of the first.
  std::optional<RefinedObservation> joined;
  for (const auto& on_face : OnPossibleFaces(prior)) {
    if (!on_face) continue;
    RefinedObservation refined =
        RefineOnFace(sequence, detection, edges, *on_face, options, symmetry_options, points);
    if (!joined) {
      joined = std::move(refined);
      continue;
    }
    if (rank(refined) < rank(*joined)) std::swap(*joined, refined);
    std::vector<Hypothesis>& hypotheses = joined->estimate.hypotheses;
    std::ranges::copy(refined.estimate.hypotheses, std::back_inserter(hypotheses));
    std::ranges::stable_sort(hypotheses, {},
                             [](const Hypothesis& one) { return RankOfCost(one.cost); });
    hypotheses.resize(std::min(hypotheses.size(), kMaxHypotheses));
  }
  RefinedObservation result = joined.value_or(RefinedObservation());
  if (!joined) result.estimate.failure = "no_ratio_for_label";
  result.estimate.detection_index = detection_index;
  result.record.frame_id = sequence.frames[detection.frame_index].id;
  result.record.object_id = sequence.objects[detection.object_index].id;
  result.record.true_yaw = TrueYaw(sequence, detection);
  return result;
}

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
