// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/check_lag.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "dataset/dataset_checks.h"
#include "dataset/tracked_rays.h"
#include "evaluation/statistics.h"
#include "geometry/rigid3.h"

namespace soslam {
namespace {

// Poses over time, interpolated between time stamps, of each segment.
class PoseCurves {
 public:
  explicit PoseCurves(const std::vector<ListedFrame>& frames) {
    for (const ListedFrame& listed : frames) {
      if (!listed.has_pose) continue;
      const double time = listed.pose_timestamp.value_or(listed.frame.timestamp);
      curves_[listed.frame.segment].emplace(time, listed.frame.world_from_camera);
    }
  }

  // None outside the segment's poses.
  std::optional<Rigid3d> At(int segment, double time) const {
    const auto found = curves_.find(segment);
    if (found == curves_.end()) return std::nullopt;
    const auto after = found->second.lower_bound(time);
    if (after == found->second.end()) return std::nullopt;
    if (after->first == time) return after->second;
    if (after == found->second.begin()) return std::nullopt;
    const auto before = std::prev(after);
    const double share = (time - before->first) / (after->first - before->first);
    const Rigid3d &one = before->second, &other = after->second;
    return Rigid3d{one.rotation.slerp(share, other.rotation),
                   one.translation + share * (other.translation - one.translation)};
  }

 private:
  std::map<int, std::map<double, Rigid3d>> curves_;
};

// How rays meet if each image has the pose of so many seconds later.
class ShiftedPoses {
 public:
  ShiftedPoses(const ImportView& view, const std::vector<TrackedObject>& objects)
      : frames_(view.content.frames), objects_(objects), curves_(frames_) {}

  std::optional<RayError> ErrorAt(double shift_s) const {
    std::vector<std::optional<Rigid3d>> poses;
    for (const ListedFrame& listed : frames_) {
      poses.push_back(curves_.At(listed.frame.segment, listed.frame.timestamp + shift_s));
    }
    return MedianRayError(objects_, [&](size_t frame) { return poses[frame]; });
  }

 private:
  const std::vector<ListedFrame>& frames_;
  const std::vector<TrackedObject>& objects_;
  PoseCurves curves_;
};

// A constant time between poses and images.
struct Lag {
  double seconds = 0.0;  // by which poses are stamped late
  double images = 0.0;   // the same in intervals between images
  RayError error;        // of poses from which the lag is taken
  RayError with_lag;     // of poses interpolated at the time stamps of images
};

// Median time between consecutive frames; 0 if there are none.
double MedianInterval(const std::vector<ListedFrame>& frames) {
  std::vector<double> intervals;
  for (size_t i = 1; i < frames.size(); ++i) {
    const Frame &last = frames[i - 1].frame, &frame = frames[i].frame;
    if (frame.segment == last.segment) intervals.push_back(frame.timestamp - last.timestamp);
  }
  return MedianOf(intervals).value_or(0.0);
}

double LongestSegment(const std::vector<ListedFrame>& frames) {
  std::map<int, std::pair<double, double>> times;  // first and last, by segment
  double longest = 0.0;
  for (const ListedFrame& listed : frames) {
    const double time = listed.frame.timestamp;
    auto& [first, last] = times.try_emplace(listed.frame.segment, time, time).first->second;
    first = std::min(first, time);
    last = std::max(last, time);
    longest = std::max(longest, last - first);
  }
  return longest;
}

// True if an error is clearly smaller than that of the poses as they are read.
bool IsClearlyBetter(const RayError& error, const RayError& as_read, double share) {
  constexpr double kLeastDeg = 0.02;
  constexpr double kFitsDeg = 2.0;
  return error.median_deg <
         std::min({share * as_read.median_deg, as_read.median_deg - kLeastDeg, kFitsDeg});
}

constexpr double kClearlyBetter = 0.7;

// The lag with which rays meet best, if they do so clearly better than without, and worse with the
// opposite one.
std::optional<Lag> FindLag(const ImportView& view, const std::vector<TrackedObject>& objects,
                           const RayError& as_read) {
  constexpr double kMostOfSequence = 0.2;
  constexpr double kMostSteps = 100.0;  // in each direction
  constexpr int kRefinements = 3;
  constexpr double kAsWell = 1.1;
  const double interval_s = MedianInterval(view.content.frames);
  const double range_s = kMostOfSequence * LongestSegment(view.content.frames);
  if (!(interval_s > 0.0) || range_s < interval_s) return std::nullopt;
  const ShiftedPoses shifted(view, objects);
  const auto with_lag = shifted.ErrorAt(0.0);
  if (!IsComparable(with_lag, as_read)) return std::nullopt;
  Lag best{0.0, 0.0, *with_lag, *with_lag};
  const auto consider = [&](double shift_s) {
    const auto error = shifted.ErrorAt(shift_s);
    if (!IsComparable(error, as_read) || error->median_deg >= best.error.median_deg) return;
    best = {shift_s, shift_s / interval_s, *error, *with_lag};
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
  const auto with_whole = shifted.ErrorAt(whole * interval_s);
  if (IsComparable(with_whole, as_read) &&
      with_whole->median_deg <= kAsWell * best.error.median_deg) {
    best = {whole * interval_s, whole, *with_whole, *with_lag};
  }
  const auto opposite = shifted.ErrorAt(-best.seconds);
  if (!IsClearlyBetter(best.error, *with_lag, kClearlyBetter) || !IsComparable(opposite, as_read) ||
      opposite->median_deg <= with_lag->median_deg) {
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
  const auto error_at = [&](int shift) {
    return MedianRayError(objects, [&](size_t frame) {
      return PoseOfOther(view, frame, frame + static_cast<size_t>(shift));  // wraps before 0
    });
  };
  const int first_id = view.content.frames.front().frame.id;
  const bool is_first_empty = std::ranges::none_of(
      view.content.rows, [&](const DetectionRow& row) { return row.frame_id == first_id; });
  for (const int shift : {-1, 1}) {
    const auto error = error_at(shift);
    const auto opposite = error_at(-shift);
    if (!IsComparable(error, as_read) || !IsComparable(opposite, as_read)) continue;
    const double share = shift < 0 && is_first_empty ? kBetter : kClearlyBetter;
    if (!IsClearlyBetter(*error, as_read, share) || opposite->median_deg <= as_read.median_deg) {
      continue;
    }
    const bool is_late = shift < 0;
    return {
        {"frame_numbers", Severity::kWarning,
         fmt::format("things are {:.2f} degrees from where they are seen (median), but {:.2f} if "
                     "each box is of the image {} the one that it names",
                     as_read.median_deg, error->median_deg, is_late ? "before" : "after"),
         "frames that are rows of the list of images, from 0",
         is_late ? "frames counted from 1, or poses that are one image early"
                 : "frames that begin one image late, or poses that are one image late",
         is_late ? "subtract 1 from the frames of the detections"
                 : "add 1 to the frames of the detections"}};
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
                       lag->with_lag.median_deg, lag->error.median_deg, seconds,
                       is_late ? "later" : "earlier", std::abs(lag->images)),
           "images and poses of one clock",
           is_late ? "poses that are stamped late, as by a delay or another clock, or images and "
                     "boxes that are stamped early"
                   : "images and boxes that are stamped late, as by a delay or another clock, or "
                     "poses that are stamped early",
           fmt::format("{} the time stamps of the poses by {:.3g} s", is_late ? "lower" : "raise",
                       seconds)}};
}

}  // namespace soslam
