// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "association/association.h"
#include "model/sequence.h"

namespace soslam {

// How estimated objects agree with those that the sequence came with.
struct Agreement {
  // The given object of each estimated one, an index into Sequence::objects: pairs that share the
  // most detections first, one to one; none when no detection is shared with any that is left.
  std::vector<std::optional<int>> given_of_object;
  // Given objects that stand still, with at least min_observations detections; pairs of one of
  // these and an estimated object that share more than half of the detections that either has.
  int given_objects = 0;
  int matched = 0;

  // Shares of the estimated and of the given objects that are matched, and their harmonic mean.
  // None without given objects.
  std::optional<double> Precision() const;
  std::optional<double> Recall() const;
  std::optional<double> F1() const;
};
Agreement CompareWithGiven(const Sequence& sequence, const Association& association,
                           int min_observations);

// The sequence with the estimated objects, ids from 1, in place of its own, and the detections that
// are theirs; the others are counted as rejected. Each object takes the ground truth of the given
// one that it agrees with, if that stands still, for evaluation.
Sequence AssociatedSequence(const Sequence& sequence, const Association& association,
                            const Agreement& agreement);

}  // namespace soslam
