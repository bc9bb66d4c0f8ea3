// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "soslam/dataset/dataset_checks.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/geometry/angles.h"

namespace soslam {
namespace {

constexpr size_t kFewestBoxes = 10;
constexpr double kCutPx = 2.0;  // boxes this near to the border count as cut by the image

// A box, also as it was drawn, and the true landmark with its id, in its camera's frame.
struct BoxAndTruth {
  Box box;
  TurnedBox as_drawn;
  Camera camera;
  Landmark landmark_in_camera;
};

// Uncut boxes of static objects with the true landmarks of the objects with their id plus `shift`.
std::vector<BoxAndTruth> BoxesAndTruth(const ImportView& view, int shift) {
  std::map<std::int64_t, const Landmark*> landmarks;
  for (const Object& object : view.sequence.objects) {
    if (!object.ground_truth || !object.is_static) continue;
    landmarks[object.id] = &object.ground_truth->landmark_in_world;
  }
  std::map<int, const Frame*> frames;
  for (const ListedFrame& listed : view.content.frames) {
    if (listed.has_pose) frames[listed.frame.id] = &listed.frame;
  }
  std::vector<BoxAndTruth> pairs;
  for (const DetectionRow& row : view.content.rows) {
    const auto landmark = landmarks.find(std::int64_t{row.object_id} + shift);
    const auto frame = frames.find(row.frame_id);
    if (landmark == landmarks.end() || frame == frames.end()) continue;
    const Camera& camera = view.sequence.CameraOf(*frame->second);
    const Box in_image = row.box_in_image_file.value_or(row.box);
    if (DistanceToBorder(in_image, camera.width, camera.height) <= kCutPx) continue;
    const Rigid3d world_from_camera =
        frame->second->true_world_from_camera.value_or(frame->second->world_from_camera);
    pairs.push_back({row.box, row.as_drawn.value_or(TurnedBox{row.box}), camera,
                     Transform(world_from_camera.Inverse(), *landmark->second)});
  }
  return pairs;
}

// Median angle (deg) between boxes and centres; none when there are too few.
std::optional<double> MedianAngleDeg(const std::vector<BoxAndTruth>& pairs) {
  const auto angles = CollectValues(pairs, [](const BoxAndTruth& pair) {
    return AngleBetweenDeg(pair.camera.Ray(pair.box.Centre()), pair.landmark_in_camera.Centre());
  });
  return angles.size() < kFewestBoxes ? std::nullopt : MedianOf(angles);
}

// Compares heights of outlines with those of the boxes. The camera is rolled as a turned box is,
// which is then upright.
std::vector<Finding> CheckTrueSizes(const ImportView& view) {
  constexpr double kLargestFactor = 1.6;
  constexpr double kFactorOfUnit = 5.0;
  std::vector<double> log_factors;
  for (const auto& [box, as_drawn, camera, landmark] : BoxesAndTruth(view, 0)) {
    const double height_px = as_drawn.box.Height();
    if (height_px <= 0.0) continue;
    const Eigen::AngleAxisd roll(-kRadPerDeg * as_drawn.angle_deg, Eigen::Vector3d::UnitZ());
    const Landmark in_rolled_camera =
        Transform({Eigen::Quaterniond(roll), Eigen::Vector3d::Zero()}, landmark);
    // There is no outline, for example, where the camera is inside the landmark.
    const auto outline = OutlineBox(camera, in_rolled_camera);
    const double true_height_px = outline ? outline->Height()
                                          : 2.0 * camera.fy * in_rolled_camera.half_axes.z() /
                                                in_rolled_camera.Centre().norm();
    log_factors.push_back(std::log(true_height_px / height_px));
  }
  if (log_factors.size() < kFewestBoxes) return {};
  const double factor = std::exp(*MedianOf(log_factors));
  if (factor < kLargestFactor && factor > 1.0 / kLargestFactor) return {};
  const bool is_of_unit = factor > kFactorOfUnit || factor < 1.0 / kFactorOfUnit;
  return {{"object_half_axes", Severity::kWarning,
           fmt::format("true objects look {:.2g} times as high as their boxes (median)", factor),
           "true objects as large as their boxes",
           is_of_unit ? "half_axes in another unit than metres, as centimetres"
                      : "full sizes in place of half_axes, or the reverse, or another focal length",
           "give half of the object's depth, width and height in metres as half_axes"}};
}

}  // namespace

// Compares the z axes of upright objects with the normals of their planes.
std::vector<Finding> CheckObjectAxes(const ImportView& view) {
  constexpr double kSteepestDeg = 30.0;
  constexpr size_t kFewestObjects = 2;
  std::vector<double> angles;
  for (const Object& object : view.sequence.objects) {
    if (!object.ground_truth || object.plane_index == kNoPlane) continue;
    const Eigen::Vector3d z = object.ground_truth->landmark_in_world.frame_from_object.rotation *
                              Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d& normal =
        view.sequence.planes.at(object.plane_index).plane_in_world.normal;
    angles.push_back(AngleBetweenDeg(z, normal));
  }
  if (angles.size() < kFewestObjects || *MedianOf(angles) <= kSteepestDeg) return {};
  return {{"object_axes", Severity::kWarning,
           fmt::format("the z axes of true objects are {:.0f} degrees from the normals of their "
                       "planes (median)",
                       *MedianOf(angles)),
           "z away from the support plane",
           "quaternions with qw first, object_from_world in place of world_from_object, or another "
           "axis of the object up",
           "give quaternion_xyzw of world from object, z away from the support plane"}};
}

std::vector<Finding> CheckObjects(const ImportView& view) {
  constexpr double kFarOffDeg = 10.0;
  constexpr double kMuchBetter = 0.25;
  if (!view.content.has_object_ids) return {};
  const auto as_read = MedianAngleDeg(BoxesAndTruth(view, 0));
  if (!as_read || *as_read <= kFarOffDeg) return CheckTrueSizes(view);
  Finding finding{
      "objects_against_boxes",
      Severity::kWarning,
      fmt::format("boxes are {:.1f} degrees from the true centre of their object (median)",
                  *as_read),
      "true objects where their boxes see them",
      "true objects in another world, unit or order of axes than the poses, or ids that are not "
      "the detections'",
      "give objects.json in the world of the true poses, in metres, with the detections' ids"};
  for (const int shift : {-1, 1}) {
    const auto shifted = MedianAngleDeg(BoxesAndTruth(view, shift));
    if (!shifted || *shifted >= kMuchBetter * *as_read) continue;
    finding.found += fmt::format(", but {:.1f} from that of the object with the id {}", *shifted,
                                 shift < 0 ? "before" : "after");
    finding.cause = "ids counted from 0 in one file and from 1 in the other";
    finding.remedy = fmt::format("{} 1 {} the object_id of the detections",
                                 shift < 0 ? "subtract" : "add", shift < 0 ? "from" : "to");
  }
  return {finding};
}

namespace {

// Detections on the plane with most objects (then most detections); empty where no plane is known.
// Other planes may be above cameras, as shelves are, or upright, as walls are.
std::vector<const Detection*> DetectionsOnMainPlane(const Sequence& sequence) {
  std::map<int, std::vector<const Detection*>> on_plane;
  for (const Detection& detection : sequence.detections) {
    const int plane = sequence.ObjectOf(detection).plane_index;
    if (plane != kNoPlane) on_plane[plane].push_back(&detection);
  }
  if (on_plane.empty()) return {};
  const auto objects_and_detections = [](const auto& entry) {
    std::set<int> objects;
    for (const Detection* detection : entry.second) objects.insert(detection->object_index);
    return std::pair(objects.size(), entry.second.size());
  };
  return std::ranges::max_element(on_plane, {}, objects_and_detections)->second;
}

std::string PlaneInWords(const SupportPlane& plane) {
  const Eigen::Vector3d& n = plane.plane_in_world.normal;
  return fmt::format("plane {} (normal {:.3g} {:.3g} {:.3g}, d {:.3g})", plane.id, n.x(), n.y(),
                     n.z(), plane.plane_in_world.offset);
}

constexpr const char* kWall =
    "a wall given as the floor, another axis of the world up, or cameras that were rolled";

// Triangulated points of the objects on a plane, in the world of the planes.
std::vector<Eigen::Vector3d> PointsOnPlane(const ImportView& view, int plane_index) {
  const bool has_true_planes =
      view.options.camera_planes == PlanePoses::kGroundTruth && view.content.has_true_poses;
  const auto pose = [&](size_t frame) {
    const ListedFrame& listed = view.content.frames[frame];
    return has_true_planes ? listed.frame.true_world_from_camera : listed.Pose();
  };
  std::set<int> on_plane;
  for (const Object& object : view.sequence.objects) {
    if (object.plane_index == plane_index) on_plane.insert(object.id);
  }
  std::vector<Eigen::Vector3d> points;
  for (const TrackedObject& object : TrackedObjects(view)) {
    if (object.object_id && !on_plane.contains(*object.object_id)) continue;
    const auto point = NearestPointInWorld(object.rays, pose);
    if (point) points.push_back(*point);
  }
  return points;
}

}  // namespace

std::vector<Finding> CheckPlanes(const ImportView& view) {
  constexpr size_t kFewestPoints = 3;
  constexpr double kTolerance = 0.1;
  constexpr double kFlat = 0.5;
  const std::vector<const Detection*> detections = DetectionsOnMainPlane(view.sequence);
  if (detections.empty()) return {};
  const int index = view.sequence.ObjectOf(*detections.front()).plane_index;
  const SupportPlane& plane = view.sequence.planes.at(index);
  const std::vector<Eigen::Vector3d> points_in_world = PointsOnPlane(view, index);
  const std::vector<double> heights = CollectValues(points_in_world, [&](const auto& point) {
    return plane.plane_in_world.SignedDistance(point);
  });
  // Median angle between the normal and the images' up, which is about the world's as cameras are
  // held.
  const double angle_deg = *MedianOf(CollectValues(detections, [](const Detection* detection) {
    return AngleBetweenDeg(detection->plane_in_camera.normal, -Eigen::Vector3d::UnitY());
  }));
  const bool is_upright = angle_deg > 60.0 && angle_deg < 120.0;
  const auto below = std::ranges::count_if(detections, [](const Detection* detection) {
    return detection->plane_in_camera.offset <= 0.0;
  });
  const auto height = MedianOf(heights);
  // Cameras alone may be below the plane, as those of a robot below a table.
  if (2 * below > std::ssize(detections) && !(height && *height > 0.0)) {
    return {{"plane_side", height ? Severity::kError : Severity::kWarning,
             fmt::format("{} of {} views of objects on {} are from below it or from within, and so "
                         "{} the objects, as far as boxes tell",
                         below, detections.size(), PlaneInWords(plane), height ? "are" : "may be"),
             "cameras and objects on the side that the normal points to: normal . x + d > 0",
             is_upright ? kWall : "a normal that points down, or d of the other sign",
             is_upright ? "give the plane that objects stand on"
                        : "turn the sign of the normal and of d, or of d alone"}};
  }
  if (!is_upright || points_in_world.size() < kFewestPoints) return {};
  Eigen::AlignedBox3d around;
  for (const Eigen::Vector3d& point : points_in_world) around.extend(point);
  const double size = around.diagonal().norm();
  const auto [lowest, highest] = std::ranges::minmax(heights);
  // Objects on a plane are about equally high above it; objects in front of a wall are not.
  if (lowest > -kTolerance * size && highest - lowest < kFlat * size) return {};
  return {
      {"plane_attitude", Severity::kWarning,
       fmt::format("the normal of {} is {:.0f} degrees from the images' up, and objects are not "
                   "along it",
                   PlaneInWords(plane), angle_deg),
       "a plane that most objects stand on, about level as cameras are held", kWall,
       "give the plane that objects stand on, in the world of the poses"}};
}

}  // namespace soslam
