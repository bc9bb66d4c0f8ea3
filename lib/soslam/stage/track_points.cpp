// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/stage/track_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "soslam/base/parallel.h"
#include "soslam/base/text.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/triangulation.h"
#include "soslam/image/box_mask.h"
#include "soslam/image/undistorted_points.h"
#include "soslam/model/moving_things.h"

namespace soslam {
namespace {

std::vector<FeatureTrack> FollowFeatures(const Sequence& sequence,
                                         const std::vector<FrameImage>& images,
                                         const FeatureTrackOptions& options, int threads) {
  const FrameImageReader reader(sequence);
  const std::vector<std::vector<Box>> moving = BoxesOfMovingThings(sequence);
  FeatureTracker tracker(options);
  MakeInOrder(
      "images", images.size(), threads,
      [&](size_t i) { return reader.Read(images[i], cv::IMREAD_GRAYSCALE); },
      [&](size_t i, const cv::Mat& grey) {
        const Frame& frame = *images[i].frame;
        const Frame& last = i > 0 ? *images[i - 1].frame : frame;
        const Camera &camera = sequence.CameraOf(frame), &before = sequence.CameraOf(last);
        const bool may_share_features = last.segment == frame.segment &&
                                        before.width == camera.width &&
                                        before.height == camera.height;
        if (!may_share_features) tracker.Cut();
        // Homography between two images of a camera that only turns: where points at infinity move.
        const Eigen::Quaterniond frame_from_last =
            frame.world_from_camera.rotation.conjugate() * last.world_from_camera.rotation;
        tracker.Add(grey,
                    camera.Intrinsics() * frame_from_last.toRotationMatrix() *
                        before.Intrinsics().inverse(),
                    MaskOutBoxes(moving[&frame - sequence.frames.data()], grey.size()));
      });
  return tracker.Tracks();
}

// Empty if a track's image points are not those of one static point, or it is too far away.
std::optional<MapPoint> TriangulateTrack(const Sequence& sequence,
                                         const std::vector<FrameImage>& images,
                                         const FeatureTrack& track, const TrackOptions& options) {
  std::vector<PointView> all;
  for (const FeatureTrack::Place& place : track.places) {
    const Frame& frame = *images[place.image].frame;
    all.push_back({sequence.CameraOf(frame), frame.world_from_camera.Inverse(), place.pixel});
  }
  const double max_error_px = options.max_reprojection_error_px;
  const auto min_views = static_cast<size_t>(options.min_views);
  if (all.size() < min_views) return std::nullopt;
  const auto first = Triangulate(all, 0.5 * max_error_px);
  if (!first) return std::nullopt;
  const auto is_far_from = [&](const TriangulatedPoint& point) {
    return [&](const PointView& view) {
      return ReprojectionError(view, point.position_in_world) > max_error_px;
    };
  };
  std::vector<PointView> near = all;
  std::erase_if(near, is_far_from(*first));
  if (near.size() < min_views || 2 * near.size() < all.size()) return std::nullopt;
  const auto point = Triangulate(near, 0.5 * max_error_px);
  if (!point) return std::nullopt;
  std::vector<Eigen::Vector3d> centres;
  for (const PointView& view : near) {
    centres.push_back(view.camera_from_world.Inverse().translation);
  }
  if (std::ranges::any_of(near, is_far_from(*point)) ||
      LargestAngle(centres, point->position_in_world) < options.min_angle_deg * kRadPerDeg) {
    return std::nullopt;
  }
  MapPoint result{point->position_in_world, point->mean_error_px, {}};
  for (size_t i = 0; i < all.size(); ++i) {
    if (is_far_from(*first)(all[i])) continue;
    result.observations.push_back(
        StoredObservation(sequence, *images[track.places[i].image].frame, all[i].pixel));
  }
  return result;
}

// Why no track gives a point.
std::vector<Finding> CheckPoints(const std::vector<MapPoint>& points,
                                 const std::vector<FrameImage>& images,
                                 const std::vector<FeatureTrack>& tracks,
                                 const TrackOptions& options) {
  if (!points.empty()) return {};
  const auto is_long = [&](const FeatureTrack& track) {
    return track.places.size() >= static_cast<size_t>(options.min_views);
  };
  const bool is_at_rest = std::ranges::all_of(images, [&](const FrameImage& image) {
    constexpr double kRounding = 1e-9;
    const Eigen::Vector3d& first = images.front().frame->world_from_camera.translation;
    const Eigen::Vector3d& place = image.frame->world_from_camera.translation;
    return (place - first).norm() <= kRounding * (1.0 + first.norm());
  });
  struct Reason {
    bool applies;
    std::string cause;
    const char* remedy;
  };
  const Reason reasons[] = {
      {images.size() < static_cast<size_t>(options.min_views),
       fmt::format("a point is seen in at least {} images", options.min_views),
       "more images of the same place"},
      {std::ranges::none_of(tracks, is_long),
       fmt::format("no track over {} images: they show little texture, or have little in common",
                   options.min_views),
       "images closer together"},
      {is_at_rest, "the camera does not move: all poses have one place",
       "images from several places"},
      {true, "the poses do not fit the images, or the camera hardly moves",
       "check that poses and images have the same order and time stamps"}};
  const Reason& reason = *std::ranges::find(reasons, true, &Reason::applies);
  return {{"no_points", Severity::kWarning,
           fmt::format("no point from {} tracks through {}", tracks.size(),
                       Counted(images.size(), "image")),
           "some", reason.cause, reason.remedy}};
}

}  // namespace

TrackedPoints TrackPoints(const Sequence& sequence, const std::vector<FrameImage>& images,
                          const TrackOptions& options, int threads) {
  const std::vector<FeatureTrack> tracks =
      FollowFeatures(sequence, images, options.features, threads);
  std::vector<std::optional<MapPoint>> found(tracks.size());
  ParallelFor(tracks.size(), threads,
              [&](size_t i) { found[i] = TriangulateTrack(sequence, images, tracks[i], options); });
  TrackedPoints tracked{{}, tracks.size(), {}};
  for (auto& point : found) {
    if (point) tracked.points.push_back(std::move(*point));
  }
  tracked.findings = CheckPoints(tracked.points, images, tracks, options);
  return tracked;
}

}  // namespace soslam
