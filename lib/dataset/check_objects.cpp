// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <map>
#include <numbers>
#include <optional>

#include "dataset/dataset_checks.h"
#include "evaluation/statistics.h"

namespace soslam {
namespace {

using CentresById = std::map<int, Eigen::Vector3d>;

// The true centres of objects, in the world.
CentresById TrueCentres(const ImportView& view) {
  CentresById centres;
  for (const Object& object : view.content.objects) {
    if (!object.ground_truth || !object.is_static) continue;
    centres[object.id] = object.ground_truth->landmark_in_world.frame_from_object.translation;
  }
  return centres;
}

// How far (deg, median) boxes are from the true centre of the object with their id plus `shift`.
// None when there are too few.
std::optional<double> MedianAngleDeg(const ImportView& view, const CentresById& centres,
                                     int shift) {
  constexpr size_t kFewest = 10;
  std::map<int, const Frame*> frames;
  for (const ListedFrame& listed : view.content.frames) {
    if (listed.has_pose) frames[listed.frame.id] = &listed.frame;
  }
  std::vector<double> angles;
  for (const DetectionRow& row : view.content.rows) {
    const auto centre = centres.find(row.object_id + shift);
    const auto frame = frames.find(row.frame_id);
    if (centre == centres.end() || frame == frames.end()) continue;
    const Rigid3d world_from_camera =
        frame->second->true_world_from_camera.value_or(frame->second->world_from_camera);
    const Eigen::Vector3d towards = world_from_camera.Inverse() * centre->second;
    const Eigen::Vector3d ray = view.content.camera.Ray(row.box.Centre());
    angles.push_back(std::atan2(ray.cross(towards).norm(), ray.dot(towards)) * 180.0 /
                     std::numbers::pi);
  }
  return angles.size() < kFewest ? std::nullopt : MedianOf(angles);
}

}  // namespace

std::vector<Finding> CheckObjects(const ImportView& view) {
  constexpr double kFarOffDeg = 10.0;
  constexpr double kMuchBetter = 0.25;
  if (!view.content.has_object_ids) return {};
  const CentresById centres = TrueCentres(view);
  const auto as_read = MedianAngleDeg(view, centres, 0);
  if (!as_read || *as_read <= kFarOffDeg) return {};
  Finding finding{
      "objects_against_boxes",
      Severity::kWarning,
      fmt::format("boxes are {:.1f} degrees from the true centre of their object (median)",
                  *as_read),
      "true objects where their boxes see them",
      "true objects in another world, unit or order of axes than the poses, or ids that "
      "are not the detections'",
      "give objects.json in the world of the true poses, in metres, with the detections' "
      "ids"};
  for (const int shift : {-1, 1}) {
    const auto shifted = MedianAngleDeg(view, centres, shift);
    if (!shifted || *shifted >= kMuchBetter * *as_read) continue;
    finding.found += fmt::format(", but {:.1f} from that of the object with the id {}", *shifted,
                                 shift < 0 ? "before" : "after");
    finding.cause = "ids counted from 0 in one file and from 1 in the other";
    finding.remedy = fmt::format("{} 1 {} the object_id of the detections",
                                 shift < 0 ? "subtract" : "add", shift < 0 ? "from" : "to");
  }
  return {finding};
}

}  // namespace soslam
