// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/association_model.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace soslam {
namespace {

std::set<std::string> CollectLabels(const Sequence& sequence) {
  std::set<std::string> labels;
  for (const Object& object : sequence.objects) labels.insert(object.label);
  return labels;
}

// Direction away from the most support planes, as floors, tables and shelves are parallel.
Eigen::Vector3d UpOfPlanes(const Sequence& sequence) {
  constexpr double kCosineOfParallel = 0.95;
  const auto parallel_to = [&](const SupportPlane& plane) {
    return std::ranges::count_if(sequence.planes, [&](const SupportPlane& other) {
      return other.plane_in_world.normal.dot(plane.plane_in_world.normal) > kCosineOfParallel;
    });
  };
  return std::ranges::max_element(sequence.planes, {}, parallel_to)->plane_in_world.normal;
}

// True if objects of this mount can be on a plane with this cosine between its normal and up.
bool Fits(Mount mount, double cosine) {
  constexpr double kCosineLimit = 0.7;
  if (mount == Mount::kOnWall) return std::abs(cosine) < kCosineLimit;
  return (mount == Mount::kStanding ? cosine : -cosine) > kCosineLimit;
}

// -log of the prior probability that an object stands on a plane of the sequence: low things stand
// on tables and shelves, high ones on the floor. Infinite where its mount does not fit.
double CostOfPlane(const Sequence& sequence, const Plane& plane_in_world, const ShapePrior& prior) {
  constexpr double kTableHeightM = 0.2;      // over the floor, at least
  constexpr double kUndecidedHeightM = 0.5;  // of things as often on the floor as on tables
  const Eigen::Vector3d up = UpOfPlanes(sequence);
  double floor = std::numeric_limits<double>::infinity();
  for (const SupportPlane& plane : sequence.planes) {
    if (!Fits(Mount::kStanding, plane.plane_in_world.normal.dot(up))) continue;
    floor = std::min(floor, -plane.plane_in_world.offset);
  }
  const double cosine = plane_in_world.normal.dot(up);
  if (!Fits(prior.mount, cosine)) return std::numeric_limits<double>::infinity();
  const auto is_raised = [&](const Plane& plane) { return -plane.offset > floor + kTableHeightM; };
  const auto alike = std::ranges::count_if(sequence.planes, [&](const SupportPlane& plane) {
    return Fits(prior.mount, plane.plane_in_world.normal.dot(up)) &&
           (prior.mount != Mount::kStanding ||
            is_raised(plane.plane_in_world) == is_raised(plane_in_world));
  });
  if (prior.mount != Mount::kStanding) return std::log(static_cast<double>(alike));
  const double odds = std::pow(prior.height_m->median / kUndecidedHeightM, 3.0);
  const double probability = (is_raised(plane_in_world) ? 1.0 : odds) / (1.0 + odds);
  return std::log(static_cast<double>(alike) / probability);
}

// The labels that a track is detected with, or the one that is given by hand.
std::vector<std::string> OwnLabels(const Track& track) {
  if (track.by_hand && track.by_hand->label) return {*track.by_hand->label};
  std::vector<std::string> labels;
  for (const auto& [label, votes] : track.votes) labels.push_back(label);
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
      labels_(CollectLabels(sequence), options),
      moving_labels_(NormalisedLabels("moving_labels", options.moving_labels)) {}

std::vector<Support> AssociationModel::ListSupports(const Track& track) const {
  if (sequence_.planes.empty()) return {{kNoPlane, up_of_segments_.at(SegmentOf(track))}};
  std::vector<Support> supports;
  for (int i = 0; i < static_cast<int>(sequence_.planes.size()); ++i) {
    if (sequence_.HasSupports() && i != track.plane_index) continue;
    supports.push_back({i, sequence_.planes[i].plane_in_world});
  }
  return supports;
}

double AssociationModel::CostOfLabel(const Track& track, const std::string& label,
                                     const FittedObject& fit) const {
  return labels_.CostOfVotes(track.votes, label) + options_.label_evidence_weight * fit.cost;
}

void AssociationModel::Try(const Track& track, const std::string& label, const Support& support,
                           const std::vector<Landmark>& starts, Hypotheses* hypotheses) const {
  const ShapePrior prior = MakePrior(track, label);
  const double cost_of_plane =
      sequence_.planes.empty() || sequence_.HasSupports()
          ? 0.0
          : CostOfPlane(sequence_, std::get<Plane>(support.in_world), prior);
  if (!std::isfinite(cost_of_plane)) return;
  const auto fit =
      FitTrack(sequence_, track.detections, prior, options_, support.in_world, {starts});
  if (!fit) return;
  const double cost = CostOfLabel(track, label, *fit) + cost_of_plane;
  const auto [of_label, is_first] = hypotheses->cost_of_label.emplace(label, cost);
  of_label->second = std::min(of_label->second, cost);
  if (cost >= hypotheses->cost) return;
  hypotheses->cost = cost;
  hypotheses->prior_cost = 2.0 * (fit->prior_cost + cost_of_plane);
  hypotheses->fit = fit;
  hypotheses->plane_index = support.plane_index;
  hypotheses->label = label;
}

void AssociationModel::TryFreeHeight(const Track& track, const std::string& label,
                                     Hypotheses* hypotheses) const {
  const ShapePrior prior = MakePrior(track, label);
  if (sequence_.planes.empty() || prior.mount != Mount::kStanding) return;
  const UpEstimate up{UpOfPlanes(sequence_), Eigen::Matrix3d::Zero()};
  const auto free =
      FitTrack(sequence_, track.detections, prior, options_, up, {.feet_may_be_hidden = false});
  if (!free) return;
  // The foot may be on a plane that is nearer than half the body's height, the errors of boxes or
  // three standard deviations.
  const Landmark& landmark = free->landmark_in_world;
  const double half_height = landmark.half_axes.z();
  const auto may_stand_on = [&](const SupportPlane& plane) {
    constexpr double kErrorM = 0.2;
    const Eigen::Vector3d& normal = plane.plane_in_world.normal;
    const double above = plane.plane_in_world.SignedDistance(landmark.Centre()) - half_height;
    LandmarkStep d_above = LandmarkStep::Zero();
    d_above.segment<3>(3) = normal;
    d_above(8) = -half_height;
    const double sigma = std::sqrt(d_above.dot(free->covariance * d_above));
    return std::abs(above) < std::max({kErrorM, half_height, 3.0 * sigma});
  };
  if (std::ranges::any_of(sequence_.planes, may_stand_on)) return;
  hypotheses->cost_at_free_height =
      std::min(hypotheses->cost_at_free_height,
               CostOfLabel(track, label, *free) - std::log(options_.no_support_probability));
}

void AssociationModel::TryOwnLabels(const Track& track, Hypotheses* hypotheses) const {
  for (const std::string& label : OwnLabels(track)) {
    for (const Support& support : ListSupports(track)) Try(track, label, support, {}, hypotheses);
  }
}

void AssociationModel::TrySimilar(const Track& track, Hypotheses* hypotheses) const {
  if (track.by_hand && track.by_hand->label) return;
  std::vector<Support> supports = ListSupports(track);
  std::vector<Landmark> starts;
  if (hypotheses->fit) {
    std::erase_if(supports, [&](const Support& support) {
      return support.plane_index != hypotheses->plane_index;
    });
    starts.push_back(hypotheses->fit->landmark_in_world);
  }
  for (const std::string& label : labels_.Candidates(track.votes)) {
    if (track.votes.contains(label) || !table_.Contains(label)) continue;
    for (const Support& support : supports) Try(track, label, support, starts, hypotheses);
  }
}

void AssociationModel::Fit(Track* track) const {
  Hypotheses hypotheses;
  TryOwnLabels(*track, &hypotheses);
  TrySimilar(*track, &hypotheses);
  std::vector<std::string> at_free_height = OwnLabels(*track);
  if (hypotheses.fit && !track->votes.contains(hypotheses.label)) {
    at_free_height.push_back(hypotheses.label);
  }
  for (const std::string& label : at_free_height) TryFreeHeight(*track, label, &hypotheses);
  Settle(hypotheses, track);
}

void AssociationModel::FitAsDetected(Track* track) const {
  Hypotheses hypotheses;
  TryOwnLabels(*track, &hypotheses);
  if (hypotheses.fit && options_.label_evidence_weight * hypotheses.fit->cost_of_misfit >
                            -std::log(options_.similar_label_confusion)) {
    TrySimilar(*track, &hypotheses);
  }
  Settle(hypotheses, track);
}

void AssociationModel::FitLike(const std::vector<const Track*>& parts, Track* track) const {
  std::set<std::pair<std::string, int>> ways;
  std::vector<Landmark> starts;
  for (const Track* part : parts) {
    if (!part->fit) continue;
    ways.emplace(part->fit_label, part->plane_index);
    if (parts.size() <= 2) starts.push_back(part->fit->landmark_in_world);
  }
  Hypotheses hypotheses;
  for (const auto& [label, plane_index] : ways) {
    for (const Support& support : ListSupports(*track)) {
      if (support.plane_index == plane_index) Try(*track, label, support, starts, &hypotheses);
    }
  }
  Settle(hypotheses, track);
}

void AssociationModel::Settle(const Hypotheses& hypotheses, Track* track) const {
  std::map<std::string, double> cost_of_label = hypotheses.cost_of_label;
  if (hypotheses.fit) {
    track->fit = hypotheses.fit;
    track->fit_label = hypotheses.label;
    track->prior_cost = hypotheses.prior_cost;
    track->plane_index = hypotheses.plane_index;
    track->has_support = hypotheses.cost <= hypotheses.cost_at_free_height;
  } else {
    for (const auto& [label, score] : track->votes) {
      cost_of_label[label] = labels_.CostOfVotes(track->votes, label);
    }
  }
  track->labels = ProbabilitiesOfLabels(cost_of_label);
}

ShapePrior AssociationModel::MakePrior(const Track& track, const std::string& label) const {
  ShapePrior prior = PriorOfLabel(table_, label, options_);
  if (track.by_hand) prior = WithKnownSize(prior, track.by_hand->size);
  return sequence_.planes.empty() ? prior : TurnedToSupport(prior);
}

int AssociationModel::SegmentOf(const Track& track) const {
  return sequence_.FrameOf(DetectionAt(track.detections.front())).segment;
}

std::optional<Prediction> AssociationModel::Predict(const Track& track, int frame_index) const {
  if (!track.fit || SegmentOf(track) != sequence_.frames[frame_index].segment) {
    return std::nullopt;
  }
  const auto frame_of = [this](int detection) { return DetectionAt(detection).frame_index; };
  const auto next = std::ranges::lower_bound(track.detections, frame_index, {}, frame_of);
  int nearest =
      next == track.detections.end() ? frame_of(track.detections.back()) : frame_of(*next);
  if (next != track.detections.begin()) {
    const int before = frame_of(*std::prev(next));
    if (std::abs(frame_index - before) <= std::abs(frame_index - nearest)) nearest = before;
  }
  return Predict(track, *track.fit, nearest, frame_index);
}

std::optional<Prediction> AssociationModel::Predict(const Track& track, const FittedObject& fit,
                                                    int known_frame_index, int frame_index) const {
  const auto prior = table_.Find(soslam::LabelOf(track));
  return boxes_.Predict(fit, known_frame_index, frame_index, prior ? prior->edge_bias : EdgeBias());
}

std::optional<BoxMatch> AssociationModel::Match(const Track& track, const Prediction& prediction,
                                                const Detection& detection) const {
  if (sequence_.HasSupports() && PlaneOf(detection) != track.plane_index) return std::nullopt;
  auto match = boxes_.Match(prediction, detection);
  if (!match) return std::nullopt;
  match->cost -= 2.0 * std::log(labels_.Probability(LabelOf(detection), track.labels)) +
                 2.0 * std::log(1.0 - options_.new_object_probability);
  return match->cost < NewObjectCost(detection) ? match : std::nullopt;
}

bool AssociationModel::MayShareSupport(const Track& one, const Track& other) const {
  return SegmentOf(one) == SegmentOf(other) &&
         (!sequence_.HasSupports() || one.plane_index == other.plane_index);
}

std::vector<std::optional<BoxMatch>> AssociationModel::Explain(const Track& track) const {
  std::vector<std::optional<BoxMatch>> matches(track.detections.size());
  if (!track.fit) return matches;
  FittedObject exact = *track.fit;
  exact.covariance.setZero();
  const int middle = DetectionAt(track.detections[track.detections.size() / 2]).frame_index;
  for (size_t i = 0; i < matches.size(); ++i) {
    const Detection& detection = DetectionAt(track.detections[i]);
    const auto prediction = Predict(track, exact, middle, detection.frame_index);
    if (prediction) matches[i] = Match(track, *prediction, detection);
  }
  return matches;
}

double AssociationModel::OverlapByBoxes(const Track& track) const {
  return soslam::OverlapByBoxes(sequence_, track.detections, MakePrior(track, track.fit_label),
                                options_, *track.fit);
}

bool AssociationModel::Moves(const Track& track) const {
  return moving_labels_.contains(NormalisedLabel(soslam::LabelOf(track)));
}

bool AssociationModel::MayBeOneObject(const Track& one, const Track& other) const {
  return SegmentOf(one) == SegmentOf(other) &&
         std::ranges::all_of(other.votes, [&](const auto& vote) {
           return labels_.Probability(vote.first, one.labels) > 0.0;
         });
}

double AssociationModel::UnexplainedCost(const Track& track, const Detection& detection) const {
  constexpr double kUnexplained = 0.0025;
  return boxes_.CostOfAnyBox(detection) -
         2.0 * std::log(labels_.Probability(LabelOf(detection), track.labels)) -
         2.0 * std::log(kUnexplained);
}

double AssociationModel::NewObjectCost(const Detection& detection) const {
  return boxes_.CostOfAnyBox(detection) + labels_.CostOfAnyLabel() -
         2.0 * std::log(options_.new_object_probability);
}

}  // namespace soslam
