// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/initialisation/object_points.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "soslam/constraints/point_cost.h"
#include "soslam/geometry/triangulation.h"
#include "soslam/model/occlusion.h"

namespace soslam {
namespace {

constexpr double kHuberPx = 1.0;
constexpr size_t kFewestFramesInBox = 2;
// Probability that a point which all frames see in the box of an object is of the object.
constexpr double kObjectShare = 0.7;
// Priors below this are those of points on the plane.
constexpr double kLeastPrior = 0.01;

// Image points of one point in the frames of a segment that see it. Each segment has its own world.
struct ViewsOfPoint {
  std::vector<size_t> frame_indices;
  std::vector<PointView> views;
};

std::map<int, ViewsOfPoint> ViewsBySegment(const Sequence& sequence, const MapPoint& point) {
  std::map<int, ViewsOfPoint> by_segment;
  for (const PointObservation& observation : point.observations) {
    const auto index = FindFrameIndex(sequence, observation);
    if (!index) continue;
    const Frame& frame = sequence.frames[*index];
    by_segment[frame.segment].frame_indices.push_back(*index);
    by_segment[frame.segment].views.push_back(
        {sequence.CameraOf(frame), frame.world_from_camera.Inverse(), observation.pixel});
  }
  return by_segment;
}

// Image points of one point in frames with a box of an object.
struct PlacesInBoxes {
  std::vector<int> in_box;  // detections in whose box it is
  int frames = 0;
};

// The point in the camera of detection `anchor`. Errors of the image points of one track are
// correlated: together they are as precise as two.
ObjectPoint MakeObjectPoint(const Sequence& sequence, const TriangulatedPoint& point, size_t views,
                            const PlacesInBoxes& places, int anchor, const PointOptions& options) {
  const Detection& detection = sequence.detections[anchor];
  const Rigid3d camera_from_world = sequence.FrameOf(detection).world_from_camera.Inverse();
  const Eigen::Matrix3d rotation = camera_from_world.rotation.toRotationMatrix();
  const double sigma_px = std::max(kLeastPixelSigma, point.mean_error_px);
  const Eigen::Matrix3d covariance_in_world =
      0.5 * static_cast<double>(views) * sigma_px * sigma_px * point.covariance;
  ObjectPoint result;
  result.position = camera_from_world * point.position_in_world;
  result.covariance = rotation * covariance_in_world * rotation.transpose();
  const Plane& plane_in_world =
      sequence.planes[sequence.ObjectOf(detection).plane_index].plane_in_world;
  const Eigen::Vector3d& normal = plane_in_world.normal;
  const double height = plane_in_world.SignedDistance(point.position_in_world);
  const double sigma = std::hypot(std::sqrt(normal.dot(covariance_in_world * normal)),
                                  options.point_range_fraction * result.position.norm());
  const double deviations = 0.5 * height / sigma;
  // Probability that the point is not on the plane; 0 below it.
  const double is_above = height > 0.0 ? 1.0 - std::exp(-0.5 * deviations * deviations) : 0.0;
  result.prior =
      kObjectShare * static_cast<double>(places.in_box.size()) / places.frames * is_above;
  return result;
}

}  // namespace

std::vector<PointsOfObject> FindObjectPoints(const Sequence& sequence,
                                             const std::vector<MapPoint>& points,
                                             const PointOptions& options) {
  std::vector<std::vector<int>> detections_in(sequence.frames.size());
  std::vector<std::vector<Box>> nearer_boxes;  // by detection
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    detections_in[detection.frame_index].push_back(static_cast<int>(i));
    nearer_boxes.push_back(BoxesInFront(sequence, detection));
  }
  std::vector<std::map<int, std::vector<ObjectPoint>>> found(sequence.objects.size());  // by anchor
  for (size_t i = 0; i < points.size(); ++i) {
    for (const auto& [segment, seen] : ViewsBySegment(sequence, points[i])) {
      std::map<int, PlacesInBoxes> places;  // by object
      for (size_t k = 0; k < seen.views.size(); ++k) {
        const Eigen::Vector2d& pixel = seen.views[k].pixel;
        const auto contains = [&](const Box& box) { return box.Contains(pixel); };
        for (const int index : detections_in[seen.frame_indices[k]]) {
          PlacesInBoxes& of_object = places[sequence.detections[index].object_index];
          ++of_object.frames;
          if (contains(sequence.detections[index].box) &&
              std::ranges::none_of(nearer_boxes[index], contains)) {
            of_object.in_box.push_back(index);
          }
        }
      }
      std::optional<TriangulatedPoint> triangulated;
      for (const auto& [object_index, of_object] : places) {
        if (of_object.in_box.size() < kFewestFramesInBox) continue;
        if (!triangulated) triangulated = Triangulate(seen.views, kHuberPx);
        if (!triangulated) break;
        const int anchor = of_object.in_box[of_object.in_box.size() / 2];
        ObjectPoint point =
            MakeObjectPoint(sequence, *triangulated, seen.views.size(), of_object, anchor, options);
        point.index = static_cast<int>(i);
        if (point.prior > kLeastPrior) found[object_index][anchor].push_back(point);
      }
    }
  }
  std::vector<PointsOfObject> result(found.size());
  for (size_t i = 0; i < found.size(); ++i) {
    for (const auto& [anchor, of_object] : found[i]) result[i].push_back({anchor, of_object});
  }
  return result;
}

}  // namespace soslam
