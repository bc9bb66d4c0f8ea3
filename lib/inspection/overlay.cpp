// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/overlay.h"

#include <fmt/format.h>

#include <map>
#include <set>

#include "inspection/projection.h"
#include "model/occlusion.h"

namespace soslam {
namespace {

const Stroke kDetectionStroke{palette::kYellow, 1};
const Stroke kLandmarkStroke{palette::kSkyBlue, 2};
const Stroke kLandmarkAxis{palette::kSkyBlue, 1};
const Stroke kTruthStroke{palette::kVermilion, 2};
const Stroke kTruthAxis{palette::kVermilion, 1};

constexpr double kGridOpacity = 0.5;

std::string CaptionOf(const Object& object) {
  return fmt::format("{} {}", object.id, object.label);
}

void DrawAxes(const Landmark& landmark_in_camera, const Stroke& front, const Stroke& others,
              Canvas* canvas) {
  const Eigen::Vector3d& centre = landmark_in_camera.Centre();
  canvas->Segment(centre, PointAt(landmark_in_camera, Eigen::Vector3d::UnitY()), others);
  canvas->Segment(centre, PointAt(landmark_in_camera, Eigen::Vector3d::UnitZ()), others);
  canvas->Arrow(centre, PointAt(landmark_in_camera, Eigen::Vector3d::UnitX()), front);
}

void DrawCircumscribedBox(const Landmark& landmark_in_camera, const Stroke& stroke,
                          Canvas* canvas) {
  for (const auto& [start, end] : UnitCuboidEdges()) {
    canvas->Segment(PointAt(landmark_in_camera, start), PointAt(landmark_in_camera, end), stroke);
  }
}

void DrawBody(const OverlayInput::Body& body, const Camera& camera, Canvas* canvas) {
  const Polygon outline = OutlinePolygon(camera, body.landmark_in_camera);
  if (outline.empty()) return;
  canvas->Lines(outline, true, kLandmarkStroke);
  DrawAxes(body.landmark_in_camera, kLandmarkStroke, kLandmarkAxis, canvas);
}

// Drawn last, on top of all lines.
void DrawCaptions(const OverlayInput& input, Canvas* canvas) {
  for (const auto& [landmark, caption] : input.landmarks) {
    const auto outline = OutlineBox(input.camera, landmark);
    if (!outline || caption.empty()) continue;
    canvas->Text({outline->x_min, outline->y_min}, caption, kLandmarkStroke.colour);
  }
  for (const auto& [box, caption] : input.detections) {
    canvas->Text({box.x_min, box.y_min}, caption, kDetectionStroke.colour);
  }
}

void DrawGrid(const OverlayInput::Ground& ground, const Camera& camera, cv::Mat* image) {
  cv::Mat drawn = image->clone();
  Canvas canvas(camera, &drawn);
  for (const auto& [begin, end] : GridAround(ground.plane_in_camera, ground.feet_in_camera).lines) {
    canvas.Segment(begin, end, {palette::kWhite, 1});
  }
  *image = (1.0 - kGridOpacity) * *image + kGridOpacity * drawn;
}

// Contact points of detections by plane; `planes_in_camera`, if not empty, replace those of
// detections.
std::vector<OverlayInput::Ground> GroundsOf(const Sequence& sequence, int frame_index,
                                            const std::vector<Plane>& planes_in_camera) {
  std::map<int, OverlayInput::Ground> by_plane;
  if (!sequence.HasSupports()) return {};
  for (const Detection& detection : DetectionsIn(sequence, frame_index)) {
    const int plane_index = sequence.ObjectOf(detection).plane_index;
    const Plane& plane =
        planes_in_camera.empty() ? detection.plane_in_camera : planes_in_camera[plane_index];
    const auto foot = GroundContactInCamera(sequence.CameraOf(detection), detection.box, plane);
    if (!foot) continue;
    OverlayInput::Ground& ground = by_plane[plane_index];
    ground.plane_in_camera = plane;
    ground.feet_in_camera.push_back(*foot);
  }
  std::vector<OverlayInput::Ground> grounds;
  for (const auto& [plane_index, ground] : by_plane) grounds.push_back(ground);
  return grounds;
}

// The landmarks of objects whose outline box overlaps the image. Those that are not detected there
// have captions.
std::vector<OverlayInput::Body> BodiesInImage(const Sequence& sequence,
                                              const std::vector<ObjectEstimate>& estimates,
                                              const Rigid3d& camera_from_world, int frame_index) {
  const Camera& camera = sequence.CameraOf(sequence.frames[frame_index]);
  std::set<int> detected;
  for (const Detection& detection : DetectionsIn(sequence, frame_index)) {
    detected.insert(detection.object_index);
  }
  const Box image{-0.5, -0.5, camera.width - 0.5, camera.height - 0.5};
  std::vector<OverlayInput::Body> bodies;
  for (const ObjectEstimate& estimate : estimates) {
    if (!estimate.landmark_in_world) continue;
    const Landmark in_camera = Transform(camera_from_world, *estimate.landmark_in_world);
    const auto outline = OutlineBox(camera, in_camera);
    if (!outline || BoxOverlap(*outline, image) == 0.0) continue;
    const Object& object = sequence.objects[estimate.object_index];
    bodies.push_back(
        {in_camera, detected.contains(estimate.object_index) ? "" : CaptionOf(object)});
  }
  return bodies;
}

}  // namespace

OverlayInput OverlayOfFrame(const Sequence& sequence, int frame_index) {
  const Frame& frame = sequence.frames[frame_index];
  OverlayInput input;
  input.camera = sequence.CameraOf(frame);
  input.grounds = GroundsOf(sequence, frame_index, {});
  for (const Detection& detection : DetectionsIn(sequence, frame_index)) {
    input.detections.push_back({detection.box, CaptionOf(sequence.ObjectOf(detection))});
    if (const auto truth = TrueLandmarkInCamera(sequence, detection)) {
      input.truths_in_camera.push_back(*truth);
    }
  }
  return input;
}

OverlayInput OverlayOfLandmarks(const Sequence& sequence, const LandmarkEstimates& estimates,
                                int frame_index) {
  OverlayInput input = OverlayOfFrame(sequence, frame_index);
  for (const ObservationEstimate& estimate : estimates.observations) {
    const auto& detection = sequence.detections[estimate.detection_index];
    if (detection.frame_index != frame_index || estimate.hypotheses.empty()) continue;
    input.landmarks.push_back({estimate.hypotheses.front().landmark_in_camera, ""});
  }
  if (estimates.observations.empty()) {
    const Frame& frame = sequence.frames[frame_index];
    input.landmarks =
        BodiesInImage(sequence, estimates.objects, frame.world_from_camera.Inverse(), frame_index);
  }
  return input;
}

OverlayInput OverlayOfMap(const Sequence& sequence, const MapEstimate& map, int frame_index) {
  OverlayInput input = OverlayOfFrame(sequence, frame_index);
  const Rigid3d camera_from_world = map.world_from_camera[frame_index].Inverse();
  input.landmarks = BodiesInImage(sequence, map.objects, camera_from_world, frame_index);
  std::vector<Plane> planes_in_camera;
  for (const Plane& plane : map.planes_in_world) {
    planes_in_camera.push_back(Transform(camera_from_world, plane));
  }
  input.grounds = GroundsOf(sequence, frame_index, planes_in_camera);
  return input;
}

void DrawOverlay(const OverlayInput& input, cv::Mat* image) {
  for (const auto& ground : input.grounds) DrawGrid(ground, input.camera, image);
  Canvas canvas(input.camera, image);
  for (const Landmark& truth : input.truths_in_camera) {
    DrawCircumscribedBox(truth, kTruthStroke, &canvas);
    DrawAxes(truth, kTruthStroke, kTruthAxis, &canvas);
  }
  for (const auto& body : input.landmarks) DrawBody(body, input.camera, &canvas);
  for (const auto& [box, caption] : input.detections) {
    canvas.Lines(CornersOf(box), true, kDetectionStroke);
  }
  DrawCaptions(input, &canvas);
}

std::vector<CaptionEntry> OverlayLegend(const OverlayInput& input) {
  std::vector<CaptionEntry> legend;
  const auto add = [&](size_t count, const std::string& text, const cv::Scalar& colour) {
    if (count > 0) legend.push_back({fmt::format("{} {}", count, text), colour, true});
  };
  add(input.detections.size(), "detected", kDetectionStroke.colour);
  add(input.landmarks.size(), "estimated (arrow: front)", kLandmarkStroke.colour);
  add(input.truths_in_camera.size(), "true (box around it)", kTruthStroke.colour);
  std::map<double, size_t> grounds_by_cell;
  for (const auto& [plane, feet] : input.grounds) ++grounds_by_cell[GridAround(plane, feet).cell];
  for (const auto& [cell, count] : grounds_by_cell) {
    add(count, fmt::format("x support plane, cells of {:.3g} m", cell), palette::kWhite);
  }
  return legend;
}

}  // namespace soslam
