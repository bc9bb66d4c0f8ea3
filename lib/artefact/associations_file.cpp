// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/files.h"
#include "artefact/model_json.h"

namespace soslam {
namespace {

using nlohmann::json;

json IdOrNull(int index, int first_id) { return index >= 0 ? json(index + first_id) : json(); }

// Reference to a detection of the input sequence as files have it: frame id and id of the given
// object.
json NameOf(const Sequence& sequence, int index) {
  const Detection& detection = sequence.detections[index];
  return {{"frame", sequence.frames[detection.frame_index].id},
          {"given_object", sequence.objects[detection.object_index].id}};
}

json LinkToJson(const DetectionDecision& decision) {
  const bool is_link =
      decision.decision == LinkDecision::kLinked || decision.decision == LinkDecision::kRevisited;
  if (!is_link) return {};
  const BoxMatch& match = decision.match;
  return {{"overlap", match.overlap},
          {"distance_sigmas", match.distance},
          {"cut_edge",
           match.cut_edge ? json(kEdgeNames.at(static_cast<size_t>(*match.cut_edge))) : json()},
          {"frames_since_seen", decision.frames_since_seen}};
}

json DecisionToJson(const Sequence& sequence, const Association& association, int index) {
  const DetectionDecision& decision = association.detections[index];
  json row = NameOf(sequence, index);
  row["decision"] = kLinkDecisionNames.at(static_cast<size_t>(decision.decision));
  row["link"] = LinkToJson(decision);
  row["track"] = IdOrNull(decision.track, 0);
  row["object"] = IdOrNull(decision.object, 1);
  row["superseded"] = decision.superseded;
  row["duplicate_of"] =
      decision.duplicate_of >= 0 ? NameOf(sequence, decision.duplicate_of) : json();
  return row;
}

json TrackToJson(const Track& track, int index) {
  json merge;
  if (track.fate == TrackFate::kMerged) {
    merge = {{"into_track", track.merge.into},
             {"explained_boxes", track.merge.explained},
             {"tried_boxes", track.merge.tried},
             {"shared_frames", track.merge.shared_frames}};
  }
  return {{"track", index},
          {"fate", kTrackFateNames.at(static_cast<size_t>(track.fate))},
          {"merge", merge},
          {"linked_detections", track.linked},
          {"detections", track.detections.size()},
          {"frames_in_sight", track.frames_in_sight}};
}

json AssociatedObjectToJson(const Sequence& sequence, const Association& association,
                            const Agreement& agreement, size_t index) {
  const int track_index = association.objects[index];
  const Track& track = association.tracks[track_index];
  const auto given = agreement.given_of_object[index];
  return {{"object", index + 1},
          {"track", track_index},
          {"label", LabelOf(track)},
          {"label_votes", track.votes},
          {"detections", track.detections.size()},
          {"given_object", given ? json(sequence.objects[*given].id) : json()}};
}

json AgreementToJson(const Agreement& agreement) {
  return {{"objects", agreement.given_of_object.size()},
          {"given_objects", agreement.given_objects},
          {"matched", agreement.matched},
          {"precision", agreement.Precision()},
          {"recall", agreement.Recall()},
          {"f1", agreement.F1()}};
}

}  // namespace

void WriteAssociations(const std::filesystem::path& path, const Sequence& sequence,
                       const Association& association, const Agreement& agreement,
                       const ArtefactInfo& info) {
  json body = {{"detections", json::array()},
               {"tracks", json::array()},
               {"objects", json::array()},
               {"agreement", AgreementToJson(agreement)}};
  for (size_t i = 0; i < association.detections.size(); ++i) {
    body["detections"].push_back(DecisionToJson(sequence, association, static_cast<int>(i)));
  }
  for (size_t i = 0; i < association.tracks.size(); ++i) {
    body["tracks"].push_back(TrackToJson(association.tracks[i], static_cast<int>(i)));
  }
  for (size_t i = 0; i < association.objects.size(); ++i) {
    body["objects"].push_back(AssociatedObjectToJson(sequence, association, agreement, i));
  }
  WriteArtefact(path, "associations", info, std::move(body));
}

}  // namespace soslam
