// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "dataset/dataset_checks.h"
#include "dataset/tracked_rays.h"
#include "evaluation/statistics.h"
#include "geometry/angles.h"

namespace soslam {
namespace {

// Detections on the plane with most objects (then most detections); empty where no plane is known.
// Other planes may be above cameras, as shelves are, or upright, as walls are.
std::vector<const Detection*> DetectionsOnMainPlane(const Sequence& sequence) {
  std::map<int, std::set<int>> objects;
  std::map<int, std::vector<const Detection*>> detections;
  for (const Detection& detection : sequence.detections) {
    const int plane = sequence.ObjectOf(detection).plane_index;
    if (plane == kNoPlane) continue;
    objects[plane].insert(detection.object_index);
    detections[plane].push_back(&detection);
  }
  std::vector<const Detection*> most;
  size_t most_objects = 0;
  for (const auto& [plane, on_it] : objects) {
    const auto& of_plane = detections[plane];
    if (on_it.size() < most_objects) continue;
    if (on_it.size() == most_objects && of_plane.size() <= most.size()) continue;
    most_objects = on_it.size();
    most = of_plane;
  }
  return most;
}

std::string PlaneInWords(const SupportPlane& plane) {
  const Eigen::Vector3d& n = plane.plane_in_world.normal;
  return fmt::format("plane {} (normal {:.3g} {:.3g} {:.3g}, d {:.3g})", plane.id, n.x(), n.y(),
                     n.z(), plane.plane_in_world.offset);
}

constexpr const char* kWall =
    "a wall given as the floor, another axis of the world up, or cameras that were rolled";

// Median angle (deg) between the plane's normal and the images' up.
double AngleToImagesUpDeg(const std::vector<const Detection*>& detections) {
  std::vector<double> angles;
  for (const Detection* detection : detections) {
    angles.push_back(AngleBetweenDeg(detection->plane_in_camera.normal, -Eigen::Vector3d::UnitY()));
  }
  return *MedianOf(angles);
}

// True if the plane is about vertical, given the way cameras are held.
bool IsUpright(const std::vector<const Detection*>& detections) {
  const double angle_deg = AngleToImagesUpDeg(detections);
  return angle_deg > 60.0 && angle_deg < 120.0;
}

// Triangulated points of the objects on a plane, in the world of the planes.
std::vector<Eigen::Vector3d> PointsOnPlane(const ImportView& view, int plane_index) {
  const bool has_true_planes =
      view.options.camera_planes == PlanePoses::kGroundTruth && view.content.has_true_poses;
  const auto pose = [&](size_t frame) -> std::optional<Rigid3d> {
    const ListedFrame& listed = view.content.frames[frame];
    if (has_true_planes) return listed.frame.true_world_from_camera;
    return listed.has_pose ? std::optional(listed.frame.world_from_camera) : std::nullopt;
  };
  std::set<int> on_plane;
  for (const Object& object : view.content.objects) {
    if (object.plane_index == plane_index) on_plane.insert(object.id);
  }
  std::vector<Eigen::Vector3d> points;
  for (const TrackedObject& thing : TrackedThings(view)) {
    if (thing.object_id && !on_plane.contains(*thing.object_id)) continue;
    const auto point = NearestPointInWorld(thing.rays, pose);
    if (point) points.push_back(*point);
  }
  return points;
}

std::vector<double> HeightsOver(const Plane& plane, const std::vector<Eigen::Vector3d>& points) {
  std::vector<double> heights;
  for (const Eigen::Vector3d& point : points) heights.push_back(plane.SignedDistance(point));
  return heights;
}

// The main plane and the objects on it.
struct MainPlane {
  SupportPlane plane;
  std::vector<const Detection*> detections;
  std::vector<Eigen::Vector3d> points_in_world;
};

// Checks on which side of the plane cameras and objects are. Cameras alone may be below it, as
// those of a robot below a table.
std::vector<Finding> CheckSide(const MainPlane& main) {
  const auto below = std::ranges::count_if(main.detections, [](const Detection* detection) {
    return detection->plane_in_camera.offset <= 0.0;
  });
  const auto all = std::ssize(main.detections);
  if (2 * below <= all) return {};
  const auto height = MedianOf(HeightsOver(main.plane.plane_in_world, main.points_in_world));
  if (height && *height > 0.0) return {};
  const bool is_upright = IsUpright(main.detections);
  return {{"plane_side", height ? Severity::kError : Severity::kWarning,
           fmt::format("{} of {} views of objects on {} are from below it or from within, and so "
                       "{} the objects, as far as boxes tell",
                       below, all, PlaneInWords(main.plane), height ? "are" : "may be"),
           "cameras and objects on the side that the normal points to: normal . x + d > 0",
           is_upright ? kWall : "a normal that points down, or d of the other sign",
           is_upright ? "give the plane that objects stand on"
                      : "turn the sign of the normal and of d, or of d alone"}};
}

// True if all objects are about equally high above their plane; objects in front of a wall are not.
bool AreAlong(const Plane& plane, const std::vector<Eigen::Vector3d>& points) {
  constexpr double kTolerance = 0.1;
  constexpr double kFlat = 0.5;
  Eigen::AlignedBox3d around;
  for (const Eigen::Vector3d& point : points) around.extend(point);
  const double size = around.diagonal().norm();
  const std::vector<double> heights = HeightsOver(plane, points);
  const auto [lowest, highest] = std::ranges::minmax(heights);
  return lowest > -kTolerance * size && highest - lowest < kFlat * size;
}

std::vector<Finding> CheckAttitude(const MainPlane& main) {
  constexpr size_t kFewest = 3;
  if (!IsUpright(main.detections) || main.points_in_world.size() < kFewest) return {};
  if (AreAlong(main.plane.plane_in_world, main.points_in_world)) return {};
  return {
      {"plane_attitude", Severity::kWarning,
       fmt::format("the normal of {} is {:.0f} degrees from the images' up, and objects are not "
                   "along it",
                   PlaneInWords(main.plane), AngleToImagesUpDeg(main.detections)),
       "a plane that most objects stand on, about level as cameras are held", kWall,
       "give the plane that objects stand on, in the world of the poses"}};
}

}  // namespace

std::vector<Finding> CheckPlanes(const ImportView& view) {
  MainPlane main;
  main.detections = DetectionsOnMainPlane(view.sequence);
  if (main.detections.empty()) return {};
  const int index = view.sequence.ObjectOf(*main.detections.front()).plane_index;
  main.plane = view.sequence.planes.at(static_cast<size_t>(index));
  main.points_in_world = PointsOnPlane(view, index);
  std::vector<Finding> findings = CheckSide(main);
  if (findings.empty()) findings = CheckAttitude(main);
  return findings;
}

}  // namespace soslam
