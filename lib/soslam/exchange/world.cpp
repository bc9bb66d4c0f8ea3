// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/exchange/world.h"

#include <algorithm>
#include <filesystem>
#include <map>

#include "soslam/artefact/json_file.h"
#include "soslam/evaluation/alignment.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/triangulation.h"
#include "soslam/image/undistorted_points.h"
#include "soslam/model/segments.h"

namespace soslam {
namespace {

using nlohmann::json;

// The frames that have a pose, one world per segment.
std::vector<World> WorldsOfFrames(const Sequence& sequence,
                                  const std::vector<std::optional<Rigid3d>>& world_from_camera) {
  std::vector<World> worlds;
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    const Frame& frame = sequence.frames[i];
    if (worlds.empty() || worlds.back().segment != frame.segment) {
      worlds.push_back({frame.segment, {}, {}, sequence.image_distortion});
    }
    if (!world_from_camera[i]) continue;
    worlds.back().frames.push_back(
        {frame.id, frame.timestamp, frame.image, sequence.CameraOf(frame), *world_from_camera[i]});
  }
  return worlds;
}

}  // namespace

std::vector<World> WorldsOfMap(const Sequence& sequence, const MapEstimate& map) {
  std::vector<World> worlds =
      WorldsOfFrames(sequence, {map.world_from_camera.begin(), map.world_from_camera.end()});
  if (worlds.empty()) return worlds;
  const std::vector<std::vector<int>> detections_by_object = DetectionsByObject(sequence);
  const std::vector<std::optional<int>> segments = SegmentsOfObjects(sequence);
  const auto score = [&](int detection) { return sequence.detections[detection].score; };
  for (const ObjectEstimate& estimate : map.objects) {
    const auto index = static_cast<size_t>(estimate.object_index);
    const Object& object = sequence.objects[index];
    const std::optional<int>& segment = segments[index];
    World& world = segment ? *std::ranges::find(worlds, *segment, &World::segment) : worlds.front();
    world.objects.push_back(
        {object.id, object.label, segment, map.planes_in_world[object.plane_index].normal,
         MeanOf(CollectValues(detections_by_object[index], score)).value_or(1.0), estimate});
    if (!segment && estimate.landmark_in_world) {
      world.objects.back().estimate.landmark_in_world.reset();
      world.objects.back().estimate.failure = "unknown_segment";
    }
  }
  return worlds;
}

std::vector<World> WorldsOfOdometry(const Sequence& sequence) {
  const std::vector<Rigid3d> poses = PosesOf(sequence);
  return WorldsOfFrames(sequence, {poses.begin(), poses.end()});
}

std::vector<World> WorldsOfTruth(const Sequence& sequence) {
  std::vector<std::optional<Rigid3d>> poses;
  for (const Frame& frame : sequence.frames) poses.push_back(frame.true_world_from_camera);
  std::vector<World> worlds = WorldsOfFrames(sequence, poses);

  for (const TrueObject& object : sequence.true_objects) {
    const auto world = std::ranges::find(worlds, object.segment, &World::segment);
    if (world == worlds.end()) continue;
    const Landmark& truth = object.truth.landmark_in_world;
    WorldObject& exported = world->objects.emplace_back();
    exported.id = object.id;
    exported.label = object.label;
    exported.segment = object.segment;
    exported.support_normal = truth.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
    if (!object.is_static) {
      exported.estimate.failure = "moving";
      continue;
    }
    exported.estimate.landmark_in_world = truth;
    exported.estimate.landmark_in_world->shape_exponents = kCuboidExponent;
  }
  return worlds;
}

Eigen::Vector3d EstimateCommonUp(const World& world) {
  constexpr double kMinCosine = 0.9;
  std::vector<Eigen::Vector3d> normals;
  for (const WorldObject& object : world.objects) {
    if (object.estimate.landmark_in_world) normals.push_back(object.support_normal);
  }
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::ptrdiff_t most_shared = 0;
  for (const Eigen::Vector3d& normal : normals) {
    const auto shared = std::ranges::count_if(
        normals, [&](const Eigen::Vector3d& other) { return normal.dot(other) > kMinCosine; });
    if (shared > most_shared) up = normal;
    most_shared = std::max(most_shared, shared);
  }
  return up;
}

std::filesystem::path FolderOfImages(const std::vector<World>& worlds) {
  std::optional<std::filesystem::path> shared;
  for (const World& world : worlds) {
    for (const WorldFrame& frame : world.frames) {
      if (frame.image.empty()) continue;
      const std::filesystem::path folder = std::filesystem::path(frame.image).parent_path();
      if (!shared) shared = folder;
      std::filesystem::path both;
      for (auto one = shared->begin(), other = folder.begin();
           one != shared->end() && other != folder.end() && *one == *other; ++one, ++other) {
        both /= *one;
      }
      shared = both;
    }
  }
  return shared.value_or(std::filesystem::path());
}

void AddPoints(const Sequence& sequence, const std::vector<MapPoint>& points,
               std::vector<World>* worlds) {
  constexpr double kHuberPx = 1.0;
  for (World& world : *worlds) {
    std::map<int, const WorldFrame*> frames;
    for (const WorldFrame& frame : world.frames) frames[frame.id] = &frame;
    for (const MapPoint& point : points) {
      WorldPoint placed;
      std::vector<PointView> views;
      for (const PointObservation& observation : point.observations) {
        const auto frame = frames.find(observation.frame_id);
        if (frame == frames.end()) continue;
        const auto pixel = UndistortedPixel(sequence, observation);
        if (!pixel) continue;
        const auto& [id, seen_from] = *frame;
        views.push_back({seen_from->camera, seen_from->world_from_camera.Inverse(), *pixel});
        placed.observations.push_back(observation);
      }
      const auto triangulated = Triangulate(views, kHuberPx);
      if (!triangulated) continue;
      placed.position_in_world = triangulated->position_in_world;
      placed.reprojection_error_px = triangulated->mean_error_px;
      world.points.push_back(placed);
    }
  }
}

double ComputeYaw(const WorldObject& object) {
  return Yaw(object.support_normal, object.estimate.landmark_in_world->frame_from_object.rotation);
}

void AddVerdicts(const json& quality, std::vector<World>* worlds) {
  std::map<int, LandmarkVerdict> of_object;
  for (const json& row : quality.at("landmarks")) {
    LandmarkVerdict verdict{row.at("fate").get<std::string>()};
    if (!row.at("true_object").is_null()) verdict.true_object = row["true_object"].get<int>();
    if (!row.at("errors").is_null()) verdict.iou = row["errors"].at("iou").get<double>();
    if (!row.at("reason").is_null()) verdict.reason = row["reason"].get<std::string>();
    of_object[row.at("object").get<int>()] = verdict;
  }
  for (World& world : *worlds) {
    for (WorldObject& object : world.objects) {
      const auto verdict = of_object.find(object.id);
      if (verdict != of_object.end()) object.verdict = verdict->second;
    }
  }
}

void AlignWorlds(const json& quality, std::vector<World>* worlds) {
  std::map<int, Alignment> of_segment;
  for (const json& alignment : quality.at("alignments")) {
    Alignment& of_its_segment = of_segment[alignment.at("segment").get<int>()];
    alignment.at("scale").get_to(of_its_segment.scale);
    of_its_segment.truth_from_scaled =
        DescribedFromJson<Rigid3d>(alignment.at("truth_from_scaled"));
  }
  for (World& world : *worlds) {
    const Alignment& alignment = of_segment.at(world.segment);
    // Derivative of rotation, centre and log half axes in the moved world by those in the world.
    const Eigen::Matrix3d rotation = alignment.truth_from_scaled.rotation.toRotationMatrix();
    Covariance9 jacobian = Covariance9::Identity();
    jacobian.block<3, 3>(0, 0) = rotation;
    jacobian.block<3, 3>(3, 3) = alignment.scale * rotation;
    for (WorldFrame& frame : world.frames) {
      frame.world_from_camera = alignment.Apply(frame.world_from_camera);
    }
    for (WorldObject& object : world.objects) {
      object.support_normal = alignment.truth_from_scaled.rotation * object.support_normal;
      ObjectEstimate& estimate = object.estimate;
      if (estimate.landmark_in_world) {
        estimate.landmark_in_world = alignment.Apply(*estimate.landmark_in_world);
      }
      if (estimate.covariance) {
        estimate.covariance = Covariance9(jacobian * *estimate.covariance * jacobian.transpose());
      }
    }
  }
}

}  // namespace soslam
