// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <cmath>
#include <set>

#include "soslam/model/occlusion.h"
#include "soslam/report/page_parts.h"

namespace soslam {
namespace {

using nlohmann::json;

json Rounded(double value, double per_unit) {
  return std::isfinite(value) ? json(std::round(value * per_unit) / per_unit) : json();
}

json PageLength(double metres) { return Rounded(metres, 1e4); }
json PageCoordinate(double pixels) { return Rounded(pixels, 10.0); }

}  // namespace

std::optional<double> OnPage(double value) {
  if (!std::isfinite(value)) return std::nullopt;
  return std::stod(fmt::format("{:.5g}", value));
}

json PageNumber(double value) {
  const std::optional<double> number = OnPage(value);
  return number ? json(*number) : json();
}

json PageNumbers(const std::vector<double>& values) {
  json numbers = json::array();
  for (const double value : values) numbers.push_back(PageNumber(value));
  return numbers;
}

json PageVector(const Eigen::Vector3d& metres) {
  return {PageLength(metres.x()), PageLength(metres.y()), PageLength(metres.z())};
}

json PagePose(const Rigid3d& pose) {
  json numbers = PageVector(pose.translation);
  for (const double part : pose.rotation.coeffs()) numbers.push_back(PageNumber(part));
  return numbers;
}

json PageLandmark(const Landmark& landmark_in_world) {
  return {{"pose", PagePose(landmark_in_world.frame_from_object)},
          {"half_axes", PageVector(landmark_in_world.half_axes)},
          {"p",
           {PageNumber(landmark_in_world.shape_exponents.horizontal),
            PageNumber(landmark_in_world.shape_exponents.vertical)}}};
}

json PagePixels(const std::vector<Eigen::Vector2d>& pixels) {
  json numbers = json::array();
  for (const Eigen::Vector2d& pixel : pixels) {
    numbers.push_back(PageCoordinate(pixel.x()));
    numbers.push_back(PageCoordinate(pixel.y()));
  }
  return numbers;
}

json PageOutline(const Camera& camera, const Landmark& landmark_in_camera) {
  json axes;
  if (const auto projected = ProjectedAxes(camera, landmark_in_camera)) {
    for (const LineSegment2& axis : *projected) axes.push_back(PagePixels({axis[0], axis[1]}));
  }
  return {{"outline", PagePixels(OutlinePolygon(camera, landmark_in_camera))}, {"axes", axes}};
}

namespace {

using PointsByPlane = std::vector<std::vector<Eigen::Vector3d>>;

PlaneGrids GridsAround(const PointsByPlane& points, const std::vector<Plane>& planes_in_world) {
  PlaneGrids grids(points.size());
  for (size_t i = 0; i < grids.size(); ++i) {
    if (!points[i].empty()) grids[i] = GridAround(planes_in_world[i], points[i]).lines;
  }
  return grids;
}

}  // namespace

PlaneGrids GridsOfSequence(const Sequence& sequence) {
  if (!sequence.HasSupports()) return {};
  PointsByPlane points(sequence.planes.size());
  for (const Detection& detection : sequence.detections) {
    const Object& object = sequence.ObjectOf(detection);
    const auto plane_index = static_cast<size_t>(object.plane_index);
    if (object.ground_truth) {
      points[plane_index].push_back(object.ground_truth->landmark_in_world.Centre());
      continue;
    }
    const Rigid3d& world_from_camera = sequence.FrameOf(detection).world_from_camera;
    const auto foot = GroundContactInCamera(
        sequence.CameraOf(detection), detection.box,
        Transform(world_from_camera.Inverse(), sequence.planes[plane_index].plane_in_world));
    if (foot) points[plane_index].push_back(world_from_camera * *foot);
  }
  return GridsAround(points, PlanesOf(sequence));
}

PlaneGrids GridsOfMap(const MapEstimate& map, const Sequence& sequence) {
  PointsByPlane points(map.planes_in_world.size());
  if (points.empty()) return {};
  for (const ObjectEstimate& estimate : map.objects) {
    const Object& object = sequence.objects[estimate.object_index];
    if (!estimate.landmark_in_world || object.plane_index == kNoPlane) continue;
    points[object.plane_index].push_back(estimate.landmark_in_world->Centre());
  }
  return GridsAround(points, map.planes_in_world);
}

json PageGrids(const PlaneGrids& grids) {
  json planes = json::array();
  for (const auto& grid : grids) {
    json lines = json::array();
    for (const LineSegment3& line : grid) {
      json ends = PageVector(line[0]);
      for (const json& part : PageVector(line[1])) ends.push_back(part);
      lines.push_back(std::move(ends));
    }
    planes.push_back(std::move(lines));
  }
  return planes;
}

json PageGridInFrame(const Sequence& sequence, int frame_index, const PlaneGrids& grids,
                     const std::function<Rigid3d(const Detection&)>& camera_from_world_for) {
  json lines = json::array();
  if (!sequence.HasSupports()) return lines;
  std::set<int> drawn;
  for (const Detection& detection : DetectionsIn(sequence, frame_index)) {
    const int plane_index = sequence.ObjectOf(detection).plane_index;
    if (!drawn.insert(plane_index).second) continue;
    const Rigid3d camera_from_world = camera_from_world_for(detection);
    for (const LineSegment3& line : grids[plane_index]) {
      const auto segment = ProjectSegment(
          sequence.CameraOf(detection), {camera_from_world * line[0], camera_from_world * line[1]});
      if (segment) lines.push_back(PagePixels({(*segment)[0], (*segment)[1]}));
    }
  }
  return lines;
}

Rigid3d CameraAbovePlane(const Sequence& sequence, const Detection& detection) {
  const Frame& frame = sequence.FrameOf(detection);
  const SupportPlane& plane = sequence.planes[sequence.ObjectOf(detection).plane_index];
  if (!plane.attitude_information) {
    return frame.true_world_from_camera.value_or(frame.world_from_camera).Inverse();
  }
  const Rigid3d camera_from_world = frame.world_from_camera.Inverse();
  const Plane by_odometry = Transform(camera_from_world, plane.plane_in_world);
  const Plane& seen = detection.plane_in_camera;
  const Rigid3d correction = {RotationBetween(by_odometry.normal, seen.normal),
                              (by_odometry.offset - seen.offset) * seen.normal};
  return correction * camera_from_world;
}

}  // namespace soslam
