// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <string>
#include <tuple>

#include "soslam/association/agreement.h"
#include "soslam/association/association.h"
#include "support/random.h"
#include "support/scene.h"

namespace soslam {

// A table that knows no label: cube proportions with a standard deviation of 0.5 in the log ratios.
inline SemanticTable UnknowingTable() {
  SemanticTable table;
  table.default_prior = ShapePrior{{1.0, 1.0}, {0.5, 0.5}, 1.1};
  return table;
}

inline AssociateOptions EstimatedAssociation() {
  AssociateOptions options;
  options.association = AssociationSource::kEstimated;
  return options;
}

// Sorted as sequences are.
inline void SortDetections(Sequence* sequence) {
  std::ranges::stable_sort(sequence->detections, {}, [](const Detection& detection) {
    return std::tuple(detection.frame_index, detection.object_index);
  });
}

// The same detections in the same order, each of an object of its own without ground truth.
inline Sequence WithoutIds(const Sequence& sequence) {
  Sequence hidden = sequence;
  hidden.objects.clear();
  for (size_t i = 0; i < hidden.detections.size(); ++i) {
    const auto given = static_cast<size_t>(hidden.detections[i].object_index);
    const Object& object = sequence.objects[given];
    hidden.objects.push_back({static_cast<int>(i), object.label, object.plane_index, {}});
    hidden.detections[i].object_index = static_cast<int>(i);
  }
  return hidden;
}

// A detection of an object that is seen nowhere else. Detections have to be sorted again.
inline void AddFalseDetection(int frame_index, const Box& box, const std::string& label,
                              Sequence* sequence) {
  const int object_index = static_cast<int>(sequence->objects.size());
  sequence->objects.push_back({sequence->objects.back().id + 1, label, 0, {}});
  const Frame& frame = sequence->frames[frame_index];
  sequence->detections.push_back(
      {frame_index,
       object_index,
       1.0,
       box,
       Transform(frame.world_from_camera.Inverse(), sequence->planes[0].plane_in_world),
       {},
       {}});
}

inline Box RandomBox(const Camera& camera) {
  const double width = RandomUniform(30.0, 150.0);
  const double height = RandomUniform(30.0, 150.0);
  const double x = RandomUniform(0.0, camera.width - 1.0 - width);
  const double y = RandomUniform(0.0, camera.height - 1.0 - height);
  return {x, y, x + width, y + height};
}

// F1 of the objects found in `seen`, whose detections are those of `given` in the same order.
inline double F1(const Sequence& seen, const Sequence& given,
                 const AssociateOptions& options = EstimatedAssociation()) {
  const Association association = Associate(seen, UnknowingTable(), PairEvidence(), options, 2);
  return CompareWithGiven(given, association, options.min_observations).F1().value();
}

}  // namespace soslam
