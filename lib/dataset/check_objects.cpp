// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <optional>

#include "dataset/dataset_checks.h"
#include "evaluation/statistics.h"
#include "geometry/angles.h"

namespace soslam {
namespace {

constexpr size_t kFewest = 10;  // minimum number of usable boxes
constexpr double kCutPx =
    2.0;  // distance from the border at which a box counts as cut by the image

// A box and the true landmark with its id, in the same camera's frame.
struct BoxAndTruth {
  Box box;
  Camera camera;
  Landmark landmark_in_camera;
};

// Uncut boxes of static objects with the true landmarks of the objects with their id plus `shift`.
std::vector<BoxAndTruth> BoxesAndTruth(const ImportView& view, int shift) {
  std::map<std::int64_t, const Landmark*> landmarks;
  for (const Object& object : view.content.objects) {
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
    const Camera camera = frame->second->camera.value_or(view.content.camera);
    const Box in_image = row.box_in_image_file.value_or(row.box);
    if (DistanceToBorder(in_image, camera.width, camera.height) <= kCutPx) continue;
    const Rigid3d world_from_camera =
        frame->second->true_world_from_camera.value_or(frame->second->world_from_camera);
    pairs.push_back({row.box, camera, Transform(world_from_camera.Inverse(), *landmark->second)});
  }
  return pairs;
}

// Median angle (deg) between boxes and centres; none when there are too few.
std::optional<double> MedianAngleDeg(const std::vector<BoxAndTruth>& pairs) {
  std::vector<double> angles;
  for (const auto& [box, camera, landmark] : pairs) {
    angles.push_back(
        AngleBetweenDeg(camera.Ray(box.Centre()), landmark.frame_from_object.translation));
  }
  return angles.size() < kFewest ? std::nullopt : MedianOf(angles);
}

std::vector<Finding> CheckCentres(const ImportView& view) {
  constexpr double kFarOffDeg = 10.0;
  constexpr double kMuchBetter = 0.25;
  const auto as_read = MedianAngleDeg(BoxesAndTruth(view, 0));
  if (!as_read || *as_read <= kFarOffDeg) return {};
  Finding finding{
      "objects_against_boxes",
      Severity::kWarning,
      fmt::format("boxes are {:.1f} degrees from the true centre of their object (median)",
                  *as_read),
      "true objects where their boxes see them",
      "true objects in another world, unit or order of axes than the poses, or ids that are not "
      "the "
      "detections'",
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

// Height (px) of a landmark's outline; from its distance where it has no outline, for example
// because the camera is inside it.
double HeightPx(const Camera& camera, const Landmark& landmark_in_camera) {
  const auto outline = OutlineBox(camera, landmark_in_camera);
  if (outline) return outline->Height();
  return 2.0 * camera.fy * landmark_in_camera.half_axes.z() / landmark_in_camera.Centre().norm();
}

// Compares heights of outlines with those of the boxes.
std::vector<Finding> CheckTrueSizes(const ImportView& view) {
  constexpr double kLargestFactor = 1.6;
  constexpr double kFactorOfUnit = 5.0;
  std::vector<double> log_factors;
  for (const auto& [box, camera, landmark] : BoxesAndTruth(view, 0)) {
    if (box.Height() <= 0.0) continue;
    log_factors.push_back(std::log(HeightPx(camera, landmark) / box.Height()));
  }
  if (log_factors.size() < kFewest) return {};
  const double factor = std::exp(*MedianOf(log_factors));
  if (factor < kLargestFactor && factor > 1.0 / kLargestFactor) return {};
  const bool is_of_unit = factor > kFactorOfUnit || factor < 1.0 / kFactorOfUnit;
  return {{"object_half_axes", Severity::kWarning,
           fmt::format("true objects look {:.2g} times as high as their boxes (median)", factor),
           "true objects as large as their boxes",
           is_of_unit ? "half_axes in another unit than metres, as centimetres"
                      : "full sizes in place of half_axes, or the reverse",
           "give half of the object's depth, width and height in metres as half_axes"}};
}

}  // namespace

// Compares the z axes of upright objects with the normals of their planes.
std::vector<Finding> CheckObjectAxes(const ImportView& view) {
  constexpr double kSteepestDeg = 30.0;
  constexpr size_t kFewestObjects = 2;
  std::vector<double> angles;
  for (const Object& object : view.content.objects) {
    if (!object.ground_truth || object.plane_index == kNoPlane) continue;
    const auto plane = static_cast<size_t>(object.plane_index);
    const Eigen::Vector3d z = object.ground_truth->landmark_in_world.frame_from_object.rotation *
                              Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d& normal = view.content.planes.at(plane).plane_in_world.normal;
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
  if (!view.content.has_object_ids) return {};
  std::vector<Finding> findings = CheckCentres(view);
  if (findings.empty()) findings = CheckTrueSizes(view);
  return findings;
}

}  // namespace soslam
