// SPDX-License-Identifier: BSD-3-Clause
#include "report/page_sequence.h"

#include <optional>
#include <vector>

#include "report/page_json.h"
#include "report/page_planes.h"

namespace soslam {
namespace {

using nlohmann::json;

// The cuboid around the object, as for the comparison of landmarks.
Landmark AsCuboid(Landmark landmark) {
  landmark.shape_exponent = kCuboidExponent;
  return landmark;
}

// The segment of each object, in their order: the one in which it was detected; for an object
// without detections the only segment, if there is just one.
std::vector<std::optional<int>> SegmentsOfObjects(const Sequence& sequence) {
  std::vector<std::optional<int>> segments(sequence.objects.size());
  for (const Detection& detection : sequence.detections) {
    segments[static_cast<size_t>(detection.object_index)] = sequence.FrameOf(detection).segment;
  }
  if (sequence.frames.empty()) return segments;
  const int only_segment = sequence.frames.front().segment;
  if (sequence.frames.back().segment != only_segment) return segments;
  for (std::optional<int>& segment : segments) segment = only_segment;
  return segments;
}

json PageFrame(const Sequence& sequence, const Frame& frame, bool is_shown) {
  const Camera& camera = sequence.CameraOf(frame);
  return {{"id", frame.id},
          {"timestamp", frame.timestamp},
          {"segment", frame.segment},
          {"width", camera.width},
          {"height", camera.height},
          {"pose", PagePose(frame.world_from_camera)},
          {"true_pose",
           frame.true_world_from_camera ? PagePose(*frame.true_world_from_camera) : json()},
          {"shown", is_shown}};
}

json PageFrames(const Sequence& sequence, const PageSelection& selection, const PlaneGrids& grids) {
  json frames = json::array();
  for (const int index : selection.frames) {
    const bool is_shown = selection.Shows(index);
    json page = PageFrame(sequence, sequence.frames[static_cast<size_t>(index)], is_shown);
    if (is_shown) {
      page["grid"] = PageGridInFrame(sequence, index, grids, [&](const Detection& detection) {
        return CameraAbovePlane(sequence, detection);
      });
    }
    frames.push_back(std::move(page));
  }
  return frames;
}

json PageObjects(const Sequence& sequence) {
  const std::vector<std::optional<int>> segments = SegmentsOfObjects(sequence);
  json objects = json::array();
  for (size_t i = 0; i < segments.size(); ++i) {
    const Object& object = sequence.objects[i];
    const auto& truth = object.ground_truth;
    objects.push_back(
        {{"id", object.id},
         {"label", object.label},
         {"segment", segments[i] ? json(*segments[i]) : json()},
         {"plane", sequence.planes.empty() ? json() : json(object.plane_index)},
         {"truth", truth ? PageLandmark(AsCuboid(truth->landmark_in_world)) : json()}});
  }
  return objects;
}

json PageDetections(const Sequence& sequence, const PageSelection& selection) {
  json detections = json::array();
  for (const int index : selection.detections) {
    const Detection& detection = sequence.detections[static_cast<size_t>(index)];
    const auto truth = TrueLandmarkInCamera(sequence, detection);
    const Box& box = detection.box;
    detections.push_back(
        {{"frame", selection.PlaceOfFrame(detection.frame_index)},
         {"object", detection.object_index},
         {"box", PagePixels({{box.x_min, box.y_min}, {box.x_max, box.y_max}})},
         {"truth", truth ? PageOutline(sequence.CameraOf(detection), AsCuboid(*truth)) : json()}});
  }
  return detections;
}

json PageSegments(const Sequence& sequence) {
  json segments = json::array();
  const int count = sequence.frames.empty() ? 0 : sequence.frames.back().segment + 1;
  for (int segment = 0; segment < count; ++segment) {
    segments.push_back({{"up", PageVector(UpOfSegment(sequence, segment))}});
  }
  return segments;
}

}  // namespace

json PageSequence(const Sequence& sequence, const PageSelection& selection) {
  const PlaneGrids grids = GridsOfSequence(sequence);
  return {{"counts",
           {{"frames", sequence.frames.size()},
            {"objects", sequence.objects.size()},
            {"detections", sequence.detections.size()}}},
          {"frames", PageFrames(sequence, selection, grids)},
          {"objects", PageObjects(sequence)},
          {"detections", PageDetections(sequence, selection)},
          {"planes", PageGrids(grids)},
          {"segments", PageSegments(sequence)},
          {"rejected", sequence.rejected_detections}};
}

}  // namespace soslam
