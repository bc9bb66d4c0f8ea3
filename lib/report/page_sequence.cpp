// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_sequence.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include "inspection/projection.h"
#include "report/page_json.h"

namespace soslam {
namespace {

using nlohmann::json;

// Where things are on each plane: true centres where they are known, else what its cameras look at.
std::vector<std::vector<Eigen::Vector3d>> PointsOnPlanes(const Sequence& sequence) {
  std::vector<std::vector<Eigen::Vector3d>> points(sequence.planes.size());
  if (sequence.planes.empty()) return points;
  for (const Detection& detection : sequence.detections) {
    const Object& object = sequence.ObjectOf(detection);
    auto& on_plane = points[static_cast<size_t>(object.plane_index)];
    if (object.ground_truth) {
      on_plane.push_back(object.ground_truth->landmark_in_world.Centre());
      continue;
    }
    const Frame& frame = sequence.FrameOf(detection);
    const Plane& plane = sequence.planes[static_cast<size_t>(object.plane_index)].plane_in_world;
    const Eigen::Vector3d ray =
        frame.world_from_camera.rotation *
        sequence.CameraOf(detection).Ray({detection.box.Centre().x(), detection.box.y_max});
    const double depth =
        -plane.SignedDistance(frame.world_from_camera.translation) / plane.normal.dot(ray);
    if (depth > 0.0 && std::isfinite(depth)) {
      on_plane.push_back(frame.world_from_camera.translation + depth * ray);
    }
  }
  return points;
}

std::vector<std::vector<LineSegment3>> GridsInWorld(const Sequence& sequence) {
  const auto points = PointsOnPlanes(sequence);
  std::vector<std::vector<LineSegment3>> grids(sequence.planes.size());
  for (size_t i = 0; i < grids.size(); ++i) {
    if (!points[i].empty()) grids[i] = PlaneGrid(sequence.planes[i].plane_in_world, points[i]);
  }
  return grids;
}

// Given planes are where the true camera sees them, estimated ones where the estimated one does.
void AddGrid(const Sequence& sequence, const Frame& frame, size_t plane_index,
             const std::vector<LineSegment3>& grid, json* lines) {
  const bool is_given = !sequence.planes[plane_index].attitude_information;
  const Rigid3d camera_from_world =
      (is_given ? frame.true_world_from_camera.value_or(frame.world_from_camera)
                : frame.world_from_camera)
          .Inverse();
  for (const LineSegment3& line : grid) {
    const auto segment = ProjectSegment(sequence.CameraOf(frame),
                                        {camera_from_world * line[0], camera_from_world * line[1]});
    if (segment) lines->push_back(PagePixels({(*segment)[0], (*segment)[1]}));
  }
}

// By frame: the planes of what was detected there.
std::vector<std::set<size_t>> PlanesOfFrames(const Sequence& sequence) {
  std::vector<std::set<size_t>> planes(sequence.frames.size());
  if (sequence.planes.empty()) return planes;
  for (const Detection& detection : sequence.detections) {
    planes[static_cast<size_t>(detection.frame_index)].insert(
        static_cast<size_t>(sequence.ObjectOf(detection).plane_index));
  }
  return planes;
}

// As evaluation compares landmarks: the cuboid around the object.
Landmark AsCuboid(Landmark landmark) {
  landmark.shape_exponent = kCuboidExponent;
  return landmark;
}

json PageFrame(const Sequence& sequence, const Frame& frame) {
  const Camera& camera = sequence.CameraOf(frame);
  return {{"id", frame.id},
          {"timestamp", frame.timestamp},
          {"segment", frame.segment},
          {"width", camera.width},
          {"height", camera.height},
          {"pose", PagePose(frame.world_from_camera)},
          {"true_pose",
           frame.true_world_from_camera ? PagePose(*frame.true_world_from_camera) : json()},
          {"grid", json::array()}};
}

json PageObject(const Sequence& sequence, const Object& object) {
  const auto& truth = object.ground_truth;
  return {{"id", object.id},
          {"label", object.label},
          {"segment", nullptr},
          {"plane", sequence.planes.empty()
                        ? json()
                        : json(sequence.planes[static_cast<size_t>(object.plane_index)].id)},
          {"truth", truth ? PageLandmark(AsCuboid(truth->landmark_in_world)) : json()},
          {"rotationally_symmetric", truth && truth->rotationally_symmetric}};
}

json PageDetection(const Sequence& sequence, const Detection& detection, bool is_shown) {
  const auto truth = is_shown ? TrueLandmarkInCamera(sequence, detection) : std::nullopt;
  const Box& box = detection.box;
  return {{"frame", detection.frame_index},
          {"object", detection.object_index},
          {"score", PageNumber(detection.score)},
          {"box", PagePixels({{box.x_min, box.y_min}, {box.x_max, box.y_max}})},
          {"truth", truth ? PageOutline(sequence.CameraOf(detection), AsCuboid(*truth)) : json()}};
}

json PagePlane(const SupportPlane& plane, const std::vector<LineSegment3>& grid) {
  json lines = json::array();
  for (const LineSegment3& line : grid) {
    json ends = PageVector(line[0]);
    for (const json& part : PageVector(line[1])) ends.push_back(part);
    lines.push_back(std::move(ends));
  }
  const Eigen::Vector3d& normal = plane.plane_in_world.normal;
  return {{"id", plane.id},
          {"normal", {normal.x(), normal.y(), normal.z()}},
          {"offset", PageNumber(plane.plane_in_world.offset)},
          {"estimated", plane.attitude_information.has_value()},
          {"grid", std::move(lines)}};
}

}  // namespace

json PageSequence(const Sequence& sequence, const std::vector<int>& shown) {
  const auto grids = GridsInWorld(sequence);
  const auto planes_of_frames = PlanesOfFrames(sequence);
  json page = {{"frames", json::array()},
               {"objects", json::array()},
               {"detections", json::array()},
               {"planes", json::array()},
               {"rejected", sequence.rejected_detections}};
  for (const Frame& frame : sequence.frames) page["frames"].push_back(PageFrame(sequence, frame));
  for (const int index : shown) {
    const auto frame = static_cast<size_t>(index);
    for (const size_t plane : planes_of_frames[frame]) {
      AddGrid(sequence, sequence.frames[frame], plane, grids[plane],
              &page["frames"][frame]["grid"]);
    }
  }
  for (const Object& object : sequence.objects) {
    page["objects"].push_back(PageObject(sequence, object));
  }
  for (const Detection& detection : sequence.detections) {
    const bool is_shown = std::ranges::binary_search(shown, detection.frame_index);
    page["detections"].push_back(PageDetection(sequence, detection, is_shown));
    page["objects"][static_cast<size_t>(detection.object_index)]["segment"] =
        sequence.FrameOf(detection).segment;
  }
  for (size_t i = 0; i < grids.size(); ++i) {
    page["planes"].push_back(PagePlane(sequence.planes[i], grids[i]));
  }
  return page;
}

}  // namespace soslam
