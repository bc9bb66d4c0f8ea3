// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "model/map_points.h"
#include "model/sequence.h"

namespace soslam {

// Evidence of points that several images show for two boxes being of one object: a point of the
// object is in its boxes wherever it is seen, a point behind it soon leaves them.
//
// N points are in at least one of two boxes and seen in both frames, n of them are in both boxes.
// For boxes of one object n is beta-binomial, as points of one box are not independent; for others,
// too, with other parameters (docs/association.md has the curves).
class SharedPoints {
 public:
  SharedPoints() = default;  // no pair has evidence
  // The sequence's detections are named by their index.
  SharedPoints(const Sequence& sequence, const std::vector<PointTrack>& tracks);

  struct Counts {
    int in_both = 0;
    int in_any = 0;
  };
  // The same for either order. The detections are of different frames.
  Counts CountsOf(int detection, int other) const;

  // Logarithm of the likelihood ratio of one object against two, times the weight of the pair: a
  // detection is compared by the same points with those of many frames, so that all of its pairs
  // together count as one comparison.
  double LogRatio(int detection, int other) const;
  // The sum over all pairs of one of each list, in different frames; both are ordered by frame.
  double LogRatio(const std::vector<int>& detections, const std::vector<int>& others) const;

 private:
  struct PointsOfDetection {
    int frame_index = 0;
    std::map<int, int> shared;    // number of points in another detection's box, too; by its index
    std::map<int, int> in_frame;  // number of points that another frame shows, by its index
  };
  std::vector<PointsOfDetection> detections_;
  std::vector<std::set<int>> linked_frames_;  // frames that show a point of a frame, by its index
};

// Logarithm of the likelihood ratio of these counts, of one object against two.
double LogRatioOfSharedPoints(const SharedPoints::Counts& counts);

}  // namespace soslam
