// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <map>
#include <numeric>
#include <optional>

#include "soslam/model/label_groups.h"
#include "soslam/model/reasons.h"
#include "soslam/model/segments.h"
#include "soslam/report/page_parts.h"

namespace soslam {
namespace {

int PlaceIn(const std::vector<int>& ascending, int value) {
  return static_cast<int>(std::ranges::lower_bound(ascending, value) - ascending.begin());
}

std::vector<int> AllFrames(const Sequence& sequence) {
  std::vector<int> frames(sequence.frames.size());
  std::iota(frames.begin(), frames.end(), 0);
  return frames;
}

}  // namespace

bool PageSelection::Shows(int frame_index) const {
  return std::ranges::binary_search(shown, frame_index);
}

int PageSelection::PlaceOfFrame(int frame_index) const { return PlaceIn(frames, frame_index); }

int PageSelection::PlaceOfDetection(int detection_index) const {
  return PlaceIn(detections, detection_index);
}

std::set<int> FramesToShow(const Sequence& sequence,
                           const std::function<bool(int frame_index)>& has_image) {
  std::vector<int> frames = AllFrames(sequence);
  if (std::ranges::any_of(frames, has_image)) std::erase_if(frames, std::not_fn(has_image));
  if (frames.size() > kMaxShownFrames) {
    std::set<int> with_detections;
    for (const Detection& detection : sequence.detections) {
      with_detections.insert(detection.frame_index);
    }
    std::erase_if(frames, [&](int frame) { return !with_detections.contains(frame); });
  }
  std::set<int> ids;
  for (const int frame : SpreadOver(frames, kMaxShownFrames)) {
    ids.insert(sequence.frames[frame].id);
  }
  return ids;
}

PageSelection SelectForPage(const Sequence& sequence, const std::set<int>& shown_ids) {
  PageSelection selection;
  const std::vector<int> all = AllFrames(sequence);
  std::ranges::copy_if(all, std::back_inserter(selection.shown),
                       [&](int frame) { return shown_ids.contains(sequence.frames[frame].id); });
  std::ranges::set_union(SpreadOver(all, kMaxWayFrames), selection.shown,
                         std::back_inserter(selection.frames));
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    if (selection.Shows(sequence.detections[i].frame_index)) {
      selection.detections.push_back(static_cast<int>(i));
    }
  }
  return selection;
}

namespace {

using nlohmann::json;

// Estimates are compared with the cuboid around the object.
Landmark AsCuboid(Landmark landmark) {
  landmark.shape_exponents = kCuboidExponent;
  return landmark;
}

json PageObject(const Object& object, const json& segment) {
  const auto& truth = object.ground_truth;
  return {{"id", object.id},
          {"label", object.label},
          {"labels", LabelInWords(object)},
          {"segment", segment},
          {"plane", object.plane_index == kNoPlane ? json() : json(object.plane_index)},
          {"truth", truth ? PageLandmark(AsCuboid(truth->landmark_in_world)) : json()}};
}

json PageDetection(const Sequence& sequence, const Detection& detection,
                   const PageSelection& selection) {
  const auto truth = TrueLandmarkInCamera(sequence, detection);
  const Box& box = detection.box;
  return {{"frame", selection.PlaceOfFrame(detection.frame_index)},
          {"object", detection.object_index},
          {"box", PagePixels({{box.x_min, box.y_min}, {box.x_max, box.y_max}})},
          {"truth", truth ? PageOutline(sequence.CameraOf(detection), AsCuboid(*truth)) : json()}};
}

}  // namespace

nlohmann::json PageSequence(const Sequence& sequence, const PageSelection& selection) {
  const PlaneGrids grids = GridsOfSequence(sequence);
  json page = {{"counts",
                {{"frames", sequence.frames.size()},
                 {"objects", sequence.objects.size()},
                 {"detections", sequence.detections.size()}}},
               {"planes", PageGrids(grids)},
               {"rejected", ReasonsInWords(sequence.rejected_detections)}};
  for (const char* list : {"frames", "objects", "detections", "segments"}) {
    page[list] = json::array();
  }
  // Pages know segments by their places in the order of their frames.
  std::map<int, size_t> place_of_segment;
  for (const int segment : ListSegments(sequence)) {
    place_of_segment.emplace(segment, page["segments"].size());
    page["segments"].push_back({{"up", PageVector(UpOfSegment(sequence, segment))}});
  }
  for (const int index : selection.frames) {
    const Frame& frame = sequence.frames[index];
    const Camera& camera = sequence.CameraOf(frame);
    const auto& true_pose = frame.true_world_from_camera;
    page["frames"].push_back({{"id", frame.id},
                              {"timestamp", frame.timestamp},
                              {"segment", place_of_segment.at(frame.segment)},
                              {"width", camera.width},
                              {"height", camera.height},
                              {"pose", PagePose(frame.world_from_camera)},
                              {"true_pose", true_pose ? PagePose(*true_pose) : json()},
                              {"shown", selection.Shows(index)}});
    if (!selection.Shows(index)) continue;
    page["frames"].back()["grid"] = PageGridInFrame(
        sequence, index, grids,
        [&](const Detection& detection) { return CameraAbovePlane(sequence, detection); });
  }
  const std::vector<std::optional<int>> segments = SegmentsOfObjects(sequence);
  for (size_t i = 0; i < segments.size(); ++i) {
    page["objects"].push_back(PageObject(
        sequence.objects[i], segments[i] ? json(place_of_segment.at(*segments[i])) : json()));
  }
  for (const int index : selection.detections) {
    page["detections"].push_back(PageDetection(sequence, sequence.detections[index], selection));
  }
  return page;
}

}  // namespace soslam
