// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/moving_things.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "soslam/base/text.h"
#include "soslam/model/label_groups.h"

namespace soslam {
namespace {

// Calls `use` with frame index, label and box of each box of a thing that moves.
template <typename Use>
void ForEachMovingBox(const Sequence& sequence, Use use) {
  const std::set<std::string> moving = NormalisedLabels("moving_labels", sequence.moving_labels);
  const auto use_if_moving = [&](int frame_index, const std::string& label, double score,
                                 const Box& box) {
    if (score >= kLeastMovingScore && moving.contains(NormalisedLabel(label))) {
      use(frame_index, label, box);
    }
  };
  for (const Detection& detection : sequence.detections) {
    use_if_moving(detection.frame_index, sequence.ObjectOf(detection).label, detection.score,
                  detection.box);
  }
  for (const RejectedDetection& detection : sequence.rejected) {
    use_if_moving(detection.frame_index, detection.label, detection.score, detection.box);
  }
}

// The share of an image in any of the boxes, to a percent or so.
double CoveredShare(const Camera& camera, const std::vector<Box>& boxes) {
  constexpr int kSteps = 100;  // along either side
  int covered = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const Eigen::Vector2d pixel((i % kSteps + 0.5) * camera.width / kSteps - 0.5,
                                (i / kSteps + 0.5) * camera.height / kSteps - 0.5);
    covered += std::ranges::any_of(boxes, [&](const Box& box) { return box.Contains(pixel); });
  }
  return static_cast<double>(covered) / (kSteps * kSteps);
}

}  // namespace

std::vector<std::vector<Box>> BoxesOfMovingThings(const Sequence& sequence) {
  std::vector<std::vector<Box>> boxes(sequence.frames.size());
  ForEachMovingBox(sequence, [&](int frame_index, const std::string& /*label*/, const Box& box) {
    boxes[frame_index].push_back(box);
  });
  return boxes;
}

std::vector<MapPoint> WithoutMovingThings(const Sequence& sequence, std::vector<MapPoint> points) {
  const std::vector<std::vector<Box>> moving = BoxesOfMovingThings(sequence);
  std::erase_if(points, [&](const MapPoint& point) {
    int seen = 0, covered = 0;
    for (const PointObservation& observation : point.observations) {
      const auto frame_index = FindFrameIndex(sequence, observation);
      if (!frame_index) continue;
      ++seen;
      covered += std::ranges::any_of(
          moving[*frame_index], [&](const Box& box) { return box.Contains(observation.pixel); });
    }
    return seen > 0 && 2 * covered >= seen;
  });
  return points;
}

std::vector<Finding> CheckMovingThings(const Sequence& sequence) {
  constexpr double kMostOfAnImage = 0.5;
  struct Count {
    int boxes = 0;
    std::set<int> frames;
  };
  std::map<std::string, Count> counts;
  ForEachMovingBox(sequence, [&](int frame_index, const std::string& label, const Box& /*box*/) {
    Count& count = counts[label];
    ++count.boxes;
    count.frames.insert(frame_index);
  });
  if (counts.empty()) return {};
  std::vector<std::string> words;
  for (const auto& [label, count] : counts) {
    words.push_back(fmt::format("{} of {} in {}",
                                count.boxes == 1 ? "a box" : fmt::format("{} boxes", count.boxes),
                                label, Counted(count.frames.size(), "image")));
  }
  const std::vector<std::vector<Box>> boxes = BoxesOfMovingThings(sequence);
  int covered = 0;
  for (size_t i = 0; i < boxes.size(); ++i) {
    covered += CoveredShare(sequence.CameraOf(sequence.frames[i]), boxes[i]) > kMostOfAnImage;
  }
  return {{"moving_things", Severity::kWarning,
           fmt::format("{}: they get no place in a map made of these boxes, and points in them are "
                       "not used{}",
                       fmt::join(words, ", "),
                       covered == 0 ? ""
                                    : fmt::format("; they cover more than half of {}",
                                                  Counted(covered, "image"))),
           "images of what stands still", "people or animals in view, or wrong boxes",
           covered == 0 ? "nothing, unless these things stand still: then leave their label out of "
                          "moving_labels"
                        : "images without them, as the rest may be too little to go by"}};
}

}  // namespace soslam
