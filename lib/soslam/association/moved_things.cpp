// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/moved_things.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "soslam/base/text.h"
#include "soslam/geometry/angles.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

// Probability that a pair of objects which is never seen at the same time is one thing, before
// their places are looked at.
constexpr double kMoved = 0.01;

// -log of the probability that the detector misses an object in all of so many frames that should
// show it: beta-binomial, as what makes it miss one makes it miss the next (docs/association.md has
// the curve).
double CostOfMisses(int frames) {
  constexpr double kDetected = 1.5, kMissed = 0.5;
  return std::lgamma(kMissed) - std::lgamma(kMissed + frames) +
         std::lgamma(kDetected + kMissed + frames) - std::lgamma(kDetected + kMissed);
}

// True if the camera of a frame sees the track's body as that of one of its detections: from about
// the same direction and distance, so that what hides it in the one hides it in the other.
bool IsSeenAlike(const AssociationModel& model, const Track& track, int frame_index) {
  constexpr double kAlike = 10.0 * kRadPerDeg;
  constexpr double kAlikeDistances = 0.8;
  const Sequence& sequence = model.sequence();
  const auto view = [&](int frame) -> Eigen::Vector3d {
    return sequence.frames[frame].world_from_camera.translation -
           track.fit->landmark_in_world.Centre();
  };
  const Eigen::Vector3d miss = view(frame_index);
  return std::ranges::any_of(track.detections, [&](int index) {
    const Eigen::Vector3d seen = view(model.DetectionAt(index).frame_index);
    const double ratio = seen.norm() / miss.norm();
    return std::min(ratio, 1.0 / ratio) >= kAlikeDistances &&
           seen.dot(miss) >= std::cos(kAlike) * seen.norm() * miss.norm();
  });
}

}  // namespace

std::vector<MovedThing> FindMovedThings(const AssociationModel& model,
                                        const Association& association) {
  const Sequence& sequence = model.sequence();
  const auto track_of = [&](size_t object) -> const Track& {
    return association.tracks[association.objects[object]];
  };
  struct Seen {
    int first, last;         // frames
    std::vector<int> empty;  // frames that show its place without it
  };
  std::vector<Seen> seen;
  for (size_t i = 0; i < association.objects.size(); ++i) {
    const Track& track = track_of(i);
    std::vector<int> frames;
    for (const int box : track.boxes) frames.push_back(model.DetectionAt(box).frame_index);
    const auto [first, last] = std::ranges::minmax(frames);
    seen.push_back({first, last, {}});
    for (const Miss& miss : FindMisses(model, track)) {
      // A box of the frame, also one that is not used, may be of what stands at the outline.
      constexpr double kLeastOverlap = 0.2;
      const auto is_at_outline = [&](const auto& detection) {
        return detection.frame_index == miss.frame_index &&
               BoxOverlap(detection.box, miss.outline) >= kLeastOverlap;
      };
      const bool is_taken = std::ranges::any_of(sequence.detections, is_at_outline) ||
                            std::ranges::any_of(sequence.rejected, is_at_outline);
      if (!is_taken && IsSeenAlike(model, track, miss.frame_index)) {
        seen.back().empty.push_back(miss.frame_index);
      }
    }
  }
  std::vector<MovedThing> moved;
  for (size_t i = 0; i < seen.size(); ++i) {
    for (size_t j = 0; j < seen.size(); ++j) {
      if (seen[i].last >= seen[j].first ||
          !AreSameLabel(LabelOf(track_of(i)), LabelOf(track_of(j)))) {
        continue;
      }
      const auto left = static_cast<int>(
          std::ranges::count_if(seen[i].empty, [&](int frame) { return frame >= seen[j].first; }));
      const auto not_yet = static_cast<int>(
          std::ranges::count_if(seen[j].empty, [&](int frame) { return frame <= seen[i].last; }));
      const double log_odds =
          std::log(kMoved / (1.0 - kMoved)) + CostOfMisses(left) + CostOfMisses(not_yet);
      if (left == 0 || not_yet == 0 || log_odds < 0.0) continue;
      moved.push_back({static_cast<int>(i), static_cast<int>(j), left, not_yet,
                       1.0 / (1.0 + std::exp(-log_odds))});
    }
  }
  std::ranges::stable_sort(moved, std::ranges::greater(), &MovedThing::probability);
  return moved;
}

std::vector<Finding> CheckMovedThings(const Sequence& sequence, const Association& association) {
  if (association.moved_things.empty()) return {};
  const auto in_words = [&](int object) {
    const Track& track = association.tracks[association.objects[object]];
    const auto frame_id = [&](int box) { return sequence.FrameOf(sequence.detections[box]).id; };
    return fmt::format("{} (object {}, in frames {} to {})", LabelOf(track), object + 1,
                       frame_id(track.detections.front()), frame_id(track.detections.back()));
  };
  std::vector<std::string> pairs;
  for (const MovedThing& moved : association.moved_things) {
    pairs.push_back(fmt::format(
        "{} and {} are one thing that was moved, with a probability of {:.0f} %: {} show the first "
        "place without it then, and {} the second one before",
        in_words(moved.object), in_words(moved.later_object), 100.0 * moved.probability,
        Counted(moved.frames_left, "image"), Counted(moved.frames_not_yet, "image")));
  }
  return {{"moved_things", Severity::kWarning, fmt::format("{}", fmt::join(pairs, "; ")),
           "things that stand still", "somebody moved them between two images",
           "read them as two places of one thing, or make maps of the images before and after"}};
}

}  // namespace soslam
