// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/object_points.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/triangulation.h"
#include "model/occlusion.h"

namespace soslam {
namespace {

constexpr double kHuberPx = 1.0;
constexpr size_t kFewestFramesInBox = 2;
// Probability that a point which all frames see in the box of an object is of the object.
constexpr double kObjectShare = 0.7;
// Priors below this are those of points on the plane.
constexpr double kLeastPrior = 0.01;

// Image point of a point that frames of the sequence see.
struct View {
  size_t frame_index;
  Eigen::Vector2d pixel;  // without lens distortion
};

// Image points of one point in frames with a box of an object.
struct PlacesInBoxes {
  std::vector<int> in_box;  // detections in whose box it is
  int frames = 0;
};

class ObjectPointFinder {
 public:
  ObjectPointFinder(const Sequence& sequence, const PointOptions& options)
      : sequence_(sequence),
        options_(options),
        detections_in_(sequence.frames.size()),
        found_(sequence.objects.size()) {
    for (size_t i = 0; i < sequence.detections.size(); ++i) {
      const Detection& detection = sequence.detections[i];
      detections_in_[detection.frame_index].push_back(static_cast<int>(i));
      nearer_boxes_.push_back(BoxesInFront(sequence, detection));
    }
  }

  void Add(int index, const MapPoint& point) {
    for (const auto& [segment, views] : ViewsBySegment(point)) AddViews(index, views);
  }

  std::vector<PointsOfObject> Found() const {
    std::vector<PointsOfObject> result(found_.size());
    for (size_t i = 0; i < found_.size(); ++i) {
      for (const auto& [anchor, points] : found_[i]) result[i].push_back({anchor, points});
    }
    return result;
  }

 private:
  void AddViews(int index, const std::vector<View>& views) {
    std::vector<PointView> in_cameras;
    for (const View& view : views) {
      const Frame& frame = sequence_.frames[view.frame_index];
      in_cameras.push_back(
          {sequence_.CameraOf(frame), frame.world_from_camera.Inverse(), view.pixel});
    }
    std::optional<TriangulatedPoint> triangulated;
    for (const auto& [object_index, places] : PlacesOf(views)) {
      if (places.in_box.size() < kFewestFramesInBox) continue;
      if (!triangulated) triangulated = Triangulate(in_cameras, kHuberPx);
      if (!triangulated) return;
      const int anchor = places.in_box[places.in_box.size() / 2];
      ObjectPoint of_object = PointOf(*triangulated, views.size(), places, anchor);
      of_object.index = index;
      if (!(of_object.prior > kLeastPrior)) continue;
      found_[object_index][anchor].push_back(of_object);
    }
  }

  const Detection& DetectionAt(int index) const { return sequence_.detections[index]; }

  // Each segment has its own world.
  std::map<int, std::vector<View>> ViewsBySegment(const MapPoint& point) const {
    std::map<int, std::vector<View>> views;
    for (const PointObservation& observation : point.observations) {
      const auto index = FrameIndexOf(sequence_, observation);
      if (!index) continue;
      const auto pixel = UndistortedPixel(sequence_, observation);
      if (pixel) views[sequence_.frames[*index].segment].push_back({*index, *pixel});
    }
    return views;
  }

  // One entry for each object.
  std::map<int, PlacesInBoxes> PlacesOf(const std::vector<View>& views) const {
    std::map<int, PlacesInBoxes> places;
    for (const View& view : views) {
      for (const int index : detections_in_[view.frame_index]) {
        PlacesInBoxes& of_object = places[DetectionAt(index).object_index];
        ++of_object.frames;
        const auto contains = [&](const Box& box) { return box.Contains(view.pixel); };
        if (contains(DetectionAt(index).box) &&
            std::ranges::none_of(nearer_boxes_[index], contains)) {
          of_object.in_box.push_back(index);
        }
      }
    }
    return places;
  }

  // Errors of the image points of one track are correlated: together they are as precise as two.
  ObjectPoint PointOf(const TriangulatedPoint& point, size_t views, const PlacesInBoxes& places,
                      int anchor) const {
    const Rigid3d camera_from_world =
        sequence_.FrameOf(DetectionAt(anchor)).world_from_camera.Inverse();
    const Eigen::Matrix3d rotation = camera_from_world.rotation.toRotationMatrix();
    const double sigma_px = std::max(kLeastPixelSigma, point.mean_error_px);
    const Eigen::Matrix3d covariance_in_world =
        0.5 * static_cast<double>(views) * sigma_px * sigma_px * point.covariance;
    ObjectPoint result;
    result.position = camera_from_world * point.position_in_world;
    result.covariance = rotation * covariance_in_world * rotation.transpose();
    const Object& object = sequence_.ObjectOf(DetectionAt(anchor));
    const Plane& plane_in_world = sequence_.planes[object.plane_index].plane_in_world;
    const Eigen::Vector3d& normal = plane_in_world.normal;
    const double height = plane_in_world.SignedDistance(point.position_in_world);
    const double sigma = std::hypot(std::sqrt(normal.dot(covariance_in_world * normal)),
                                    options_.point_range_fraction * result.position.norm());
    const double deviations = 0.5 * height / sigma;
    // Probability that the point is not on the plane; 0 below it.
    const double is_above = height > 0.0 ? 1.0 - std::exp(-0.5 * deviations * deviations) : 0.0;
    result.prior =
        kObjectShare * static_cast<double>(places.in_box.size()) / places.frames * is_above;
    return result;
  }

  const Sequence& sequence_;
  const PointOptions& options_;
  std::vector<std::vector<int>> detections_in_;
  std::vector<std::vector<Box>> nearer_boxes_;  // by detection
  std::vector<std::map<int, std::vector<ObjectPoint>>> found_;
};

}  // namespace

std::vector<PointsOfObject> FindObjectPoints(const Sequence& sequence,
                                             const std::vector<MapPoint>& points,
                                             const PointOptions& options) {
  ObjectPointFinder finder(sequence, options);
  for (size_t i = 0; i < points.size(); ++i) finder.Add(static_cast<int>(i), points[i]);
  return finder.Found();
}

FurtherEvidence InCamera(const PointEvidence& points) {
  const auto cost_at = [points](const Landmark& in_camera) {
    return std::make_unique<PointCost>(points.points, in_camera, points.size_m, points.options,
                                       points.weight);
  };
  return {cost_at, Rigid3d()};
}

double PointWeight(const PointsOfObject& points, const PointOptions& options) {
  double expected = 0.0;
  for (const PointsInView& view : points) {
    for (const ObjectPoint& point : view.points) expected += point.prior;
  }
  return expected > options.effective_points ? options.effective_points / expected : 1.0;
}

PointsInFrames::PointsInFrames(const Sequence& sequence, const std::vector<MapPoint>& points,
                               const PointOptions& options)
    : sequence_(sequence),
      options_(options),
      points_(FindObjectPoints(sequence, points, options)) {}

std::optional<PointEvidence> PointsInFrames::Of(int detection_index,
                                                const std::vector<Hypothesis>& hypotheses) const {
  const Detection& detection = sequence_.detections[detection_index];
  if (hypotheses.empty() || !sequence_.ObjectOf(detection).is_static) return std::nullopt;
  const Frame& frame = sequence_.FrameOf(detection);
  PointsInView in_frame{detection_index, {}};
  for (const PointsInView& view : points_[detection.object_index]) {
    const Frame& other = sequence_.FrameOf(sequence_.detections[view.detection_index]);
    if (other.segment != frame.segment) continue;
    const Rigid3d camera_from_other = frame.world_from_camera.Inverse() * other.world_from_camera;
    const Eigen::Matrix3d rotation = camera_from_other.rotation.toRotationMatrix();
    for (ObjectPoint point : view.points) {
      point.position = camera_from_other * point.position;
      point.covariance = rotation * point.covariance * rotation.transpose();
      in_frame.points.push_back(point);
    }
  }
  if (in_frame.points.empty()) return std::nullopt;
  std::vector<Landmark> landmarks;
  for (const Hypothesis& one : hypotheses) landmarks.push_back(one.landmark_in_camera);
  return PointEvidence{in_frame.points, SizeForPoints(landmarks), PointWeight({in_frame}, options_),
                       options_};
}

}  // namespace soslam
