// SPDX-License-Identifier: BSD-3-Clause
#include "stage/segment_views.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "base/parallel.h"
#include "image/edge_maps.h"
#include "stage/image_stages.h"

namespace soslam {

SegmentView ReadSegmentView(const Sequence& sequence, const FrameImageReader& reader,
                            const FrameImage& image, double min_length_px) {
  return {sequence.CameraOf(*image.frame), FindLineSegments(reader.ReadGrey(image), min_length_px),
          image.frame->world_from_camera};
}

std::vector<SegmentView> ViewsOfSegments(const Sequence& sequence, double min_length_px,
                                         const StageFiles& files, int threads,
                                         std::vector<std::filesystem::path>* inputs) {
  const bool has_images =
      std::ranges::any_of(sequence.frames, [](const Frame& frame) { return !frame.image.empty(); });
  if (!has_images) return {};
  if (files.count("dataset") == 0) {
    throw SettingsError(
        "verticals is true; expected --dataset with the images, or verticals = false");
  }
  const std::vector<FrameImage> images =
      FrameImages(sequence, files.at("dataset"), files.at("sequence"));
  for (const FrameImage& image : images) inputs->push_back(image.path);
  std::vector<SegmentView> views;
  for (const Frame& frame : sequence.frames) {
    views.push_back({sequence.CameraOf(frame), {}, frame.world_from_camera});
  }
  const FrameImageReader reader(sequence);
  ParallelFor("images", static_cast<int>(images.size()), threads, [&](int i) {
    const FrameImage& image = images[i];
    views[image.frame - sequence.frames.data()] =
        ReadSegmentView(sequence, reader, image, min_length_px);
  });
  return views;
}

void CheckOneSegment(const Sequence& sequence, const std::filesystem::path& path) {
  const int first = sequence.frames.front().segment;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    if (sequence.frames[i].segment == first) continue;
    throw InputError(fmt::format(
        "{}: /frames/{} is of segment {}, the frames before of segment {}; expected one segment "
        "where planes are estimated, or planes = given or camera_height",
        path.string(), i, sequence.frames[i].segment, first));
  }
}

}  // namespace soslam
