// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/inspection/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <set>

#include "soslam/inspection/projection.h"
#include "soslam/model/occlusion.h"

namespace soslam {
namespace {

const Stroke kDetectionStroke{palette::kYellow, 1};
const Stroke kLandmarkStroke{palette::kSkyBlue, 2};
const Stroke kLandmarkAxis{palette::kSkyBlue, 1};
const Stroke kTruthStroke{palette::kVermilion, 2};
const Stroke kTruthAxis{palette::kVermilion, 1};

// Id and label of an Object or WorldObject.
std::string MakeCaption(const auto& object) {
  return fmt::format("{} {}", object.id, object.label);
}

// Draws the x axis as an arrow to the front if there is one, else through the body.
void DrawAxes(const Landmark& landmark_in_camera, bool has_front, const Stroke& x_axis,
              const Stroke& others, Canvas* canvas) {
  const Eigen::Vector3d& centre = landmark_in_camera.Centre();
  const Eigen::Vector3d front = PointAt(landmark_in_camera, Eigen::Vector3d::UnitX());
  canvas->Segment(centre, PointAt(landmark_in_camera, Eigen::Vector3d::UnitY()), others);
  canvas->Segment(centre, PointAt(landmark_in_camera, Eigen::Vector3d::UnitZ()), others);
  if (has_front) {
    canvas->Arrow(centre, front, x_axis);
  } else {
    canvas->Segment(PointAt(landmark_in_camera, -Eigen::Vector3d::UnitX()), front, x_axis);
  }
}

// Contact points of detections by plane; `planes_in_camera`, if not empty, replace those of
// detections.
std::vector<OverlayInput::Ground> FindGrounds(const Sequence& sequence, int frame_index,
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

// Adds the landmark of an object if its outline box overlaps the image.
void AddBodyInImage(const ObjectEstimate& estimate, const std::string& caption,
                    const Rigid3d& camera_from_world, const Camera& camera,
                    std::vector<OverlayInput::Body>* bodies) {
  if (!estimate.landmark_in_world) return;
  const Landmark in_camera = Transform(camera_from_world, *estimate.landmark_in_world);
  const auto outline = OutlineBox(camera, in_camera);
  const Box image{-0.5, -0.5, camera.width - 0.5, camera.height - 0.5};
  if (!outline || BoxOverlap(*outline, image) == 0.0) return;
  bodies->push_back({in_camera, caption});
  if (!estimate.FrontIsKnown()) return;
  bodies->back().front_caption = fmt::format("front {:.0f} %", 100.0 * *estimate.front_probability);
}

// The landmarks of objects that are in the image. Those that are not detected there have captions.
std::vector<OverlayInput::Body> BodiesInImage(const Sequence& sequence,
                                              const std::vector<ObjectEstimate>& estimates,
                                              const Rigid3d& camera_from_world, int frame_index) {
  const Camera& camera = sequence.CameraOf(sequence.frames[frame_index]);
  std::set<int> detected;
  for (const Detection& detection : DetectionsIn(sequence, frame_index)) {
    detected.insert(detection.object_index);
  }
  std::vector<OverlayInput::Body> bodies;
  for (const ObjectEstimate& estimate : estimates) {
    const bool is_detected = detected.contains(estimate.object_index);
    AddBodyInImage(estimate,
                   is_detected ? "" : MakeCaption(sequence.objects[estimate.object_index]),
                   camera_from_world, camera, &bodies);
  }
  return bodies;
}

}  // namespace

OverlayInput OverlayOfFrame(const Sequence& sequence, int frame_index) {
  const Frame& frame = sequence.frames[frame_index];
  OverlayInput input;
  input.camera = sequence.CameraOf(frame);
  input.grounds = FindGrounds(sequence, frame_index, {});
  for (const Detection& detection : DetectionsIn(sequence, frame_index)) {
    input.detections.push_back({detection.box, MakeCaption(sequence.ObjectOf(detection))});
    if (const auto truth = TrueLandmarkInCamera(sequence, detection)) {
      input.truths_in_camera.push_back(
          {*truth, sequence.ObjectOf(detection).ground_truth->MayHaveFront()});
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
  input.grounds = FindGrounds(sequence, frame_index, planes_in_camera);
  return input;
}

OverlayInput OverlayOfWorld(const World& world, const WorldFrame& frame) {
  OverlayInput input{.camera = frame.camera};
  const Rigid3d camera_from_world = frame.world_from_camera.Inverse();
  for (const WorldObject& object : world.objects) {
    AddBodyInImage(object.estimate, MakeCaption(object), camera_from_world, frame.camera,
                   &input.landmarks);
  }
  return input;
}

void DrawOverlay(const OverlayInput& input, cv::Mat* image) {
  constexpr double kGridOpacity = 0.5;
  for (const auto& [plane, feet] : input.grounds) {
    cv::Mat drawn = image->clone();
    Canvas grid(input.camera, &drawn);
    for (const auto& [begin, end] : GridAround(plane, feet).lines) {
      grid.Segment(begin, end, {palette::kWhite, 1});
    }
    *image = (1.0 - kGridOpacity) * *image + kGridOpacity * drawn;
  }
  Canvas canvas(input.camera, image);
  for (const auto& [truth, may_have_front] : input.truths_in_camera) {
    for (const auto& [start, end] : UnitCuboidEdges()) {
      canvas.Segment(PointAt(truth, start), PointAt(truth, end), kTruthStroke);
    }
    DrawAxes(truth, may_have_front, kTruthStroke, kTruthAxis, &canvas);
  }
  for (const auto& [landmark, caption, front_caption] : input.landmarks) {
    const Polygon outline = OutlinePolygon(input.camera, landmark);
    if (outline.empty()) continue;
    canvas.Lines(outline, true, kLandmarkStroke);
    DrawAxes(landmark, /*has_front=*/!front_caption.empty(), kLandmarkStroke, kLandmarkAxis,
             &canvas);
  }
  for (const auto& [box, caption] : input.detections) {
    canvas.Lines(CornersOf(box), true, kDetectionStroke);
  }
  // Captions are on top of all lines.
  for (const auto& [landmark, caption, front_caption] : input.landmarks) {
    const auto outline = OutlineBox(input.camera, landmark);
    if (outline && !caption.empty()) {
      canvas.Text({outline->x_min, outline->y_min}, caption, kLandmarkStroke.colour);
    }
    if (outline && !front_caption.empty()) {
      canvas.Text(*input.camera.Project(PointAt(landmark, Eigen::Vector3d::UnitX())), front_caption,
                  kLandmarkStroke.colour);
    }
  }
  for (const auto& [box, caption] : input.detections) {
    canvas.Text({box.x_min, box.y_min}, caption, kDetectionStroke.colour);
  }
}

std::vector<CaptionEntry> OverlayLegend(const OverlayInput& input) {
  std::vector<CaptionEntry> legend;
  const auto add = [&](size_t count, const std::string& text, const cv::Scalar& colour) {
    if (count > 0) legend.push_back({fmt::format("{} {}", count, text), colour, true});
  };
  add(input.detections.size(), "detected", kDetectionStroke.colour);
  const bool any_front = std::ranges::any_of(
      input.landmarks, [](const auto& body) { return !body.front_caption.empty(); });
  add(input.landmarks.size(),
      any_front ? "estimated (thick axis: front or back, arrow: front)"
                : "estimated (thick axis: front or back)",
      kLandmarkStroke.colour);
  add(input.truths_in_camera.size(), "true (box around it, arrow: x axis, front if it has one)",
      kTruthStroke.colour);
  std::map<double, size_t> grounds_by_cell;
  for (const auto& [plane, feet] : input.grounds) ++grounds_by_cell[GridAround(plane, feet).cell];
  for (const auto& [cell, count] : grounds_by_cell) {
    add(count, fmt::format("x support plane, cells of {:.3g} m", cell), palette::kWhite);
  }
  return legend;
}

namespace {

// A camera of which only the size matters, for drawing in pixels.
Camera CameraOfSize(const cv::Mat& image) { return {.width = image.cols, .height = image.rows}; }

// Red for right, then by the angle clockwise, as the image's y axis points down.
cv::Vec3b EncodeDirection(const cv::Point2f& direction) {
  const float degrees = cv::fastAtan2(direction.y, direction.x);
  const auto hue = static_cast<uchar>(std::lround(0.5F * degrees) % 180);  // OpenCV's unit: 2 deg
  return {hue, 200, 255};
}

// Edge pixels are black; without edges all pixels are.
cv::Mat DirectionPicture(const cv::Mat& nearest_edge) {
  cv::Mat hues = cv::Mat::zeros(nearest_edge.size(), CV_8UC3);
  for (int y = 0; y < hues.rows; ++y) {
    for (int x = 0; x < hues.cols; ++x) {
      const auto& edge = nearest_edge.at<cv::Vec2s>(y, x);
      const cv::Point2f direction(static_cast<float>(edge[0] - x), static_cast<float>(edge[1] - y));
      if (edge[0] < 0 || direction == cv::Point2f()) continue;
      hues.at<cv::Vec3b>(y, x) = EncodeDirection(direction);
    }
  }
  // The colour wheel at the lower right is a legend of all directions.
  const int radius = std::min(hues.rows, hues.cols) / 10;
  const cv::Point centre(hues.cols - radius - 4, hues.rows - radius - 4);
  cv::circle(hues, centre, radius + 2, {0, 0, 255}, cv::FILLED);
  for (int y = -radius; y <= radius; ++y) {
    for (int x = -radius; x <= radius; ++x) {
      if (x * x + y * y > radius * radius) continue;
      hues.at<cv::Vec3b>(centre + cv::Point(x, y)) =
          EncodeDirection({static_cast<float>(x), static_cast<float>(y)});
    }
  }
  cv::Mat picture;
  cv::cvtColor(hues, picture, cv::COLOR_HSV2BGR);
  return picture;
}

cv::Mat LayerPicture(const EdgeMaps& maps, EdgeLayer layer, const std::string& title,
                     int min_width) {
  const int edges = cv::countNonZero(maps.edges);
  const auto captioned = [&](const cv::Mat& picture, const std::string& text) {
    return WithCaption(DrawingGround(picture, min_width), {{title}, {text}});
  };
  switch (layer) {
    case EdgeLayer::kGrey: {
      cv::Mat picture = DrawingGround(maps.grey, min_width);
      Canvas canvas(CameraOfSize(maps.grey), &picture);
      for (const Eigen::Vector2f& corner : maps.corners) {
        canvas.Disc(corner.cast<double>(), palette::kYellow);
      }
      return captioned(picture, fmt::format("{} corners", maps.corners.size()));
    }
    case EdgeLayer::kEdges:
      return captioned(maps.edges, fmt::format("{} edge pixels", edges));
    case EdgeLayer::kDistance: {
      // Infinite distances (an image without edges) are dark.
      cv::Mat scaled = cv::Mat::zeros(maps.distance.size(), CV_8UC1);
      double largest = 0.0;
      if (edges > 0) cv::minMaxLoc(maps.distance, nullptr, &largest);
      if (largest > 0.0) maps.distance.convertTo(scaled, CV_8U, 255.0 / largest);
      cv::Mat picture;
      cv::applyColorMap(scaled, picture, cv::COLORMAP_VIRIDIS);
      return captioned(
          picture,
          fmt::format("distance to the nearest edge, 0 (dark) to {:.1f} px (bright)", largest));
    }
    default:
      return captioned(DirectionPicture(maps.nearest_edge),
                       "direction to the nearest edge, by the colours of the wheel");
  }
}

// The part of an image around pairs of pixels, with a margin in proportion to its size.
cv::Rect AroundPairs(const SymmetryRecord& record, const cv::Size& size) {
  std::vector<cv::Point2f> points;
  for (const auto* pixels : {&record.samples, &record.mirrored}) {
    for (const Eigen::Vector2f& pixel : *pixels) points.emplace_back(pixel.x(), pixel.y());
  }
  const cv::Rect image({0, 0}, size);
  if (points.empty()) return image;
  const cv::Rect tight = cv::boundingRect(points);
  const int margin = std::max(tight.width, tight.height) / 3 + 4;
  const cv::Rect wide(tight.x - margin, tight.y - margin, tight.width + 2 * margin,
                      tight.height + 2 * margin);
  const cv::Rect part = wide & image;
  return part.empty() ? image : part;
}

}  // namespace

cv::Mat EdgesPicture(const EdgeMaps& maps, EdgeLayer layer, const std::string& title) {
  if (layer != EdgeLayer::kAll) return LayerPicture(maps, layer, title, kPictureWidth);
  const auto row = [&](EdgeLayer left, EdgeLayer right) {
    cv::Mat tiles;
    cv::hconcat(LayerPicture(maps, left, title, kTileWidth),
                LayerPicture(maps, right, title, kTileWidth), tiles);
    return tiles;
  };
  cv::Mat tiles;
  cv::vconcat(row(EdgeLayer::kGrey, EdgeLayer::kEdges),
              row(EdgeLayer::kDistance, EdgeLayer::kNearest), tiles);
  return tiles;
}

cv::Mat SymmetryPicture(const SymmetryRecord& record, const cv::Mat& image,
                        const std::string& title) {
  constexpr double kLineOpacity = 0.4;
  const cv::Rect part = AroundPairs(record, image.size());
  cv::Mat picture = DrawingGround(image(part));
  cv::Mat lines = picture.clone();
  Canvas line_canvas(CameraOfSize(image(part)), &lines);
  const auto place = [&](const Eigen::Vector2f& pixel) -> Eigen::Vector2d {
    return pixel.cast<double>() - Eigen::Vector2d(part.x, part.y);
  };
  for (size_t i = 0; i < record.samples.size(); ++i) {
    line_canvas.Lines({place(record.samples[i]), place(record.mirrored[i])}, false,
                      {palette::kWhite, 1});
  }
  picture = (1.0 - kLineOpacity) * picture + kLineOpacity * lines;
  Canvas canvas(CameraOfSize(image(part)), &picture);
  for (const auto& pixel : record.samples) canvas.Disc(place(pixel), palette::kYellow);
  for (const auto& pixel : record.mirrored) canvas.Disc(place(pixel), palette::kSkyBlue);
  return WithCaption(picture,
                     {{title},
                      {fmt::format("{} pixels", record.samples.size()), palette::kYellow, true},
                      {"their mirror pixels", palette::kSkyBlue, true}});
}

}  // namespace soslam
