// SPDX-License-Identifier: BSD-3-Clause
#include "association/association.h"

#include <algorithm>

#include "association/association_model.h"
#include "association/link_frames.h"

namespace soslam {
namespace {

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
  Association association = LinkFrames(model, threads);
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
