// SPDX-License-Identifier: BSD-3-Clause
#include "association/association_model.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace soslam {
namespace {

std::set<std::string> LabelsOf(const Sequence& sequence) {
  std::set<std::string> labels;
  for (const Object& object : sequence.objects) labels.insert(object.label);
  return labels;
}

}  // namespace

AssociationModel::AssociationModel(const Sequence& sequence, const SemanticTable& table,
                                   const AssociateOptions& options)
    : sequence_(sequence),
      table_(table),
      options_(options),
      up_of_segments_(sequence.planes.empty() ? UpOfSegments(sequence, table, options)
                                              : std::map<int, UpEstimate>()),
      boxes_(sequence, options),
      labels_(LabelsOf(sequence), options.label_confusion, options.interchangeable_labels) {}

void AssociationModel::Fit(Track* track) const {
  ShapePrior prior = PriorOfLabel(table_, WinningLabel(track->votes), options_);
  if (track->plane_index != kNoPlane) prior = TurnedToSupport(prior);
  const auto up = up_of_segments_.find(SegmentOf(*track));
  const auto fit =
      FitObject(sequence_, track->detections, prior, options_,
                up == up_of_segments_.end() ? std::nullopt : std::optional(up->second));
  if (fit) track->fit = fit;
}

int AssociationModel::SegmentOf(const Track& track) const {
  const auto first = static_cast<size_t>(track.detections.front());
  return sequence_.FrameOf(sequence_.detections[first]).segment;
}

std::optional<Prediction> AssociationModel::Predict(const Track& track, int frame_index) const {
  if (!track.fit ||
      SegmentOf(track) != sequence_.frames[static_cast<size_t>(frame_index)].segment) {
    return std::nullopt;
  }
  const auto frame_of = [this](int detection) {
    return sequence_.detections[static_cast<size_t>(detection)].frame_index;
  };
  const auto next =
      std::lower_bound(track.detections.begin(), track.detections.end(), frame_index,
                       [&](int detection, int frame) { return frame_of(detection) < frame; });
  int nearest =
      next == track.detections.end() ? frame_of(track.detections.back()) : frame_of(*next);
  if (next != track.detections.begin()) {
    const int before = frame_of(*std::prev(next));
    if (std::abs(frame_index - before) <= std::abs(frame_index - nearest)) nearest = before;
  }
  return boxes_.Predict(*track.fit, nearest, frame_index);
}

std::optional<BoxMatch> AssociationModel::Match(const Track& track, const Prediction& prediction,
                                                const Detection& detection) const {
  if (PlaneOf(detection) != track.plane_index) return std::nullopt;
  const double label_cost = labels_.Cost(WinningLabel(track.votes), LabelOf(detection));
  if (!std::isfinite(label_cost)) return std::nullopt;
  auto match = boxes_.Match(prediction, detection);
  if (!match) return std::nullopt;
  match->cost += label_cost - 2.0 * std::log(1.0 - options_.new_object_probability);
  return match->cost < NewObjectCost(detection) ? match : std::nullopt;
}

double AssociationModel::NewObjectCost(const Detection& detection) const {
  return boxes_.CostOfAnyBox(detection) + labels_.CostOfAnyLabel() -
         2.0 * std::log(options_.new_object_probability);
}

}  // namespace soslam
