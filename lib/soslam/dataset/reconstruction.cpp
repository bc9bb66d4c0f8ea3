// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/reconstruction.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "soslam/base/text.h"
#include "soslam/dataset/image_path.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/triangulation.h"
#include "soslam/model/sequence.h"

namespace soslam {
Reconstruction BuildReconstruction(const ColmapModel& model,
                                   const std::vector<ListedImage>& images) {
  Reconstruction reconstruction;
  reconstruction.world_from_camera.resize(images.size());
  std::vector<NamedPose> poses;
  for (const ColmapImage& image : model.images) poses.push_back(image.pose);
  const auto rows = RowsOfPoses(poses, images);
  std::map<std::int64_t, std::pair<size_t, int>> frames;  // index in the model, and frame, by id
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i]) {
      reconstruction.unlisted.push_back(poses[i].image);
      continue;
    }
    reconstruction.world_from_camera[*rows[i]] = poses[i].world_from_camera;
    frames[model.images[i].id] = {i, *rows[i]};
  }
  for (const ColmapPoint& point : model.points) {
    MapPoint read;
    read.position_in_world = point.position_in_world;
    read.reprojection_error_px = std::max(point.reprojection_error_px, 0.0);
    for (const ColmapPoint::Observation& observation : point.track) {
      const auto frame = frames.find(observation.image_id);
      if (frame == frames.end()) continue;
      const auto& [image, frame_id] = frame->second;
      read.observations.push_back({frame_id, model.images[image].pixels[observation.pixel_index]});
    }
    std::ranges::stable_sort(read.observations, {}, &PointObservation::frame_id);
    if (!read.observations.empty()) reconstruction.points.push_back(std::move(read));
  }
  return reconstruction;
}

void Summarise(const Reconstruction& reconstruction, const std::vector<ListedImage>& images,
               ReconstructionSummary* summary) {
  constexpr size_t kMostViews = 50;  // of a point, evenly spread over its track
  std::vector<double> errors, angles;
  summary->observations = 0;
  for (const MapPoint& point : reconstruction.points) {
    if (point.reprojection_error_px > 0.0) errors.push_back(point.reprojection_error_px);
    std::vector<int> frames;
    for (const PointObservation& observation : point.observations) {
      frames.push_back(observation.frame_id);
    }
    std::vector<Eigen::Vector3d> centres;
    for (const int frame : SpreadOver(frames, kMostViews)) {
      centres.push_back(reconstruction.world_from_camera[frame]->translation);
    }
    angles.push_back(kDegPerRad * LargestAngle(centres, point.position_in_world));
    summary->observations += static_cast<int>(point.observations.size());
  }
  summary->images = static_cast<int>(reconstruction.world_from_camera.size());
  summary->registered = static_cast<int>(std::ranges::count_if(
      reconstruction.world_from_camera, [](const auto& pose) { return pose.has_value(); }));
  summary->images_without_pose.clear();
  for (size_t i = 0; i < images.size(); ++i) {
    if (reconstruction.world_from_camera[i]) continue;
    summary->images_without_pose.push_back(images[i].image);
  }
  summary->points = static_cast<int>(reconstruction.points.size());
  summary->median_reprojection_error_px = MedianOf(errors);
  summary->median_triangulation_angle_deg = MedianOf(angles);
}

std::vector<Finding> CheckReconstruction(const ReconstructionSummary& summary,
                                         const std::vector<std::string>& unlisted) {
  constexpr double kRegistered = 0.8;
  constexpr double kAngleDeg = 2.0;
  std::vector<Finding> findings;
  if (summary.registered < kRegistered * summary.images) {
    const bool is_given = summary.colmap.empty();
    std::string causes =
        is_given ? "a model of a part of the images"
                 : "images that are blurred, show little texture, or overlap too little";
    // Images without a pose may be renamed if the model has at least as many that are not listed.
    if (unlisted.size() >= summary.images_without_pose.size()) {
      causes += "; or other names than in the model, which has images that are not listed: " +
                NamesInWords(unlisted);
    }
    findings.push_back(
        {"images_registered", Severity::kWarning,
         fmt::format("{} of {} images are registered; the others have no pose: {}",
                     summary.registered, summary.images, NamesInWords(summary.images_without_pose)),
         "80 % of the images at least", causes,
         is_given ? "give a model of all images, or only the images that it is of"
                  : "take more images between those that are far apart, or give the poses"});
  }
  if (summary.components.size() > 1) {
    const ReconstructionSummary::Component& second = summary.components[1];
    findings.push_back(
        {"components", Severity::kWarning,
         fmt::format("the images fall into {} parts that are not connected; used is the largest, "
                     "of {} images; the second one has {} images and {} points",
                     summary.components.size(), summary.components.front().images, second.images,
                     second.points),
         "one part", "too little overlap between the parts, or images of several places",
         fmt::format("take images that connect the parts, or map the second one by itself: --model "
                     "takes its folder, \"{}\" beside that of the largest",
                     second.folder)});
  }
  const auto& angle = summary.median_triangulation_angle_deg;
  if (summary.poses == DataSource::kEstimated && angle && *angle < kAngleDeg) {
    findings.push_back(
        {"triangulation_angle", Severity::kWarning,
         fmt::format("the median triangulation angle is {:.2f} degrees: no baseline: poses needed",
                     *angle),
         "2 degrees at least", "a camera that turns on the spot, or hardly moves",
         "move the camera sideways, about a tenth of the distance between images; or give the "
         "poses"});
  }
  return findings;
}

}  // namespace soslam
