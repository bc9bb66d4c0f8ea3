// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "dataset/dataset_checks.h"

namespace soslam {
namespace {

// First and last time of a list.
struct TimeRange {
  double first = 0.0;
  double last = 0.0;

  double Span() const { return last - first; }
};

std::string InWords(const TimeRange& range) {
  return fmt::format("{:.3f} to {:.3f}", range.first, range.last);
}

struct TimeUnit {
  const char* name;
  double per_second;
};
constexpr std::array kUnits = {TimeUnit{"milliseconds", 1e3}, TimeUnit{"microseconds", 1e6},
                               TimeUnit{"nanoseconds", 1e9}};

// Time unit in which the second range matches the first one; null when none does.
const TimeUnit* UnitBetween(const TimeRange& seconds, const TimeRange& other) {
  for (const TimeUnit& unit : kUnits) {
    const double tolerance = 0.5 * std::max(seconds.Span(), 1.0);
    if (std::abs(other.first / unit.per_second - seconds.first) <= tolerance &&
        std::abs(other.last / unit.per_second - seconds.last) <= tolerance) {
      return &unit;
    }
  }
  return nullptr;
}

// Unit of times since 1970 when they are of this century; null for seconds and otherwise.
const TimeUnit* UnitOfClock(double time) {
  constexpr double kYear2001 = 1e9;
  constexpr double kYear2100 = 4.1e9;
  for (const TimeUnit& unit : kUnits) {
    const double seconds = time / unit.per_second;
    if (seconds >= kYear2001 && seconds <= kYear2100) return &unit;
  }
  return nullptr;
}

std::string InUnit(const std::string& what, const TimeUnit& unit) {
  return fmt::format("{} in {}, which are taken for seconds", what, unit.name);
}

std::string DivideBy(const std::string& file, const TimeUnit& unit) {
  return fmt::format("divide the time stamps of {} by {:.0e}", file, unit.per_second);
}

// Fills in cause and remedy for time stamps that do not overlap.
void Explain(const TimeRange& images, const TimeRange& poses, const std::string& file,
             Finding* finding) {
  constexpr const char* kBoth = "both files";
  if (const TimeUnit* unit = UnitBetween(images, poses)) {
    finding->cause = InUnit("poses", *unit);
    finding->remedy = DivideBy(file, *unit);
  } else if (const TimeUnit* image_unit = UnitBetween(poses, images)) {
    finding->cause = InUnit("images", *image_unit);
    finding->remedy = DivideBy("the list of images", *image_unit);
  } else if (const TimeUnit* clock = UnitOfClock(images.first); clock && UnitOfClock(poses.first)) {
    finding->cause = InUnit("images and poses", *clock);
    finding->remedy = DivideBy(kBoth, *clock);
  } else if (images.last < poses.first || poses.last < images.first) {
    finding->cause = "other clocks, or another recording";
    finding->remedy =
        fmt::format("give {} the clock of the images (the first stamps are {:.3f} apart)", file,
                    poses.first - images.first);
  } else {
    finding->cause = "poses of other images, as of keyframes only";
    finding->remedy = "give the images' own time stamps, or set max_time_difference_s";
  }
}

std::vector<Finding> CheckEqual(const std::vector<double>& times) {
  const size_t repeated = times.size() - std::set<double>(times.begin(), times.end()).size();
  if (repeated == 0) return {};
  return {
      {"equal_timestamps", Severity::kWarning,
       fmt::format("{} of {} images have the time stamp of another one", repeated, times.size()),
       "a time stamp for each image, as images of one time take the same pose",
       "stamps with too few digits, or in whole seconds", "write stamps with all their digits"}};
}

}  // namespace

std::vector<Finding> CheckTimestamps(const std::vector<ListedImage>& images,
                                     const std::vector<TimedPose>& trajectory,
                                     const std::string& trajectory_file, double max_difference_s) {
  std::vector<double> times;
  for (const ListedImage& image : images) times.push_back(image.timestamp);
  std::vector<Finding> findings = CheckEqual(times);
  const auto matched = std::ranges::count_if(times, [&](double time) {
    return NearestPose(trajectory, time, max_difference_s).has_value();
  });
  if (2 * static_cast<size_t>(matched) >= times.size()) return findings;
  const auto [first, last] = std::ranges::minmax(times);
  const TimeRange of_images{first, last};
  const TimeRange of_poses{trajectory.front().timestamp, trajectory.back().timestamp};
  Finding finding{
      "timestamps",
      matched == 0 ? Severity::kError : Severity::kWarning,
      fmt::format(
          "{} of {} images have a pose of {} within {:g}: images are of time {}, poses of {}",
          matched, times.size(), trajectory_file, max_difference_s, InWords(of_images),
          InWords(of_poses)),
      "images and poses of one clock, in seconds",
      "",
      ""};
  Explain(of_images, of_poses, trajectory_file, &finding);
  if (of_images.Span() > 0.0 && of_poses.Span() > 0.0) {
    finding.found += fmt::format(" (spans {:.3g} and {:.3g}, ratio {:.3g})", of_images.Span(),
                                 of_poses.Span(), of_poses.Span() / of_images.Span());
  }
  findings.push_back(finding);
  return findings;
}

}  // namespace soslam
