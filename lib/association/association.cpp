// SPDX-License-Identifier: BSD-3-Clause
#include "association/association.h"

#include <algorithm>
#include <limits>
#include <tuple>

#include "association/association_model.h"
#include "base/assignment.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "model/occlusion.h"

namespace soslam {
namespace {

// A landmark is refitted after every new detection up to this number, then whenever the number of
// detections has grown by this factor.
constexpr size_t kAlwaysFitted = 6;
constexpr double kFitGrowth = 1.5;

// State of a track in addition to its detections.
struct TrackState {
  std::optional<Prediction> prediction;  // in the current frame
  bool was_out_of_image = false;         // since its last detection
  bool has_changed = false;              // in the current frame
  size_t fitted_detections = 0;
  size_t fitted_labels = 0;  // number of different labels

  bool NeedsFit(const Track& track) const {
    return has_changed && (!track.fit || track.detections.size() <= kAlwaysFitted ||
                           static_cast<double>(track.detections.size()) >=
                               kFitGrowth * static_cast<double>(fitted_detections) ||
                           track.votes.size() != fitted_labels);
  }
};

// Indices of the detections of a frame, best score first, without duplicates, on which it decides.
// Ties are ordered by box and label, so that the order and ids of the input do not matter.
std::vector<int> DetectionsToLink(const AssociationModel& model, int frame,
                                  std::vector<DetectionDecision>* decisions) {
  std::vector<int> detections;
  for (const Detection& detection : DetectionsIn(model.sequence(), frame)) {
    detections.push_back(static_cast<int>(&detection - model.sequence().detections.data()));
  }
  std::ranges::stable_sort(detections, {}, [&](int index) {
    const Detection& detection = model.DetectionAt(index);
    const Box& box = detection.box;
    return std::tuple(-detection.score, box.x_min, box.y_min, box.x_max, box.y_max,
                      model.LabelOf(detection));
  });
  std::vector<int> kept;
  for (const int index : detections) {
    const auto same = std::ranges::find_if(kept, [&](int other) {
      return BoxOverlap(model.DetectionAt(index).box, model.DetectionAt(other).box) >=
             model.options().duplicate_overlap;
    });
    if (same == kept.end()) {
      kept.push_back(index);
    } else {
      (*decisions)[index].decision = LinkDecision::kDuplicate;
      (*decisions)[index].duplicate_of = *same;
    }
  }
  return kept;
}

// The track of each detection, or kUnassigned, and its match, at the least total cost.
std::vector<std::pair<int, BoxMatch>> MatchToTracks(const AssociationModel& model,
                                                    const std::vector<Track>& tracks,
                                                    const std::vector<TrackState>& states,
                                                    const std::vector<int>& detections) {
  const auto rows = static_cast<Eigen::Index>(detections.size());
  const auto columns = static_cast<Eigen::Index>(states.size());
  Eigen::MatrixXd costs =
      Eigen::MatrixXd::Constant(rows, columns, std::numeric_limits<double>::infinity());
  std::vector<std::vector<BoxMatch>> matches(detections.size(),
                                             std::vector<BoxMatch>(states.size()));
  Eigen::VectorXd costs_of_new_objects(rows);
  for (Eigen::Index row = 0; row < rows; ++row) {
    const Detection& detection = model.DetectionAt(detections[row]);
    costs_of_new_objects[row] = model.NewObjectCost(detection);
    for (Eigen::Index track = 0; track < columns; ++track) {
      const auto& prediction = states[track].prediction;
      const auto match =
          prediction ? model.Match(tracks[track], *prediction, detection) : std::nullopt;
      if (!match) continue;
      matches[row][track] = *match;
      costs(row, track) = match->cost;
    }
  }
  std::vector<std::pair<int, BoxMatch>> assigned;
  for (const int track : Assign(costs, costs_of_new_objects)) {
    const auto& of_detection = matches[assigned.size()];
    assigned.emplace_back(track, track == kUnassigned ? BoxMatch() : of_detection[track]);
  }
  return assigned;
}

// Assigns, frame by frame, the detections to existing tracks (at most one per track) or to new
// tracks. Gives Association::detections and Association::tracks.
Association LinkFrames(const AssociationModel& model, int threads) {
  const Sequence& sequence = model.sequence();
  Association association;
  association.detections.resize(sequence.detections.size());
  std::vector<Track>& tracks = association.tracks;
  std::vector<TrackState> states;  // one per track
  const auto frames = static_cast<int>(sequence.frames.size());
  Progress progress("frames", frames);
  for (int frame = 0; frame < frames; ++frame) {
    const std::vector<int> detections = DetectionsToLink(model, frame, &association.detections);
    const Camera& camera = sequence.CameraOf(sequence.frames[frame]);
    ParallelFor(states.size(), threads, [&](size_t i) {
      const auto& prediction = states[i].prediction = model.Predict(tracks[i], frame);
      const bool is_in_image =
          prediction && DistanceToBorder(prediction->outline, camera.width, camera.height) >= 0.0;
      if (!is_in_image) states[i].was_out_of_image = true;
    });
    const auto matches = MatchToTracks(model, tracks, states, detections);
    for (size_t i = 0; i < detections.size(); ++i) {
      const Detection& detection = model.DetectionAt(detections[i]);
      DetectionDecision& decision = association.detections[detections[i]];
      std::tie(decision.track, decision.match) = matches[i];
      if (decision.track == kUnassigned) {
        decision.track = static_cast<int>(tracks.size());
        tracks.emplace_back().plane_index = model.PlaneOf(detection);
        states.emplace_back();
      } else {
        decision.decision = states[decision.track].was_out_of_image ? LinkDecision::kRevisited
                                                                    : LinkDecision::kLinked;
        const int last = tracks[decision.track].detections.back();
        decision.frames_since_seen = detection.frame_index - model.DetectionAt(last).frame_index;
      }
      Track& track = tracks[decision.track];
      track.detections.push_back(detections[i]);
      ++track.linked;
      track.votes[model.LabelOf(detection)] += detection.score;
      states[decision.track].was_out_of_image = false;
      states[decision.track].has_changed = true;
    }
    ParallelFor(tracks.size(), threads, [&](size_t i) {
      if (states[i].NeedsFit(tracks[i])) {
        model.Fit(&tracks[i]);
        states[i].fitted_detections = tracks[i].detections.size();
        states[i].fitted_labels = tracks[i].votes.size();
      }
      states[i].has_changed = false;
    });
    progress.Step();
  }
  return association;
}

}  // namespace

Sequence WithoutPlanes(Sequence sequence) {
  sequence.planes.clear();
  for (Object& object : sequence.objects) object.plane_index = kNoPlane;
  return sequence;
}

Association Associate(const Sequence& sequence, const SemanticTable& table,
                      const AssociateOptions& options, int threads) {
  const AssociationModel model(sequence, table, options);
  Association association = LinkFrames(model, threads);
  MergeTracks(model, threads, &association);
  DropFalseTracks(model, threads, &association);
  for (int i = 0; i < static_cast<int>(association.tracks.size()); ++i) {
    if (association.tracks[i].fate == TrackFate::kObject) association.objects.push_back(i);
  }
  std::ranges::stable_sort(association.objects, {}, [&](int track) {
    return sequence.detections[association.tracks[track].detections.front()].frame_index;
  });
  for (size_t object = 0; object < association.objects.size(); ++object) {
    const auto track = static_cast<size_t>(association.objects[object]);
    for (const int detection : association.tracks[track].detections) {
      association.detections[detection].object = static_cast<int>(object);
    }
  }
  association.up_of_segments = model.up_of_segments();
  return association;
}

const std::string& LabelOf(const Track& track) {
  const auto voted_for = std::ranges::find_if(
      track.labels, [&](const auto& label) { return track.votes.contains(label.label); });
  return voted_for == track.labels.end() ? track.labels.front().label : voted_for->label;
}

}  // namespace soslam
