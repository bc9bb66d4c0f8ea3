// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/stage/read_evidence.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "soslam/appearance/appearance_file.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/hdf5_artefact.h"
#include "soslam/base/error.h"
#include "soslam/base/parallel.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/image_path.h"
#include "soslam/geometry/angles.h"
#include "soslam/planes/scene_axis.h"

namespace soslam {

EdgeSource EdgesOfSequence(const Sequence& sequence, const StageFiles& files) {
  const auto reader = std::make_shared<const EdgesReader>(files.at("edges"));
  return [&sequence, &files, reader](const Frame& frame) {
    EdgeMaps maps = reader->Read(frame.id);
    const Camera& camera = sequence.CameraOf(frame);
    if (maps.grey.cols == camera.width && maps.grey.rows == camera.height) return maps;
    throw InputError(fmt::format(
        "{}: frame {} has {} x {} pixels; expected {} x {}, as its camera in {}: were the edges "
        "made from another sequence?",
        files.at("edges").string(), frame.id, maps.grey.cols, maps.grey.rows, camera.width,
        camera.height, files.at("sequence").string()));
  };
}

void CheckHasPoints(const PointOptions& options, const StageFiles& files) {
  if (options.point_evidence && !files.contains("points")) {
    throw SettingsError("point_evidence = true needs --points FILE; found none");
  }
}

void AddPictureEvidence(const PictureOptions& asked, const StageFiles& files, Sequence* sequence,
                        std::vector<std::filesystem::path>* inputs) {
  if (!asked.Any()) return;
  if (!files.contains("appearance")) {
    throw SettingsError("picture_yaw or picture_ratios = true needs --appearance FILE; found none");
  }
  CheckWasMadeOf(files.at("appearance"), "appearance", files.at("sequence"));
  AddAppearance(files.at("appearance"), sequence);
  for (Detection& detection : sequence->detections) {
    if (!detection.appearance) continue;
    BoxAppearance appearance = *detection.appearance;
    if (!asked.yaw) appearance.azimuth_costs.setZero();
    if (!asked.ratios) appearance.log_ratios.reset();
    detection.appearance = std::make_shared<const BoxAppearance>(appearance);
  }
  inputs->push_back(files.at("appearance"));
}

std::vector<MapPoint> ReadCheckedPoints(const Sequence& sequence, const StageFiles& files) {
  std::vector<MapPoint> points = ReadPoints(files.at("points"));
  std::set<int> frame_ids;
  for (const Frame& frame : sequence.frames) frame_ids.insert(frame.id);
  const auto is_seen = [&](const MapPoint& point) {
    return std::ranges::any_of(point.observations, [&](const PointObservation& observation) {
      return frame_ids.contains(observation.frame_id);
    });
  };
  if (!points.empty() && std::ranges::none_of(points, is_seen)) {
    throw InputError(fmt::format(
        "{}: observation_frame: none of {} points is seen in a frame of {}; expected ids of its {} "
        "frames: were the points made from another dataset?",
        files.at("points").string(), points.size(), files.at("sequence").string(),
        sequence.frames.size()));
  }
  return points;
}

namespace fs = std::filesystem;

std::vector<FrameImage> FrameImages(const Sequence& sequence, const fs::path& dataset,
                                    const fs::path& sequence_file) {
  std::vector<FrameImage> images;
  for (const Frame& frame : sequence.frames) {
    if (frame.image.empty()) continue;
    images.push_back(
        {&frame, ImagePath(dataset, frame.image,
                           fmt::format("{}: frame {}", sequence_file.string(), frame.id))});
  }
  if (images.empty()) {
    throw NothingUsableError(
        fmt::format("{}: none of its {} frames has an image; expected at least one",
                    sequence_file.string(), sequence.frames.size()));
  }
  return images;
}

FrameImageReader::FrameImageReader(const Sequence& sequence) : sequence_(sequence) {
  if (sequence.image_distortion) undistorter_.emplace(sequence.camera, *sequence.image_distortion);
}

cv::Mat FrameImageReader::Read(const FrameImage& image, int mode) const {
  const Camera& camera = sequence_.CameraOf(*image.frame);
  const cv::Mat pixels = ReadImage(image.path, mode, sequence_.image_orientation,
                                   cv::Size(camera.width, camera.height));
  return undistorter_ ? undistorter_->Undistort(pixels) : pixels;
}

namespace {

bool HasImages(const Sequence& sequence) {
  return std::ranges::any_of(sequence.frames,
                             [](const Frame& frame) { return !frame.image.empty(); });
}

// Straight edges of at least `min_length_px` in an image of a sequence, with its frame's pose.
SegmentView ReadSegmentView(const Sequence& sequence, const FrameImageReader& reader,
                            const FrameImage& image, double min_length_px) {
  return {sequence.CameraOf(*image.frame),
          FindLineSegments(reader.Read(image, cv::IMREAD_GRAYSCALE), min_length_px),
          image.frame->world_from_camera};
}

}  // namespace

std::vector<SegmentView> ViewsOfSegments(const Sequence& sequence, const VerticalOptions& options,
                                         const StageFiles& files, int threads,
                                         std::vector<std::filesystem::path>* inputs) {
  if (!options.are_used || !HasImages(sequence)) return {};
  if (!files.contains("dataset")) {
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
  ParallelFor("images", images.size(), threads, [&](size_t i) {
    const FrameImage& image = images[i];
    views[image.frame - sequence.frames.data()] =
        ReadSegmentView(sequence, reader, image, options.min_length_px);
  });
  return views;
}

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
  std::vector<FrameImage> all;
  if (HasImages(*sequence)) all = FrameImages(*sequence, folder, folder);
  std::erase_if(all, [](const FrameImage& image) { return !IsFile(image.path); });
  constexpr int kMaxImages = 24;
  const size_t step = all.size() / kMaxImages + 1;
  std::vector<FrameImage> images;  // spread over all
  for (size_t i = 0; i < all.size(); i += step) {
    images.push_back(all[i]);
    inputs->push_back(all[i].path);
  }
  constexpr double kMinSegmentPx = 30.0;
  constexpr double kCorrelation = 20.0 * kRadPerDeg;
  const FrameImageReader reader(*sequence);
  std::vector<SegmentView> views(images.size());
  ParallelFor(images.size(), threads, [&](size_t i) {
    try {
      views[i] = ReadSegmentView(*sequence, reader, images[i], kMinSegmentPx);
    } catch (const InputError&) {  // soslam-edges says what is wrong with the image
    }
  });
  std::erase_if(views, [](const SegmentView& view) { return view.segments.empty(); });
  SetSceneAxes(views, kCorrelation, sequence);
}

}  // namespace soslam
