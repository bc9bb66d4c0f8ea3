// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/pair_evidence.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "soslam/image/undistorted_points.h"
#include "soslam/model/occlusion.h"

namespace soslam {
namespace {

// Beta distribution of the share of points that are in both boxes, from rendered scenes with boxes
// of visible parts (docs/association.md).
struct ShareOfPoints {
  double in_both;
  double in_one;
};
constexpr ShareOfPoints kOfOneObject = {2.0, 0.7};
constexpr ShareOfPoints kOfTwoObjects = {0.06, 3.0};

double LogBeta(double a, double b) { return std::lgamma(a) + std::lgamma(b) - std::lgamma(a + b); }

// Logarithm of the beta-binomial probability, but for the binomial coefficient.
double LogProbability(const PairEvidence::Counts& counts, const ShareOfPoints& share) {
  return LogBeta(counts.in_both + share.in_both, counts.in_any - counts.in_both + share.in_one) -
         LogBeta(share.in_both, share.in_one);
}

}  // namespace

double LogRatioOfSharedPoints(const PairEvidence::Counts& counts) {
  return LogProbability(counts, kOfOneObject) - LogProbability(counts, kOfTwoObjects);
}

double LogRatioOfColours(double product) {
  // Logistic regression over rendered scenes (docs/association.md): at no angle, per rad.
  constexpr double kEqual = 3.7, kSlope = -9.1;
  return std::min(0.0, kEqual + kSlope * std::acos(std::min(product, 1.0)));
}

PairEvidence::PairEvidence(const Sequence& sequence, const ImageMatches& matches)
    : detections_(sequence.detections.size()), linked_frames_(sequence.frames.size()) {
  for (const BoxColours& colours : matches.colours) {
    colours_.push_back(colours.cast<float>().normalized());
  }
  for (size_t i = 0; i < detections_.size(); ++i) {
    detections_[i].frame_index = sequence.detections[i].frame_index;
  }
  struct Sight {
    int frame_index;
    std::vector<int> detections;  // whose boxes have the point
  };
  for (const PointTrack& track : matches.tracks) {
    std::vector<Sight> sights;
    for (const PointObservation& observation : track.observations) {
      const auto frame = FindFrameIndex(sequence, observation);
      const auto pixel = UndistortedPixel(sequence, observation);
      if (!frame || !pixel) continue;
      sights.push_back({static_cast<int>(*frame), {}});
      Sight& sight = sights.back();
      for (const Detection& detection : DetectionsIn(sequence, sight.frame_index)) {
        const Box& box = detection.box;
        if (pixel->x() >= box.x_min && pixel->x() <= box.x_max && pixel->y() >= box.y_min &&
            pixel->y() <= box.y_max) {
          sight.detections.push_back(static_cast<int>(&detection - sequence.detections.data()));
        }
      }
    }
    for (const Sight& sight : sights) {
      for (const Sight& other : sights) {
        if (other.frame_index == sight.frame_index) continue;
        linked_frames_[sight.frame_index].insert(other.frame_index);
        for (const int detection : sight.detections) {
          ++detections_[detection].in_frame[other.frame_index];
          for (const int in_other : other.detections) ++detections_[detection].shared[in_other];
        }
      }
    }
  }
}

PairEvidence::Counts PairEvidence::CountPoints(int detection, int other) const {
  if (detections_.empty()) return {};
  const auto count_in = [](const std::map<int, int>& counts, int index) {
    const auto found = counts.find(index);
    return found == counts.end() ? 0 : found->second;
  };
  const PointsOfDetection &one = detections_[detection], &two = detections_[other];
  const int in_both = count_in(one.shared, other);
  return {in_both, count_in(one.in_frame, two.frame_index) +
                       count_in(two.in_frame, one.frame_index) - in_both};
}

bool PairEvidence::AreLinked(int detection, int other) const {
  return !detections_.empty() && linked_frames_[detections_[detection].frame_index].contains(
                                     detections_[other].frame_index);
}

double PairEvidence::LogRatioOfPoints(int detection, int other) const {
  const Counts counts = CountPoints(detection, other);
  if (counts.in_any == 0) return 0.0;
  const double frames = std::sqrt(static_cast<double>(detections_[detection].in_frame.size()) *
                                  static_cast<double>(detections_[other].in_frame.size()));
  // Each pair is a comparison of both of its detections.
  return LogRatioOfSharedPoints(counts) * std::min(1.0, 2.0 / frames);
}

double PairEvidence::LogRatioOfColours(int detection, int other) const {
  if (colours_.empty() || !AreLinked(detection, other)) return 0.0;
  const std::set<int>& linked = linked_frames_[detections_[detection].frame_index];
  const std::set<int>& linked_to_other = linked_frames_[detections_[other].frame_index];
  const double frames = std::sqrt(static_cast<double>(linked.size() * linked_to_other.size()));
  return soslam::LogRatioOfColours(colours_[detection].dot(colours_[other])) *
         std::min(1.0, 2.0 / frames);
}

double PairEvidence::LogRatio(const std::vector<int>& detections,
                              const std::vector<int>& others) const {
  double sum = 0.0;
  if (detections_.empty()) return sum;
  const auto frame_of = [this](int detection) { return detections_[detection].frame_index; };
  const auto sum_of_pairs = [&](int detection, int frame) {
    auto other = std::ranges::lower_bound(others, frame, {}, frame_of);
    for (; other != others.end() && frame_of(*other) == frame; ++other) {
      sum += LogRatio(detection, *other);
    }
  };
  for (const int detection : detections) {
    for (const int frame : linked_frames_[frame_of(detection)]) sum_of_pairs(detection, frame);
  }
  return sum;
}

}  // namespace soslam
