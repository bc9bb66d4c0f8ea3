// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <vector>

#include "dataset/dataset_checks.h"
#include "dataset/pose_readings.h"
#include "evaluation/trajectory_gap.h"

namespace soslam {
namespace {

// Pose pairs of the first segment, as each segment has its own world.
std::vector<PosePair> Pairs(const ImportView& view) {
  std::vector<PosePair> pairs;
  for (const ListedFrame& listed : view.content.frames) {
    if (listed.frame.segment != view.content.frames.front().frame.segment) break;
    const auto& truth = listed.frame.true_world_from_camera;
    if (listed.has_pose && truth) pairs.push_back({listed.frame.world_from_camera, *truth});
  }
  return pairs;
}

std::string InWords(const TrajectoryGap& gap) {
  return fmt::format("{:.2f} m and {:.1f} degrees", gap.translation_m, gap.rotation_deg);
}

std::vector<PosePair> ReadAs(const PoseReading& reading, std::vector<PosePair> pairs) {
  for (PosePair& pair : pairs) pair.estimated = reading.Apply(pair.estimated);
  return pairs;
}

// Pairs after moving the estimated trajectory so that its first pose is the true one.
std::vector<PosePair> AlignedAtFirst(std::vector<PosePair> pairs) {
  const Rigid3d true_from_estimated = pairs.front().truth * pairs.front().estimated.Inverse();
  for (PosePair& pair : pairs) pair.estimated = true_from_estimated * pair.estimated;
  return pairs;
}

void Explain(const std::vector<PosePair>& pairs, double extent_m, Finding* finding) {
  const auto fits = [&](const std::vector<PosePair>& read) {
    return IsDrift(GapOf(read), extent_m) && HaveSameScale(read);
  };
  for (const PoseReading& reading : PoseReadings()) {
    const auto read = ReadAs(reading, pairs);
    if (!fits(read)) continue;
    finding->cause = fmt::format("{} (the gap is {} if the poses are {})", reading.cause,
                                 InWords(GapOf(read)), reading.name);
    finding->remedy = reading.remedy;
    return;
  }
  if (fits(AlignedAtFirst(pairs))) {
    finding->cause = "odometry in a world of its own, as of SLAM, beside a true one";
    finding->remedy = "set align_odometry";
    return;
  }
  for (const PoseReading& reading : PoseReadings()) {
    if (!fits(AlignedAtFirst(ReadAs(reading, pairs)))) continue;
    finding->cause = fmt::format("{}, in a world of its own", reading.cause);
    finding->remedy = fmt::format("{}; set align_odometry", reading.remedy);
    return;
  }
  finding->cause =
      "poses of another recording, of another scale, or with a convention of their own";
  finding->remedy =
      "give poses world_from_camera, in metres, quaternion qx qy qz qw, and set "
      "align_odometry where their world is their own";
}

}  // namespace

std::vector<Finding> CheckTruth(const ImportView& view) {
  constexpr size_t kFewest = 3;
  const std::vector<PosePair> pairs = Pairs(view);
  if (pairs.size() < kFewest) return {};
  const TrajectoryGap gap = GapOf(pairs);
  const double extent_m = ExtentOf(pairs, &PosePair::truth);
  if (AreInOneWorld(pairs)) return {};
  Finding finding{
      "trajectory_against_truth",
      Severity::kWarning,
      fmt::format("estimated and true poses are {} apart (median of {} frames; {} at the "
                  "first one), of a camera that moves by {:.2f} m",
                  InWords(gap), pairs.size(), InWords(GapOf({pairs.front()})), extent_m),
      "two trajectories of one world, apart by no more than drift",
      "",
      ""};
  Explain(pairs, extent_m, &finding);
  return {finding};
}

}  // namespace soslam
