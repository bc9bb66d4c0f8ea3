// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/refine_by_turning.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "soslam/geometry/angles.h"
#include "soslam/initialisation/single_frame.h"
#include "soslam/initialisation/yaw_prior.h"
#include "soslam/orientation/texture_asymmetry.h"

namespace soslam {
namespace {

struct BestTurn {
  double turn;  // rad
  double cost;
};

// One observation, and the data that all steps of its refinement share.
struct Refinement {
  const Sequence& sequence;
  const Detection& detection;
  const RefineOptions& options;
  SingleFrameObservation observation;
  std::shared_ptr<const SymmetryImage> image;
  Landmark start;  // in the camera frame
  std::vector<Eigen::Vector2d> samples;
  std::optional<BestTurn> best_turn;
};

double YawInCamera(const Refinement& refinement, const Landmark& landmark) {
  return Yaw(refinement.detection.plane_in_camera.normal, landmark.frame_from_object.rotation);
}

// Symmetry costs of the landmark rotated about its z axis by `turn`; centre and half axes stay.
std::vector<std::optional<double>> CostsAtTurn(const Refinement& refinement, double turn,
                                               const std::vector<Descriptor>& descriptors) {
  return SymmetryCosts(*refinement.image, refinement.observation.camera,
                       RotatedAboutZ(refinement.start, turn), refinement.samples, descriptors,
                       refinement.options.symmetry);
}

// The rotation of lowest cost, at most yaw_range_deg either way: the best of a grid of
// yaw_step_deg, refined on a grid of yaw_resolution_deg between its neighbours. None when the cost
// is undefined on the whole grid.
std::optional<BestTurn> FindBestTurn(const Refinement& refinement) {
  const RefineOptions& options = refinement.options;
  const double range = options.yaw_range_deg * kRadPerDeg;
  const double step = options.yaw_step_deg * kRadPerDeg;
  std::optional<BestTurn> best;
  const auto search = [&](double centre, double half_width, double spacing) {
    const int count = static_cast<int>(std::ceil(half_width / spacing));
    for (int i = -count; i <= count; ++i) {
      const double turn = std::clamp(centre + half_width * i / std::max(1, count), -range, range);
      const auto cost = CostsAtTurn(refinement, turn, {options.symmetry.descriptor}).front();
      if (cost && (!best || *cost < best->cost)) best = BestTurn{turn, *cost};
    }
  };
  search(0.0, range, step);
  if (best) search(best->turn, std::min(step, range), options.yaw_resolution_deg * kRadPerDeg);
  return best;
}

// The costs of all descriptors over half a turn (fig. 7); NaN where undefined.
void RecordCurves(const Refinement& refinement, SymmetryRecord* record) {
  const double initial_yaw = YawInCamera(refinement, refinement.start);
  const double step = refinement.options.yaw_step_deg * kRadPerDeg;
  std::vector<Descriptor> descriptors;
  for (size_t i = 0; i < kDescriptorNames.size(); ++i) {
    descriptors.push_back(static_cast<Descriptor>(i));
  }
  const int count = std::max(1, static_cast<int>(std::round(std::numbers::pi / step)));
  for (int i = 0; i < count; ++i) {
    const double turn = std::numbers::pi * (static_cast<double>(i) / count - 0.5);
    const auto costs = CostsAtTurn(refinement, turn, descriptors);
    record->yaw.push_back(initial_yaw + turn);
    for (size_t k = 0; k < costs.size(); ++k) {
      record->cost[kDescriptorNames[k]].push_back(
          costs[k].value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }
}

// The hypothesis with the most symmetric texture near its yaw, among those that fit the box as well
// as the first.
Refinement ChooseHypothesis(const Sequence& sequence, const Detection& detection,
                            const std::vector<Hypothesis>& hypotheses, const EdgeMaps& maps,
                            const Eigen::Vector2d& ratio, const RefineOptions& options) {
  const auto image = std::make_shared<const SymmetryImage>(maps, detection.box);
  const Camera& camera = sequence.CameraOf(detection);
  const auto edge_rms = [&](const Hypothesis& hypothesis) {
    return OutlineEdgeRms(camera, hypothesis.landmark_in_camera, detection.box);
  };
  const double tied_rms = edge_rms(hypotheses.front()) + options.tie_edge_px;
  std::optional<Refinement> chosen;
  for (const Hypothesis& hypothesis : hypotheses) {
    if (chosen && !(edge_rms(hypothesis) <= tied_rms)) continue;
    const Landmark& start = hypothesis.landmark_in_camera;
    Refinement refinement{sequence,
                          detection,
                          options,
                          {camera, detection.box, detection.plane_in_camera, ratio},
                          image,
                          start,
                          SamplePixels(*image, camera, start, options.symmetry),
                          std::nullopt};
    refinement.best_turn = FindBestTurn(refinement);
    if (!chosen || (refinement.best_turn &&
                    (!chosen->best_turn || refinement.best_turn->cost < chosen->best_turn->cost))) {
      chosen.emplace(std::move(refinement));
    }
  }
  return *chosen;
}

}  // namespace

std::vector<std::optional<double>> SymmetryCosts(const SymmetryImage& image, const Camera& camera,
                                                 const Landmark& landmark_in_camera,
                                                 const std::vector<Eigen::Vector2d>& samples,
                                                 const std::vector<Descriptor>& descriptors,
                                                 const SymmetryOptions& options) {
  struct Sum {
    SymmetryDescriptor descriptor;
    double residuals = 0.0;
    int pairs = 0;
  };
  std::vector<Sum> sums;
  for (const Descriptor descriptor : descriptors) {
    sums.push_back({{descriptor, image, camera, landmark_in_camera}});
  }
  for (const Eigen::Vector2d& pixel : samples) {
    const auto point = sums.front().descriptor.VisiblePoint(pixel, options.min_viewing_cosine);
    if (!point) continue;
    for (Sum& sum : sums) {
      const auto pair = sum.descriptor.EvaluateAt(pixel, *point, false);
      if (!pair) continue;
      sum.residuals += std::abs(pair->residual);
      ++sum.pairs;
    }
  }
  std::vector<std::optional<double>> costs;
  for (const Sum& sum : sums) {
    const bool is_known = sum.pairs >= options.MinPairs(samples.size());
    costs.push_back(is_known ? std::optional(sum.residuals / sum.pairs) : std::nullopt);
  }
  return costs;
}

void RecordPair(const Eigen::Vector2d& pixel, const std::optional<SymmetryDescriptor::Pair>& pair,
                SymmetryRecord* record) {
  if (!pair) return;
  record->samples.push_back(pixel.cast<float>());
  record->mirrored.push_back(pair->mirror_pixel.cast<float>());
}

RefinedObservation RefineByTurning(const Sequence& sequence, const ObservationEstimate& initial,
                                   const EdgeMaps& maps,
                                   const std::optional<Eigen::Vector2d>& ratio,
                                   const RefineOptions& options) {
  const Detection& detection = sequence.detections[initial.detection_index];
  RefinedObservation result;
  result.estimate = initial;
  result.record.frame_id = sequence.frames[detection.frame_index].id;
  result.record.object_id = sequence.objects[detection.object_index].id;
  if (initial.hypotheses.empty()) return result;
  if (!ratio) {
    result.estimate.failure = "no_ratio_for_label";
    return result;
  }

  const Refinement refinement =
      ChooseHypothesis(sequence, detection, initial.hypotheses, maps, *ratio, options);
  Landmark refined = refinement.start;
  if (refinement.image->edge_pixels.empty()) {
    result.estimate.failure = "no_edges";
  } else if (!refinement.best_turn) {
    result.estimate.failure = "too_few_visible_pairs";
  } else {
    result.estimate.failure.clear();
    refined = RotatedAboutZ(refinement.start, refinement.best_turn->turn);
    result.estimate.hypotheses = {
        {refined, SingleFrameCost(refinement.observation, options.variances, refined)}};
  }
  RecordCurves(refinement, &result.record);
  const SymmetryDescriptor descriptor(options.symmetry.descriptor, *refinement.image,
                                      refinement.observation.camera, refined);
  for (const Eigen::Vector2d& pixel : refinement.samples) {
    RecordPair(pixel, descriptor.Evaluate(pixel, options.symmetry.min_viewing_cosine, false),
               &result.record);
  }
  result.record.initial_yaw = YawInCamera(refinement, refinement.start);
  result.record.refined_yaw = YawInCamera(refinement, refined);
  result.record.true_yaw = TrueYaw(sequence, detection);
  return result;
}

}  // namespace soslam
