// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <map>
#include <set>
#include <string>

#include "soslam/dataset/dataset_checks.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/angles.h"
#include "soslam/geometry/triangulation.h"

namespace soslam {
namespace {

constexpr size_t kFewestRays = 3;

}  // namespace

std::vector<TrackedObject> TrackedObjects(const ImportView& view) {
  constexpr double kCutPx = 2.0;
  const DatasetContent& content = view.content;
  std::map<int, size_t> frame_index;
  for (size_t i = 0; i < content.frames.size(); ++i) frame_index[content.frames[i].frame.id] = i;
  std::set<int> moving;
  for (const Object& object : view.sequence.objects) {
    if (!object.is_static) moving.insert(object.id);
  }
  std::set<std::pair<std::string, int>> seen;
  std::set<std::string> repeated;  // labels that occur more than once in a frame
  for (const DetectionRow& row : content.rows) {
    if (!seen.emplace(row.label, row.frame_id).second) repeated.insert(row.label);
  }
  std::map<std::string, TrackedObject> by_name;
  for (const DetectionRow& row : content.rows) {
    const size_t frame = frame_index.at(row.frame_id);
    const Camera& camera = view.sequence.CameraOf(content.frames[frame].frame);
    const Box in_image = row.box_in_image_file.value_or(row.box);
    const bool is_whole = in_image.Width() > 0.0 && in_image.Height() > 0.0 &&
                          DistanceToBorder(in_image, camera.width, camera.height) > kCutPx;
    if (!is_whole) continue;
    if (row.score < view.options.min_score || moving.contains(row.object_id)) continue;
    if (!content.has_object_ids && repeated.contains(row.label)) continue;
    const std::string name = content.has_object_ids ? std::to_string(row.object_id) : row.label;
    TrackedObject& object = by_name[name];
    if (content.has_object_ids) object.object_id = row.object_id;
    const double diagonal_deg = AngleBetweenDeg(camera.Ray({row.box.x_min, row.box.y_min}),
                                                camera.Ray({row.box.x_max, row.box.y_max}));
    object.rays.push_back({frame, camera.Ray(row.box.Centre()).normalized(), 0.5 * diagonal_deg});
  }
  std::vector<TrackedObject> objects;
  for (auto& [name, object] : by_name) {
    if (object.rays.size() > kFewestRays) objects.push_back(std::move(object));
  }
  return objects;
}

std::optional<Eigen::Vector3d> NearestPointInWorld(const std::vector<TrackedRay>& rays,
                                                   const PoseOfFrame& world_from_camera) {
  constexpr double kLeastSpread = 1e-4;  // rays within half a degree of each other
  std::vector<Ray> in_world;
  for (const TrackedRay& ray : rays) {
    const auto pose = world_from_camera(ray.frame);
    if (pose) in_world.push_back({pose->translation, pose->rotation * ray.ray_in_camera});
  }
  if (in_world.size() < kFewestRays) return std::nullopt;
  return NearestPointToRays(in_world, kLeastSpread);
}

std::optional<RayError> MedianRayError(const std::vector<TrackedObject>& objects,
                                       const PoseOfFrame& world_from_camera) {
  std::vector<double> errors_deg, shares;
  size_t met = 0;
  for (const TrackedObject& object : objects) {
    const auto point_in_world = NearestPointInWorld(object.rays, world_from_camera);
    if (!point_in_world) continue;
    ++met;
    for (const TrackedRay& ray : object.rays) {
      const auto pose = world_from_camera(ray.frame);
      if (!pose) continue;
      errors_deg.push_back(AngleBetweenDeg(ray.ray_in_camera, pose->Inverse() * *point_in_world));
      shares.push_back(errors_deg.back() / ray.half_diagonal_deg);
    }
  }
  if (errors_deg.empty()) return std::nullopt;
  const size_t rays = errors_deg.size();
  return RayError{*MedianOf(std::move(errors_deg)), *MedianOf(std::move(shares)), rays, met};
}

std::optional<Rigid3d> PoseOfOther(const ImportView& view, size_t frame, size_t other) {
  const std::vector<ListedFrame>& frames = view.content.frames;
  if (other >= frames.size()) return std::nullopt;
  if (frames[other].frame.segment != frames[frame].frame.segment) return std::nullopt;
  return frames[other].Pose();
}

bool IsComparable(const std::optional<RayError>& error, const RayError& as_read) {
  constexpr double kMost = 0.8;
  return error && static_cast<double>(error->rays) >= kMost * static_cast<double>(as_read.rays);
}

}  // namespace soslam
