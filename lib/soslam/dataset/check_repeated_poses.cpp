// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/base/error.h"
#include "soslam/base/text.h"
#include "soslam/dataset/dataset_checks.h"
#include "soslam/dataset/image_path.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/angles.h"
#include "soslam/image/frame_choice.h"
#include "soslam/image/read_image.h"

namespace soslam {
namespace {

// Consecutive frames with the same pose, to the last bit. Indices in DatasetContent::frames.
struct PoseRun {
  size_t first = 0;
  size_t last = 0;
};

// The image of a frame at the size at which motion is measured, with the same mean and contrast
// everywhere, as light that changes would shift features; none without a readable image.
std::optional<cv::Mat> SmallImage(const ImportView& view, const Frame& frame) {
  constexpr double kNoise = 2.0;  // grey values, which do not become contrast
  const cv::Size window(31, 31);
  if (frame.image.empty()) return std::nullopt;
  try {
    const auto path = ImagePath(view.folder, frame.image, view.folder.string());
    const cv::Mat image = ReadImage(path, cv::IMREAD_GRAYSCALE, view.options.image_orientation);
    cv::Mat grey, mean, deviation, even;
    MakeFrameView(image).small.convertTo(grey, CV_32F);
    cv::blur(grey, mean, window);
    grey -= mean;
    cv::sqrBoxFilter(grey, deviation, -1, window);
    cv::sqrt(deviation, deviation);
    grey /= deviation + kNoise;
    grey.convertTo(even, CV_8U, 50.0, 128.0);
    return even;
  } catch (const InputError&) {
    return std::nullopt;  // which stages that need images report
  }
}

// Whether features of the first image of a run are elsewhere in the last one, or in one at half the
// distance, a quarter of it, ...: far motion loses them. So do things that pass, and darkness:
// none if they are lost in all.
std::optional<bool> DoImagesMove(const ImportView& view, const PoseRun& run) {
  const auto& frames = view.content.frames;
  const auto first = SmallImage(view, frames[run.first].frame);
  if (!first) return std::nullopt;
  const MotionTracker tracker(*first);
  std::optional<bool> do_move;
  for (size_t distance = run.last - run.first; distance > 0; distance /= 2) {
    const auto image = SmallImage(view, frames[run.first + distance].frame);
    const auto displacement = image ? tracker.MedianDisplacement(*image) : std::nullopt;
    if (!displacement) continue;
    if (*displacement >= FrameOptions().min_motion) return true;
    do_move = false;
  }
  return do_move;
}

// Whether most objects that are seen over half of a run or more move by more than a fifth of half
// the diagonals of their boxes. False for few objects.
bool DoBoxesMove(const std::vector<TrackedObject>& objects, const PoseRun& run) {
  constexpr size_t kFewestObjects = 3;
  constexpr double kMoves = 0.2;
  std::vector<double> shares;
  for (const TrackedObject& object : objects) {
    std::vector<TrackedRay> rays;
    for (const TrackedRay& ray : object.rays) {
      if (ray.frame >= run.first && ray.frame <= run.last) rays.push_back(ray);
    }
    if (rays.empty()) continue;
    const auto [first, last] = std::ranges::minmax(rays, {}, &TrackedRay::frame);
    if (2 * (last.frame - first.frame) < run.last - run.first) continue;
    shares.push_back(AngleBetweenDeg(first.ray_in_camera, last.ray_in_camera) /
                     first.half_diagonal_deg);
  }
  return shares.size() >= kFewestObjects && *MedianOf(shares) > kMoves;
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
  const std::vector<ListedFrame>& frames = view.content.frames;
  std::vector<PoseRun> runs;
  for (size_t i = 1; i < frames.size(); ++i) {
    if (!RepeatsPose(frames, i)) continue;
    if (runs.empty() || runs.back().last != i - 1) runs.push_back({i - 1, i});
    runs.back().last = i;
  }
  const size_t all = runs.size();
  std::ranges::stable_sort(runs, std::ranges::greater(),
                           [](const PoseRun& run) { return run.last - run.first; });
  runs.resize(std::min(all, kMostRuns));
  const std::vector<TrackedObject> objects = TrackedObjects(view);
  std::erase_if(runs, [&](const PoseRun& run) {
    const auto do_images_move = DoImagesMove(view, run);
    return !(do_images_move ? *do_images_move : DoBoxesMove(objects, run));
  });
  if (runs.empty()) return {};
  std::ranges::sort(runs, {}, &PoseRun::first);
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
