// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <set>
#include <utility>
#include <vector>

#include "soslam/model/image_matches.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Evidence of pictures for two boxes being of one object. A point of the object is in its boxes
// wherever it is seen, a point behind it soon leaves them.
//
// N points are in at least one of two boxes and seen in both frames, n of them are in both boxes.
// For boxes of one object n is beta-binomial, as points of one box are not independent; for others,
// too, with other parameters (docs/association.md has the curves).
//
// Colours of two boxes tell objects apart, but equal ones do not make them one.
class PairEvidence {
 public:
  PairEvidence() = default;  // no pair has evidence
  // The sequence's detections are named by their index.
  PairEvidence(const Sequence& sequence, const ImageMatches& matches);

  struct Counts {
    int in_both = 0;
    int in_any = 0;
  };
  // Symmetric in its arguments, which are detections of different frames.
  Counts CountPoints(int detection, int other) const;

  // True if the detections are of two frames that share a point; others tell nothing of each other.
  bool AreLinked(int detection, int other) const;

  // Logarithms of likelihood ratios of one object against two, by points and by colours, times the
  // weight of the pair: a detection is compared by the same points and colours with those of many
  // frames, so that all of its pairs together count as one comparison.
  double LogRatioOfPoints(int detection, int other) const;
  double LogRatioOfColours(int detection, int other) const;
  double LogRatio(int detection, int other) const {
    return LogRatioOfPoints(detection, other) + LogRatioOfColours(detection, other);
  }
  // The sum over all pairs of one of each list, in different frames; both are ordered by frame.
  double LogRatio(const std::vector<int>& detections, const std::vector<int>& others) const;

 private:
  struct PointsOfDetection {
    int frame_index = 0;
    std::map<int, int> shared;    // number of points in another detection's box, too; by its index
    std::map<int, int> in_frame;  // number of points that another frame shows, by its index
  };
  std::vector<PointsOfDetection> detections_;
  std::vector<Eigen::VectorXf> colours_;      // unit vectors; empty: none
  std::vector<std::set<int>> linked_frames_;  // frames that show a point of a frame, by its index
};

// Logarithm of the likelihood ratio of these counts, of one object against two.
double LogRatioOfSharedPoints(const PairEvidence::Counts& counts);

// Logarithm of the likelihood ratio of two colours with this scalar product, of one object against
// two of the same label; none above zero.
double LogRatioOfColours(double product);

}  // namespace soslam
