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

// Assigns, frame by frame, the detections to existing tracks (at most one per track) or to new
// tracks at the least total cost. Fills Association::detections and Association::tracks.
class FrameLinker {
 public:
  FrameLinker(const AssociationModel& model, int threads) : model_(model), threads_(threads) {
    association_.detections.resize(model.sequence().detections.size());
  }

  Association Run() {
    const int frames = static_cast<int>(model_.sequence().frames.size());
    Progress progress("frames", frames);
    for (int frame = 0; frame < frames; ++frame) {
      const std::vector<int> detections = WithoutDuplicates(DetectionsIn(frame));
      Predict(frame);
      Link(detections);
      Fit();
      progress.Step();
    }
    return std::move(association_);
  }

 private:
  // State of a track in addition to its detections.
  struct State {
    std::optional<Prediction> prediction;  // in the current frame
    bool was_out_of_image = false;         // since its last detection
    bool has_changed = false;              // in the current frame
    size_t fitted_detections = 0;
    size_t fitted_labels = 0;  // number of different labels
  };

  const Detection& At(int detection) const { return model_.DetectionAt(detection); }
  DetectionDecision& DecisionOn(int detection) { return association_.detections[detection]; }

  // Indices of the detections of a frame, best score first. Ties are ordered by box and label, so
  // that the order and ids of the input do not matter.
  std::vector<int> DetectionsIn(int frame) const {
    const auto& all = model_.sequence().detections;
    std::vector<int> detections;
    for (const Detection& detection : soslam::DetectionsIn(model_.sequence(), frame)) {
      detections.push_back(static_cast<int>(&detection - all.data()));
    }
    const auto key = [&](int index) {
      const Detection& detection = At(index);
      const Box& box = detection.box;
      return std::tuple(-detection.score, box.x_min, box.y_min, box.x_max, box.y_max,
                        model_.LabelOf(detection));
    };
    std::ranges::stable_sort(detections, {}, key);
    return detections;
  }

  std::vector<int> WithoutDuplicates(const std::vector<int>& detections) {
    std::vector<int> kept;
    for (const int detection : detections) {
      const auto same = std::ranges::find_if(kept, [&](int other) {
        return BoxOverlap(At(detection).box, At(other).box) >= model_.options().duplicate_overlap;
      });
      if (same == kept.end()) {
        kept.push_back(detection);
      } else {
        DecisionOn(detection).decision = LinkDecision::kDuplicate;
        DecisionOn(detection).duplicate_of = *same;
      }
    }
    return kept;
  }

  void Predict(int frame) {
    const Camera& camera = model_.sequence().CameraOf(model_.sequence().frames[frame]);
    ParallelFor(states_.size(), threads_, [&](size_t i) {
      State& state = states_[i];
      state.prediction = model_.Predict(association_.tracks[i], frame);
      const bool is_in_image =
          state.prediction &&
          DistanceToBorder(state.prediction->outline, camera.width, camera.height) >= 0.0;
      if (!is_in_image) state.was_out_of_image = true;
    });
  }

  void Link(const std::vector<int>& detections) {
    const auto rows = static_cast<Eigen::Index>(detections.size());
    const auto columns = static_cast<Eigen::Index>(states_.size());
    Eigen::MatrixXd costs =
        Eigen::MatrixXd::Constant(rows, columns, std::numeric_limits<double>::infinity());
    std::vector<std::vector<std::optional<BoxMatch>>> matches(
        detections.size(), std::vector<std::optional<BoxMatch>>(states_.size()));
    Eigen::VectorXd costs_of_new_objects(rows);
    for (Eigen::Index row = 0; row < rows; ++row) {
      const Detection& detection = At(detections[row]);
      costs_of_new_objects[row] = model_.NewObjectCost(detection);
      for (Eigen::Index track = 0; track < columns; ++track) {
        const auto& prediction = states_[track].prediction;
        if (!prediction) continue;
        auto& match = matches[row][track];
        match = model_.Match(association_.tracks[track], *prediction, detection);
        if (match) costs(row, track) = match->cost;
      }
    }
    const std::vector<int> track_of_row = Assign(costs, costs_of_new_objects);
    for (size_t row = 0; row < detections.size(); ++row) {
      const int track = track_of_row[row];
      if (track == kUnassigned) {
        Start(detections[row]);
      } else {
        Extend(track, *matches[row][track], detections[row]);
      }
    }
  }

  void Start(int detection) {
    DetectionDecision& decision = DecisionOn(detection);
    decision.decision = LinkDecision::kNewTrack;
    decision.track = static_cast<int>(association_.tracks.size());
    association_.tracks.emplace_back();
    association_.tracks.back().plane_index = model_.PlaneOf(At(detection));
    states_.emplace_back();
    Add(decision.track, detection);
  }

  void Extend(int track_index, const BoxMatch& match, int detection) {
    Track& track = association_.tracks[track_index];
    State& state = states_[track_index];
    DetectionDecision& decision = DecisionOn(detection);
    decision.decision = state.was_out_of_image ? LinkDecision::kRevisited : LinkDecision::kLinked;
    decision.track = track_index;
    decision.match = match;
    decision.frames_since_seen =
        At(detection).frame_index - At(track.detections.back()).frame_index;
    Add(track_index, detection);
  }

  void Add(int track_index, int detection) {
    Track& track = association_.tracks[track_index];
    State& state = states_[track_index];
    track.detections.push_back(detection);
    ++track.linked;
    track.votes[model_.LabelOf(At(detection))] += At(detection).score;
    state.was_out_of_image = false;
    state.has_changed = true;
  }

  bool IsDue(size_t track_index) const {
    const Track& track = association_.tracks[track_index];
    const State& state = states_[track_index];
    const auto detections = static_cast<double>(track.detections.size());
    return state.has_changed &&
           (!track.fit || track.detections.size() <= kAlwaysFitted ||
            detections >= kFitGrowth * static_cast<double>(state.fitted_detections) ||
            track.votes.size() != state.fitted_labels);
  }

  void Fit() {
    std::vector<size_t> due;
    for (size_t i = 0; i < states_.size(); ++i) {
      if (IsDue(i)) due.push_back(i);
      states_[i].has_changed = false;
    }
    ParallelFor(due.size(), threads_, [&](size_t i) {
      const size_t track_index = due[i];
      Track& track = association_.tracks[track_index];
      model_.Fit(&track);
      states_[track_index].fitted_detections = track.detections.size();
      states_[track_index].fitted_labels = track.votes.size();
    });
  }

  const AssociationModel& model_;
  int threads_;
  Association association_;
  std::vector<State> states_;  // one per track
};

// Fills Association::objects, ordered by the first detection in the sequence.
void ListObjects(const Sequence& sequence, Association* association) {
  for (int i = 0; i < static_cast<int>(association->tracks.size()); ++i) {
    if (association->tracks[i].fate == TrackFate::kObject) {
      association->objects.push_back(i);
    }
  }
  const auto first_frame = [&](int track) {
    const int detection = association->tracks[track].detections.front();
    return sequence.detections[detection].frame_index;
  };
  std::ranges::stable_sort(association->objects, {}, first_frame);
  for (size_t object = 0; object < association->objects.size(); ++object) {
    const auto track = static_cast<size_t>(association->objects[object]);
    for (const int detection : association->tracks[track].detections) {
      association->detections[detection].object = static_cast<int>(object);
    }
  }
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
  Association association = FrameLinker(model, threads).Run();
  MergeTracks(model, threads, &association);
  DropFalseTracks(model, threads, &association);
  ListObjects(sequence, &association);
  association.up_of_segments = model.up_of_segments();
  return association;
}

const std::string& LabelOf(const Track& track) {
  const auto voted_for = std::ranges::find_if(
      track.labels, [&](const auto& label) { return track.votes.contains(label.label); });
  return voted_for == track.labels.end() ? track.labels.front().label : voted_for->label;
}

}  // namespace soslam
