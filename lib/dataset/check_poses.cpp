// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "dataset/dataset_checks.h"
#include "dataset/pose_readings.h"
#include "dataset/tracked_rays.h"

namespace soslam {
namespace {

constexpr double kDegPerRad = 180.0 / std::numbers::pi;

std::optional<Rigid3d> PoseAt(const ImportView& view, size_t frame) {
  if (frame >= view.content.frames.size()) return std::nullopt;
  const ListedFrame& listed = view.content.frames[frame];
  return listed.has_pose ? std::optional(listed.frame.world_from_camera) : std::nullopt;
}

std::string ErrorInWords(double error_rad) {
  return fmt::format("{:.2f} degrees", kDegPerRad * error_rad);
}

// Poses that mean something else than they are read as make things fly apart; as they are meant,
// things are to within a degree where they are seen.
std::vector<Finding> CheckReadings(const ImportView& view,
                                   const std::vector<std::vector<TrackedRay>>& things,
                                   double as_read) {
  constexpr double kFits = 1.0 / kDegPerRad;
  constexpr double kMuchBetter = 0.25;
  const PoseReading* best = nullptr;
  double best_error = std::min(kFits, kMuchBetter * as_read);
  for (const PoseReading& reading : PoseReadings()) {
    const auto error = MedianRayError(things, [&](size_t frame) -> std::optional<Rigid3d> {
      const auto pose = PoseAt(view, frame);
      return pose ? std::optional(reading.Apply(*pose)) : std::nullopt;
    });
    if (!error || *error >= best_error) continue;
    best = &reading;
    best_error = *error;
  }
  if (as_read <= kFits || best == nullptr) return {};
  return {
      {"pose_convention", Severity::kError,
       fmt::format("things are {} from where they are seen (median), but {} if the poses are {}",
                   ErrorInWords(as_read), ErrorInWords(best_error), best->name),
       "poses world_from_camera, camera z forward, quaternion qx qy qz qw", best->cause,
       best->remedy}};
}

// Boxes that are one image late or early: things are clearly nearer to where they are seen one way,
// and farther off the other way. That the first image has no box says so, too.
std::vector<Finding> CheckFrameNumbers(const ImportView& view,
                                       const std::vector<std::vector<TrackedRay>>& things,
                                       double as_read) {
  constexpr double kClearlyBetter = 0.7;
  constexpr double kBetter = 0.85;
  const auto error_at = [&](int shift) {
    return MedianRayError(things, [&](size_t frame) {
      return PoseAt(view, static_cast<size_t>(static_cast<std::ptrdiff_t>(frame) + shift));
    });
  };
  const bool is_first_empty = std::ranges::none_of(
      view.content.rows, [](const DetectionRow& row) { return row.frame_id == 0; });
  for (const int shift : {-1, 1}) {
    const auto error = error_at(shift);
    const auto opposite = error_at(-shift);
    const double share = shift < 0 && is_first_empty ? kBetter : kClearlyBetter;
    if (!error || !opposite || *error >= share * as_read || *opposite <= as_read) continue;
    const bool is_late = shift < 0;
    return {
        {"frame_numbers", Severity::kWarning,
         fmt::format("things are {} from where they are seen (median), but {} if each box is of "
                     "the image {} the one that it names",
                     ErrorInWords(as_read), ErrorInWords(*error), is_late ? "before" : "after"),
         "frames that are rows of the list of images, from 0",
         is_late ? "frames counted from 1" : "frames that begin one image late",
         is_late ? "subtract 1 from the frames of the detections"
                 : "add 1 to the frames of the detections"}};
  }
  return {};
}

}  // namespace

std::vector<Finding> CheckPoses(const ImportView& view) {
  constexpr size_t kFewestRays = 15;
  const auto things = TrackedRays(view);
  size_t rays = 0;
  for (const auto& thing : things) rays += thing.size();
  if (rays < kFewestRays) return {};
  const auto as_read = MedianRayError(things, [&](size_t frame) { return PoseAt(view, frame); });
  if (!as_read) return {};
  std::vector<Finding> findings = CheckReadings(view, things, *as_read);
  if (findings.empty()) findings = CheckFrameNumbers(view, things, *as_read);
  return findings;
}

}  // namespace soslam
