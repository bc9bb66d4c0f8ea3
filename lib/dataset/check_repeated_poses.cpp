// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "base/text.h"
#include "dataset/dataset_checks.h"
#include "dataset/image_path.h"
#include "dataset/tracked_rays.h"
#include "evaluation/statistics.h"
#include "geometry/angles.h"
#include "image/frame_choice.h"
#include "image/read_image.h"

namespace soslam {
namespace {

// Consecutive frames with the same pose, to the last bit. Indices in DatasetContent::frames.
struct PoseRun {
  size_t first = 0;
  size_t last = 0;
};

std::vector<PoseRun> FindRuns(const std::vector<ListedFrame>& frames) {
  std::vector<PoseRun> runs;
  for (size_t i = 1; i < frames.size(); ++i) {
    if (!RepeatsPose(frames, i)) continue;
    if (runs.empty() || runs.back().last != i - 1) runs.push_back({i - 1, i});
    runs.back().last = i;
  }
  return runs;
}

// The image of a frame at the size at which motion is measured; none without a readable image.
std::optional<cv::Mat> SmallImage(const ImportView& view, const Frame& frame) {
  if (frame.image.empty()) return std::nullopt;
  try {
    const auto path = ImagePath(view.folder, frame.image, view.folder.string());
    return ViewOf(ReadImage(path, cv::IMREAD_GRAYSCALE, view.options.image_orientation)).small;
  } catch (const InputError&) {
    return std::nullopt;  // which stages that need images report
  }
}

// Whether the images of a run differ by more than those of a camera at rest; none if there are no
// images, or nothing in them to follow.
std::optional<bool> DoImagesMove(const ImportView& view, const PoseRun& run) {
  const auto& frames = view.content.frames;
  const auto first = SmallImage(view, frames[run.first].frame);
  if (!first) return std::nullopt;
  const MotionTracker tracker(*first);
  if (!tracker.MedianDisplacement(*first)) return std::nullopt;
  bool is_known = false;
  for (const size_t i : {run.first + (run.last - run.first + 1) / 2, run.last}) {
    const auto image = SmallImage(view, frames[i].frame);
    if (!image || image->size() != first->size()) continue;
    is_known = true;
    const auto displacement = tracker.MedianDisplacement(*image);
    if (!displacement || *displacement >= FrameOptions().min_motion) return true;
  }
  return is_known ? std::optional(false) : std::nullopt;
}

// Whether most objects move in their boxes by more than a fifth of half the diagonals.
bool DoBoxesMove(const std::vector<TrackedObject>& objects, const PoseRun& run) {
  constexpr size_t kFewestObjects = 3;
  constexpr double kLargestShare = 0.2;
  std::vector<double> shares;
  for (const TrackedObject& object : objects) {
    std::vector<TrackedRay> rays;
    for (const TrackedRay& ray : object.rays) {
      if (ray.frame >= run.first && ray.frame <= run.last) rays.push_back(ray);
    }
    if (rays.size() < 2) continue;
    const auto [first, last] = std::ranges::minmax(rays, {}, &TrackedRay::frame);
    shares.push_back(AngleBetweenDeg(first.ray_in_camera, last.ray_in_camera) /
                     first.half_diagonal_deg);
  }
  return shares.size() >= kFewestObjects && *MedianOf(shares) > kLargestShare;
}

}  // namespace

bool RepeatsPose(const std::vector<ListedFrame>& frames, size_t i) {
  if (i == 0 || frames[i].frame.segment != frames[i - 1].frame.segment) return false;
  const auto pose = frames[i].Pose(), before = frames[i - 1].Pose();
  return pose && before && pose->translation == before->translation &&
         pose->rotation.coeffs() == before->rotation.coeffs();
}

std::vector<Finding> CheckRepeatedPoses(const ImportView& view) {
  constexpr size_t kMostRuns = 20;  // whose images are read
  std::vector<PoseRun> runs = FindRuns(view.content.frames);
  const size_t all = runs.size();
  std::ranges::stable_sort(runs, std::ranges::greater(),
                           [](const PoseRun& run) { return run.last - run.first; });
  runs.resize(std::min(all, kMostRuns));
  const std::vector<TrackedObject> objects = TrackedObjects(view);
  std::erase_if(runs, [&](const PoseRun& run) {
    return !DoImagesMove(view, run).value_or(DoBoxesMove(objects, run));
  });
  if (runs.empty()) return {};
  std::ranges::sort(runs, {}, &PoseRun::first);
  const auto& frames = view.content.frames;
  std::vector<std::string> names;
  size_t repeated = 0;
  bool are_taken_twice = true;  // the file has each pose once
  for (const PoseRun& run : runs) {
    names.push_back(fmt::format("{} to {}", frames[run.first].frame.id, frames[run.last].frame.id));
    repeated += run.last - run.first;
    const auto& stamp = frames[run.first].pose_timestamp;
    are_taken_twice &= stamp && stamp == frames[run.last].pose_timestamp;
  }
  return {{are_taken_twice ? "shared_poses" : kRepeatedPoses, Severity::kWarning,
           fmt::format("{}{} with exactly the pose of the frame before, while what they show "
                       "moves: frames {}",
                       all > kMostRuns ? "at least " : "", Counted(repeated, "frame"),
                       NamesInWords(names, 5)),
           "a pose of its own for each image of a camera that moves",
           are_taken_twice ? "poses that are rarer than images, begin later or end earlier"
                           : "a tracker that was lost and repeated its last pose",
           are_taken_twice ? "poses of all images, or a smaller max_time_difference_s: images "
                             "without a pose are not used"
                           : "take the poses of these frames out of the trajectory: frames without "
                             "a pose are not used"}};
}

}  // namespace soslam
