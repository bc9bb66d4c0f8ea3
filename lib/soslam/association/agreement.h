// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/association/association.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Agreement of the estimated objects with the objects given in the sequence.
struct Agreement {
  // For each estimated object the index of its given object in Sequence::objects. One to one,
  // assigned greedily by the number of shared detections; none when no remaining given object
  // shares a detection.
  std::vector<std::optional<int>> given_of_object;
  // Number of static given objects with at least min_observations detections, and number of pairs
  // of such an object and an estimated one whose intersection over union of detections is above
  // 0.5.
  int given_objects = 0;
  int matched = 0;

  // Shares of the estimated and of the given objects that are matched, and their harmonic mean.
  // Undefined without given objects.
  std::optional<double> Precision() const;
  std::optional<double> Recall() const;
  std::optional<double> F1() const;
};
Agreement CompareWithGiven(const Sequence& sequence, const Association& association,
                           int min_observations);

// How associations.json names a detection (index in Sequence::detections).
Associations::DetectionName NameOfDetection(const Sequence& sequence, int detection);

// The decision and its reason for each detection, track and object. Objects have the ids that
// AssociatedSequence gives them.
Associations MakeReport(const Sequence& sequence, const Association& association,
                        const Agreement& agreement);

// The sequence with the estimated objects (ids from 1) in place of the given ones. Keeps the
// detections of these objects; all others are counted as rejected. Each object takes the ground
// truth of its given object, if that is static, for evaluation.
Sequence AssociatedSequence(const Sequence& sequence, const Association& association,
                            const Agreement& agreement);

}  // namespace soslam
