// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "soslam/association/association.h"
#include "soslam/association/clustering.h"
#include "soslam/ground/object_heights.h"

namespace soslam {
namespace {

// Metres per unit of the normalised world, whose unit is the median distance of points from the
// cameras that see them: that of rooms and desks, with the standard deviation of its logarithm
// (guesses).
constexpr double kMetresPerUnit = 2.0;
constexpr double kUnitLogSigma = 0.7;

}  // namespace

std::vector<int> FramesToGroup(const Sequence& sequence, const FoundEdits& edits) {
  constexpr size_t kMostFrames = 200;  // (a guess)
  std::vector<int> frames;
  for (const Detection& detection : sequence.detections) {
    if (frames.empty() || frames.back() != detection.frame_index) {
      frames.push_back(detection.frame_index);
    }
  }
  frames = SpreadOver(frames, kMostFrames);
  for (const std::vector<int>& boxes : edits.boxes) {
    for (const int box : boxes) frames.push_back(sequence.detections[box].frame_index);
  }
  std::ranges::sort(frames);
  frames.erase(std::unique(frames.begin(), frames.end()), frames.end());
  return frames;
}

std::vector<std::vector<int>> GroupBoxes(Sequence sequence, const std::vector<int>& frames,
                                         const FoundEdits& edits, const SemanticTable& table,
                                         const PairEvidence& pairs, const UpPrior& up,
                                         const GroundOptions& options, int threads) {
  AssociateOptions association = FitOptions(options);
  association.unknown_height_m /= kMetresPerUnit;
  // Poses of structure from motion do not drift.
  association.odometry_rotation_sigma_deg = association.odometry_translation_sigma_m = 0.0;
  sequence.ground.emplace();
  sequence.ground->up_in_world = up.up_in_world;
  sequence.ground->up_information = up.information;
  // Heights in units of the normalised world are as uncertain as that unit is.
  SemanticTable in_units = table;
  const auto convert = [](ShapePrior* prior) {
    if (!prior->height_m) return;
    prior->height_m->median /= kMetresPerUnit;
    prior->height_m->log_sigma = std::hypot(prior->height_m->log_sigma, kUnitLogSigma);
  };
  for (auto& [label, prior] : in_units.priors) convert(&prior);
  if (in_units.default_prior) convert(&*in_units.default_prior);
  const AssociationModel model(sequence, in_units, association);
  std::vector<DetectionDecision> decisions(sequence.detections.size());
  std::vector<int> kept = WithoutDuplicates(sequence, association.duplicate_overlap, &decisions);
  std::erase_if(kept, [&](int box) {
    return edits.deleted.contains(box) ||
           !std::ranges::binary_search(frames, sequence.detections[box].frame_index);
  });
  std::vector<std::vector<int>> groups;
  for (const Cluster& cluster : ClusterDetections(model, pairs, kept, threads).all) {
    std::vector<int> group;
    for (size_t i = 0; i < cluster.is_used.size(); ++i) {
      if (cluster.is_used[i]) group.push_back(cluster.track.detections[i]);
    }
    if (!group.empty()) groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace soslam
