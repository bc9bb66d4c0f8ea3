// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "evaluation/map_quality.h"

namespace soslam {

// Creates the rows of MapQuality.
class RowMaker {
 public:
  // The arguments must outlive this object.
  RowMaker(const Sequence& sequence, const AlignedMap& map, const TrueViews& views);

  // One for each landmark: found as `input` matches it; otherwise ignored if things are there that
  // are ignored and it is not to blame for a wanted object, or false, with the reason.
  std::vector<LandmarkRow> Rows(const ReasonInput& input) const;

 private:
  LandmarkRow Found(size_t landmark, int true_index) const;
  LandmarkRow NotFound(const ReasonInput& input, size_t landmark) const;
  // Compares the row's landmark with its true object in the world.
  void CompareInWorld(size_t landmark, LandmarkRow* row) const;
  // Compares them in the frames of its observations, if the true object's place there is known.
  void CompareInFrames(size_t landmark, LandmarkRow* row) const;
  std::optional<bool> MostIdsAgree(const LandmarkRow& row) const;

  const Sequence& sequence_;
  const AlignedMap& map_;
  const TrueViews& views_;
  std::vector<std::vector<int>> detections_;  // by object
};

}  // namespace soslam
