// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include "dataset/dataset_checks.h"
#include "dataset/tracked_rays.h"
#include "evaluation/statistics.h"

namespace soslam {
namespace {

// The plane that most objects are on (then most detections), with these detections; empty where no
// plane is known. Others may well be above cameras, as shelves are, or upright, as walls are.
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

std::string PlaneInWords(const Sequence& sequence, const Detection& detection) {
  if (sequence.planes.empty()) return "the support plane";
  const auto index = static_cast<size_t>(sequence.ObjectOf(detection).plane_index);
  const SupportPlane& plane = sequence.planes.at(index);
  const Eigen::Vector3d& n = plane.plane_in_world.normal;
  return fmt::format("plane {} (normal {:.3g} {:.3g} {:.3g}, d {:.3g})", plane.id, n.x(), n.y(),
                     n.z(), plane.plane_in_world.offset);
}

constexpr double kDegPerRad = 180.0 / std::numbers::pi;
constexpr const char* kWall =
    "a wall given as the floor, another axis of the world up, or cameras that were rolled";

// Between the plane's normal and the images' up (deg, median).
double AngleToImagesUpDeg(const std::vector<const Detection*>& detections) {
  std::vector<double> angles;
  for (const Detection* detection : detections) {
    const double up = -detection->plane_in_camera.normal.y();
    angles.push_back(kDegPerRad * std::acos(std::clamp(up, -1.0, 1.0)));
  }
  return *MedianOf(angles);
}

// Whether the plane is rather upright, as cameras are held.
bool IsUpright(const std::vector<const Detection*>& detections) {
  const double angle_deg = AngleToImagesUpDeg(detections);
  return angle_deg > 60.0 && angle_deg < 120.0;
}

// The side of the plane on which the cameras are.
std::vector<Finding> CheckSide(const Sequence& sequence,
                               const std::vector<const Detection*>& detections) {
  const auto below = std::ranges::count_if(detections, [](const Detection* detection) {
    return detection->plane_in_camera.offset <= 0.0;
  });
  const auto all = static_cast<std::ptrdiff_t>(detections.size());
  if (2 * below <= all) return {};
  return {{"plane_side", below == all ? Severity::kError : Severity::kWarning,
           fmt::format("{} of {} views of objects on {} are from below it or from within", below,
                       all, PlaneInWords(sequence, *detections.front())),
           "cameras on the side that the normal points to: normal . x + d > 0",
           IsUpright(detections) ? kWall : "a normal that points down, or d of the other sign",
           IsUpright(detections) ? "give the plane that objects stand on"
                                 : "turn the sign of the normal and of d, or of d alone"}};
}

// Whether what stands on a plane is about as high above it, as far as boxes tell; things before a
// wall are not.
bool AreObjectsAlong(const ImportView& view, const Plane& plane_in_world) {
  std::vector<double> heights;
  std::vector<Eigen::Vector3d> points;
  const auto pose = [&](size_t frame) -> std::optional<Rigid3d> {
    const ListedFrame& listed = view.content.frames[frame];
    return listed.has_pose ? std::optional(listed.frame.world_from_camera) : std::nullopt;
  };
  for (const auto& rays : TrackedRays(view)) {
    const auto point = NearestPointInWorld(rays, pose);
    if (!point) continue;
    points.push_back(*point);
    heights.push_back(plane_in_world.SignedDistance(*point));
  }
  constexpr size_t kFewest = 3;
  if (points.size() < kFewest) return false;
  Eigen::Vector3d low = points.front(), high = points.front();
  for (const Eigen::Vector3d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const auto [lowest, highest] = std::ranges::minmax(heights);
  return lowest > 0.0 && highest - lowest < 0.5 * (high - low).norm();
}

std::vector<Finding> CheckAttitude(const ImportView& view,
                                   const std::vector<const Detection*>& detections) {
  const Sequence& sequence = view.sequence;
  if (!IsUpright(detections) || sequence.planes.empty()) return {};
  const auto index = static_cast<size_t>(sequence.ObjectOf(*detections.front()).plane_index);
  if (AreObjectsAlong(view, sequence.planes.at(index).plane_in_world)) return {};
  return {{"plane_attitude", Severity::kWarning,
           fmt::format("the normal of {} is {:.0f} degrees from the images' up",
                       PlaneInWords(sequence, *detections.front()), AngleToImagesUpDeg(detections)),
           "a plane that most objects stand on, about level as cameras are held", kWall,
           "give the plane that objects stand on, in the world of the poses"}};
}

}  // namespace

std::vector<Finding> CheckPlanes(const ImportView& view) {
  const auto detections = DetectionsOnMainPlane(view.sequence);
  if (detections.empty()) return {};
  std::vector<Finding> findings = CheckSide(view.sequence, detections);
  if (findings.empty()) findings = CheckAttitude(view, detections);
  return findings;
}

}  // namespace soslam
