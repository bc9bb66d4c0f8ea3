// SPDX-License-Identifier: BSD-3-Clause
#include "stage/scene_axes.h"

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "base/paths.h"
#include "geometry/angles.h"
#include "planes/scene_axis.h"
#include "stage/segment_views.h"

namespace soslam {
namespace {

constexpr int kMaxSceneImages = 24;
constexpr double kMinSegmentPx = 30.0;
constexpr double kSceneCorrelation = 20.0 * kRadPerDeg;

// The sequence's images that exist, at most kMaxSceneImages, spread over all.
std::vector<FrameImage> SomeImages(const Sequence& sequence, const std::filesystem::path& folder) {
  std::vector<FrameImage> images;
  if (std::ranges::all_of(sequence.frames, [](const Frame& frame) { return frame.image.empty(); }))
    return images;
  for (const FrameImage& image : FrameImages(sequence, folder, folder)) {
    if (IsFile(image.path)) images.push_back(image);
  }
  const size_t step = images.size() / kMaxSceneImages + 1;
  std::vector<FrameImage> some;
  for (size_t i = 0; i < images.size(); i += step) some.push_back(images[i]);
  return some;
}

// Straight edges of the images that can be read; soslam-edges says what is wrong with others.
std::vector<SegmentView> SegmentsOf(const std::vector<FrameImage>& images, int threads,
                                    const Sequence& sequence) {
  const FrameImageReader reader(sequence);
  std::vector<SegmentView> views(images.size());
  ParallelFor(static_cast<int>(images.size()), threads, [&](int i) {
    const auto index = static_cast<size_t>(i);
    try {
      views[index] = ReadSegmentView(sequence, reader, images[index], kMinSegmentPx);
    } catch (const InputError&) {
    }
  });
  std::erase_if(views, [](const SegmentView& view) { return view.segments.empty(); });
  return views;
}

}  // namespace

void AddSceneAxes(const std::filesystem::path& folder, int threads, Sequence* sequence,
                  std::vector<std::filesystem::path>* inputs) {
  const auto has_axis = [](const SupportPlane& plane) { return bool(plane.scene_axis_in_world); };
  const auto is_of_first = [&](const Frame& frame) {
    return frame.segment == sequence->frames.front().segment;
  };
  if (std::ranges::all_of(sequence->planes, has_axis) ||
      !std::ranges::all_of(sequence->frames, is_of_first)) {
    return;
  }
  const std::vector<FrameImage> images = SomeImages(*sequence, folder);
  for (const FrameImage& image : images) inputs->push_back(image.path);
  SetSceneAxes(SegmentsOf(images, threads, *sequence), kSceneCorrelation, sequence);
}

}  // namespace soslam
