// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/dataset_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <set>
#include <span>

#include "soslam/base/text.h"
#include "soslam/dataset/gate.h"
#include "soslam/model/moving_things.h"
#include "soslam/model/reasons.h"

namespace soslam {

std::vector<Finding> CheckDataset(const ImportView& view) {
  std::vector<Finding> findings = view.content.findings;
  using Check = std::vector<Finding> (*)(const ImportView&);
  const auto add = [&](std::initializer_list<Check> checks) {
    for (const Check check : checks) std::ranges::move(check(view), std::back_inserter(findings));
  };
  const auto has = [&](auto field, const auto& value) {
    return std::ranges::find(findings, value, field) != findings.end();
  };
  add({&CheckCamera, &CheckImages, &CheckBoxes, &CheckRepeatedPoses});
  // Boxes with a wrong camera, and wrong boxes, contradict even the best poses; wrong poses
  // contradict objects and planes. Poses that a tracker repeats lag by as long as it was lost.
  DatasetContent content = view.content;
  if (has(&Finding::check, kRepeatedPoses)) {
    for (size_t i = 0; i < content.frames.size(); ++i) {
      if (RepeatsPose(view.content.frames, i)) content.frames[i].has_pose = false;
    }
  }
  if (!has(&Finding::severity, Severity::kError)) {
    const ImportView without_repeated = {view.folder, view.options, content, view.sequence};
    std::ranges::move(CheckPoses(without_repeated), std::back_inserter(findings));
  }
  if (!has(&Finding::severity, Severity::kError) && !has(&Finding::check, kPoseConvention)) {
    const size_t before = findings.size();
    add({&CheckObjects, &CheckPlanes});
    if (has(&Finding::check, kBoxesAgainstPoses) || has(&Finding::check, kFrameOrder) ||
        has(&Finding::check, kPoseLag)) {
      for (Finding& finding : std::span(findings).subspan(before)) {
        finding.cause = "what contradicts the boxes, rather than objects or planes";
        finding.remedy = "mend poses, order of frames or ids first";
      }
    }
    add({&CheckObjectAxes});
  }
  add({&CheckTruth, &CheckScores, &CheckClassNumbers, &CheckBlankLines, &CheckLabels,
       &CheckRejections, [](const ImportView& view) { return CheckMovingThings(view.sequence); }});
  return WorstFirst(std::move(findings));
}

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

Advice AdviceOnUnit(const char* what, const TimeUnit& unit, const std::string& file) {
  return {fmt::format("{} in {}, which are taken for seconds", what, unit.name),
          fmt::format("divide the time stamps of {} by {:.0e}", file, unit.per_second)};
}

// True if nearly every image has a pose of its own, and every pose an image, once the times of the
// images are stretched to those of the poses.
bool HaveOtherRate(const std::vector<double>& times, const std::vector<TimedPose>& trajectory,
                   const TimeRange& images, const TimeRange& poses) {
  constexpr double kNearlyAll = 0.9;
  constexpr double kSameRate = 0.1;
  constexpr double kShareOfStep = 0.1;
  constexpr size_t kFewest = 10;
  if (!(images.Span() > 0.0 && poses.Span() > 0.0)) return false;
  const double rate = poses.Span() / images.Span();
  if (std::abs(rate - 1.0) < kSameRate) return false;
  const double tolerance = kShareOfStep * poses.Span() / static_cast<double>(trajectory.size());
  std::set<double> used;  // times of the poses
  for (const double time : times) {
    const double stretched = poses.first + rate * (time - images.first);
    if (const auto pose = NearestPose(trajectory, stretched, tolerance)) {
      used.insert(pose->timestamp);
    }
  }
  const auto most = static_cast<double>(std::max(times.size(), trajectory.size()));
  return used.size() >= kFewest && static_cast<double>(used.size()) >= kNearlyAll * most;
}

// For images most of which have no pose of their time.
Advice AdviceOnTimes(const TimeRange& images, const TimeRange& poses, bool have_other_rate,
                     const std::string& file) {
  if (const auto* unit = UnitBetween(images, poses)) return AdviceOnUnit("poses", *unit, file);
  if (const auto* unit = UnitBetween(poses, images)) {
    return AdviceOnUnit("images", *unit, "the list of images");
  }
  if (const auto* unit = UnitOfClock(images.first); unit && UnitOfClock(poses.first)) {
    return AdviceOnUnit("images and poses", *unit, "both files");
  }
  if (have_other_rate) {
    const double rate = poses.Span() / images.Span();
    return {fmt::format("a clock of the poses that runs {:.4g} times as fast as that of the "
                        "images, as with time stamps in another unit",
                        rate),
            fmt::format("write the time stamps t of {} as {:.3f} + (t - {:.3f}) / {:.4g}", file,
                        images.first, poses.first, rate)};
  }
  if (images.last < poses.first || poses.last < images.first) {
    return {"other clocks, or another recording",
            fmt::format("give {} the clock of the images (the first stamps are {:.3f} apart)", file,
                        poses.first - images.first)};
  }
  return {"poses of other images, as of keyframes only",
          "give the images' own time stamps, or set max_time_difference_s"};
}

}  // namespace

std::vector<Finding> CheckTimestamps(const std::vector<ListedImage>& images,
                                     const std::vector<TimedPose>& trajectory,
                                     const std::string& trajectory_file, double max_difference_s) {
  std::vector<double> times;
  for (const ListedImage& image : images) times.push_back(image.timestamp);
  std::vector<Finding> findings;
  const size_t repeated = times.size() - std::set<double>(times.begin(), times.end()).size();
  if (repeated > 0) {
    findings.push_back(
        {"equal_timestamps", Severity::kWarning,
         fmt::format("{} of {} images have the time stamp of another one", repeated, times.size()),
         "a time stamp for each image, as images of one time take the same pose",
         "stamps with too few digits, or in whole seconds", "write stamps with all their digits"});
  }
  size_t matched = 0;
  std::set<double> used;  // times of the poses
  for (const double time : times) {
    const auto pose = NearestPose(trajectory, time, max_difference_s);
    if (!pose) continue;
    ++matched;
    used.insert(pose->timestamp);
  }
  if (2 * matched >= times.size()) return findings;
  const auto [first, last] = std::ranges::minmax(times);
  const TimeRange of_images{first, last};
  const TimeRange of_poses{trajectory.front().timestamp, trajectory.back().timestamp};
  std::string found = fmt::format(
      "{} of {} images have a pose of {} within {:g}: images are of time {}, poses of {}", matched,
      times.size(), trajectory_file, max_difference_s, InWords(of_images), InWords(of_poses));
  if (of_images.Span() > 0.0 && of_poses.Span() > 0.0) {
    found += fmt::format(" (spans {:.3g} and {:.3g}, ratio {:.3g})", of_images.Span(),
                         of_poses.Span(), of_poses.Span() / of_images.Span());
  }
  const bool have_other_rate = HaveOtherRate(times, trajectory, of_images, of_poses);
  const bool are_of_part = !have_other_rate && used.size() == trajectory.size();
  const Advice advice =
      are_of_part
          ? Advice{"poses of a part of the images, as of keyframes, or of a model of some of them",
                   "give poses of all images, as those without one are not used"}
          : AdviceOnTimes(of_images, of_poses, have_other_rate, trajectory_file);
  findings.push_back(
      {"timestamps", matched == 0 || have_other_rate ? Severity::kError : Severity::kWarning, found,
       are_of_part ? "a pose for each image" : "images and poses of one clock, in seconds",
       advice.cause, advice.remedy});
  return findings;
}

std::vector<Finding> CheckLabels(const ImportView& view) {
  std::set<std::string> known;
  for (const DetectionRow& row : view.content.rows) known.insert(row.label);
  for (const auto& [row, reason] : view.content.rejected.rows) known.insert(row.label);
  for (const TrueObject& object : view.sequence.true_objects) known.insert(object.label);
  const std::vector<std::string> labels(known.begin(), known.end());
  std::vector<std::string> missing;
  for (const std::string_view label : SplitFields(view.options.labels)) {
    if (label.empty() || known.contains(std::string(label))) continue;
    const auto likely = LikelyMeant(LowerCase(std::string(label)), labels);
    missing.push_back(std::string(label) + (likely ? " (" + *likely + "?)" : ""));
  }
  if (missing.empty() || known.empty()) return {};
  return {{"labels", Severity::kWarning,
           fmt::format("no box has the label {} of `labels`", NamesInWords(missing, 10)),
           "labels of boxes: " + NamesInWords(labels, 10),
           "a misspelt label, or one that is not seen", "write labels as the boxes have them"}};
}

std::vector<Finding> CheckRejections(const ImportView& view) {
  constexpr int kFewest = 10;
  // Each image has its own world.
  if (view.options.format == DatasetFormat::kKittiObject) return {};
  auto all = static_cast<int>(view.sequence.detections.size());  // that reach the gates of data
  for (const auto& [code, count] : view.sequence.rejected_detections) {
    if (!ReasonOf(code).remedy.empty()) all += count;
  }
  std::vector<Finding> findings;
  for (const auto& [code, count] : view.sequence.rejected_detections) {
    const Reason reason = ReasonOf(code);
    if (reason.remedy.empty() || all < kFewest || 3 * count <= all) continue;
    findings.push_back({"rejected_" + code, Severity::kWarning,
                        fmt::format("{} of {} detections are dropped as {}", count, all, code),
                        "at most a third dropped for one reason", reason.cause, reason.remedy});
  }
  return findings;
}

}  // namespace soslam
