// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "soslam/dataset/dataset_checks.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/rigid3.h"

namespace soslam {
namespace {

constexpr double kTooFewRays = std::numeric_limits<double>::infinity();

// The pose at a time, interpolated between those of other times; none outside them.
std::optional<Rigid3d> PoseAt(const std::map<double, Rigid3d>& poses, double time) {
  const auto after = poses.lower_bound(time);
  if (after == poses.end()) return std::nullopt;
  if (after->first == time) return after->second;
  if (after == poses.begin()) return std::nullopt;
  const auto& [time_before, before] = *std::prev(after);
  const double share = (time - time_before) / (after->first - time_before);
  return Rigid3d{before.rotation.slerp(share, after->second.rotation),
                 before.translation + share * (after->second.translation - before.translation)};
}

// The median of an error; infinite where too few rays meet.
double MedianDeg(const std::optional<RayError>& error, const RayError& as_read) {
  return IsComparable(error, as_read) ? error->median_deg : kTooFewRays;
}

constexpr double kClearlyBetter = 0.7;

// True if rays meet clearly better with a shift than without, and worse with the opposite one.
bool IsBetterOneWay(double shifted_deg, double opposite_deg, double unshifted_deg, double share) {
  constexpr double kLeastDeg = 0.02;
  constexpr double kFitsDeg = 2.0;
  return shifted_deg < std::min({share * unshifted_deg, unshifted_deg - kLeastDeg, kFitsDeg}) &&
         opposite_deg > unshifted_deg && opposite_deg < kTooFewRays;
}

// A constant time between poses and images.
struct Lag {
  double seconds = 0.0;       // by which poses are stamped late
  double images = 0.0;        // the same in intervals between images
  double median_deg = 0.0;    // error of poses from which the lag is taken
  double with_lag_deg = 0.0;  // of poses interpolated at the time stamps of images
};

// The lag with which rays meet best, if they do so clearly better than without.
std::optional<Lag> FindLag(const ImportView& view, const std::vector<TrackedObject>& objects,
                           const RayError& as_read) {
  constexpr double kMostOfSequence = 0.2;
  constexpr double kMostSteps = 100.0;  // in each direction
  constexpr int kRefinements = 3;
  constexpr double kAsWell = 1.1;
  std::map<int, std::map<double, Rigid3d>> poses_of_segment;  // by time
  std::vector<double> intervals_s;
  double longest_s = 0.0, begin = 0.0;  // of a segment
  const std::vector<ListedFrame>& frames = view.content.frames;
  for (size_t i = 0; i < frames.size(); ++i) {
    const Frame& frame = frames[i].frame;
    if (const auto pose = frames[i].Pose()) {
      const double time = frames[i].pose_timestamp.value_or(frame.timestamp);
      poses_of_segment[frame.segment].emplace(time, *pose);
    }
    if (i == 0 || frame.segment != frames[i - 1].frame.segment) {
      begin = frame.timestamp;
    } else {
      intervals_s.push_back(frame.timestamp - frames[i - 1].frame.timestamp);
      longest_s = std::max(longest_s, frame.timestamp - begin);
    }
  }
  const double interval_s = MedianOf(intervals_s).value_or(0.0);
  const double range_s = kMostOfSequence * longest_s;
  if (!(interval_s > 0.0) || range_s < interval_s) return std::nullopt;
  // The error if each image has the pose of so many seconds later.
  const auto median_at = [&](double shift_s) {
    std::vector<std::optional<Rigid3d>> poses;
    for (const auto& [frame, has_pose, pose_timestamp] : frames) {
      poses.push_back(PoseAt(poses_of_segment[frame.segment], frame.timestamp + shift_s));
    }
    return MedianDeg(MedianRayError(objects, [&](size_t frame) { return poses[frame]; }), as_read);
  };
  const double with_lag_deg = median_at(0.0);
  if (with_lag_deg == kTooFewRays) return std::nullopt;
  Lag best{0.0, 0.0, with_lag_deg, with_lag_deg};
  const auto consider = [&](double shift_s) {
    const double median_deg = median_at(shift_s);
    if (median_deg >= best.median_deg) return;
    best = {shift_s, shift_s / interval_s, median_deg, with_lag_deg};
  };
  double step_s = std::max(interval_s, range_s / kMostSteps);
  for (double shift_s = step_s; shift_s <= range_s; shift_s += step_s) {
    consider(shift_s);
    consider(-shift_s);
  }
  for (int i = 0; i < kRefinements; ++i) {
    const double middle_s = best.seconds;
    for (const int quarter : {-3, -2, -1, 1, 2, 3}) consider(middle_s + 0.25 * quarter * step_s);
    step_s *= 0.25;
  }
  // Box noise moves the minimum; a whole number of images with which rays meet as well is likelier.
  const double whole = std::round(best.images);
  const double with_whole_deg = median_at(whole * interval_s);
  if (with_whole_deg <= kAsWell * best.median_deg) {
    best = {whole * interval_s, whole, with_whole_deg, with_lag_deg};
  }
  const double opposite_deg = median_at(-best.seconds);
  if (!IsBetterOneWay(best.median_deg, opposite_deg, with_lag_deg, kClearlyBetter)) {
    return std::nullopt;
  }
  return best;
}

// Finds boxes that are one image late or early: rays meet clearly better with a shift in one
// direction, and worse in the other. A first image without boxes confirms it.
std::vector<Finding> CheckFrameNumbers(const ImportView& view,
                                       const std::vector<TrackedObject>& objects,
                                       const RayError& as_read) {
  constexpr double kBetter = 0.85;
  const auto median_at = [&](int shift) {
    const auto pose_of = [&](size_t frame) {
      return PoseOfOther(view, frame, frame + static_cast<size_t>(shift));  // wraps before 0
    };
    return MedianDeg(MedianRayError(objects, pose_of), as_read);
  };
  const int first_id = view.content.frames.front().frame.id;
  const bool is_first_empty = std::ranges::none_of(
      view.content.rows, [&](const DetectionRow& row) { return row.frame_id == first_id; });
  for (const int shift : {-1, 1}) {
    const double median_deg = median_at(shift);
    const double share = shift < 0 && is_first_empty ? kBetter : kClearlyBetter;
    if (!IsBetterOneWay(median_deg, median_at(-shift), as_read.median_deg, share)) continue;
    const bool is_late = shift < 0;
    return {{"frame_numbers", Severity::kWarning,
             fmt::format("things are {:.2f} degrees from where they are seen (median), but {:.2f} "
                         "if each box is of the image {} the one that it names",
                         as_read.median_deg, median_deg, is_late ? "before" : "after"),
             "frames that are rows of the list of images, from 0",
             is_late ? "frames counted from 1, or poses that are one image early"
                     : "frames that begin one image late, or poses that are one image late",
             fmt::format("{} the frames of the detections; if the boxes are on their things in the "
                         "images, {} the time stamps of the poses by the time between two images",
                         is_late ? "subtract 1 from" : "add 1 to", is_late ? "raise" : "lower")}};
  }
  return {};
}

}  // namespace

std::vector<Finding> CheckLag(const ImportView& view, const std::vector<TrackedObject>& objects,
                              const RayError& as_read) {
  constexpr double kAboutAnImage = 0.25;
  const auto lag = FindLag(view, objects, as_read);
  const bool is_other_lag = lag && std::abs(std::abs(lag->images) - 1.0) > kAboutAnImage;
  if (!is_other_lag) {
    std::vector<Finding> findings = CheckFrameNumbers(view, objects, as_read);
    if (!findings.empty() || !lag) return findings;
  }
  const bool is_late = lag->seconds > 0.0;
  const double seconds = std::abs(lag->seconds);
  return {{kPoseLag, Severity::kWarning,
           fmt::format("things are {:.2f} degrees from where they are seen (median), but {:.2f} if "
                       "each image takes the pose of {:.3g} s {} ({:.3g} images)",
                       lag->with_lag_deg, lag->median_deg, seconds, is_late ? "later" : "earlier",
                       std::abs(lag->images)),
           "images and poses of one clock",
           is_late ? "poses that are stamped late, as by a delay or another clock, or images and "
                     "boxes that are stamped early"
                   : "images and boxes that are stamped late, as by a delay or another clock, or "
                     "poses that are stamped early",
           fmt::format("{} the time stamps of the poses by {:.3g} s", is_late ? "lower" : "raise",
                       seconds)}};
}

}  // namespace soslam
