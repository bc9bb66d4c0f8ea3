// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/image/undistorted_points.h"
#include "soslam/model/map_points.h"
#include "soslam/model/reasons.h"
#include "soslam/model/segments.h"
#include "soslam/report/page_html.h"
#include "soslam/report/page_parts.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

json PageObjectEstimate(const ObjectEstimate& estimate) {
  json object = {{"landmark", nullptr},
                 {"failure", ReasonOf(estimate.failure).words},
                 {"observations", estimate.observations}};
  if (!estimate.landmark_in_world) return object;
  object["landmark"] = PageLandmark(*estimate.landmark_in_world);
  object["points"] = nullptr;
  if (!estimate.points.empty()) {
    double of_object = 0.0;
    for (const PointPosterior& point : estimate.points) of_object += point.responsibility;
    object["points"] = {{"count", estimate.points.size()}, {"of_object", PageNumber(of_object)}};
  }
  if (estimate.front_probability) {
    object["front"] = {{"probability", PageNumber(*estimate.front_probability)},
                       {"is_known", estimate.FrontIsKnown()}};
  }
  if (estimate.quarter_turn) object["quarter_turn"] = PageNumber(*estimate.quarter_turn);
  if (!estimate.covariance) return object;
  const auto numbers = [](const Eigen::Vector3d& v) { return PageNumbers({v[0], v[1], v[2]}); };
  const Eigen::Matrix3d of_centre = estimate.covariance->block<3, 3>(3, 3);
  for (int i = 0; i < 3; ++i) object["centre_covariance"].push_back(numbers(of_centre.row(i)));
  object["sigma_centre"] = numbers(of_centre.diagonal().cwiseSqrt());
  object["sigma_log_half_axes"] = numbers(estimate.covariance->diagonal().tail<3>().cwiseSqrt());
  object["sigma_yaw_deg"] = PageNumber(*YawSigmaDeg(estimate));
  return object;
}

// Adds estimates, in the order of the sequence's objects.
void AddObjects(const std::vector<ObjectEstimate>& estimates, const Sequence& sequence,
                PageVariant* variant) {
  variant->objects.resize(sequence.objects.size());
  for (const ObjectEstimate& estimate : estimates) {
    variant->objects[estimate.object_index] = estimate;
  }
  variant->data["objects"] = json::array();
  for (const ObjectEstimate& estimate : variant->objects) {
    variant->data["objects"].push_back(PageObjectEstimate(estimate));
  }
}

// Adds outlines of the landmarks in the world, as each camera sees them.
void AddOutlines(const std::vector<Rigid3d>& world_from_camera, const Sequence& sequence,
                 const PageSelection& selection, PageVariant* variant) {
  json& outlines = variant->data["outlines"] = json::array();
  for (const int index : selection.detections) {
    const Detection& detection = sequence.detections[index];
    const ObjectEstimate& estimate = variant->objects[detection.object_index];
    const auto& landmark = estimate.landmark_in_world;
    const Rigid3d& pose = world_from_camera[detection.frame_index];
    outlines.push_back(
        landmark ? PageOutline(sequence.CameraOf(detection), Transform(pose.Inverse(), *landmark))
                 : json());
    if (landmark && estimate.FrontIsKnown()) {
      outlines.back()["front"] = PageNumber(*estimate.front_probability);
    }
  }
}

void AddMap(const MapEstimate& map, const Sequence& sequence, const PageSelection& selection,
            PageVariant* variant) {
  AddObjects(map.objects, sequence, variant);
  AddOutlines(map.world_from_camera, sequence, selection, variant);
  variant->solver = map.solver;
  json& data = variant->data;
  for (const int frame : selection.frames) {
    data["trajectory"].push_back(PagePose(map.world_from_camera[frame]));
  }
  data["solver"] = {{"converged", map.solver.converged},
                    {"iterations", map.solver.iterations},
                    {"cost_per_iteration", PageNumbers(map.solver.cost_per_iteration)},
                    {"residuals", map.solver.residuals},
                    {"gated", map.solver.gated}};
  // Given planes are the same in the map.
  const bool are_given = std::ranges::none_of(sequence.planes, [](const SupportPlane& plane) {
    return plane.attitude_information.has_value();
  });
  if (are_given) return;
  const PlaneGrids grids = GridsOfMap(map, sequence);
  data["planes"] = PageGrids(grids);
  for (const int frame : selection.frames) {
    const Rigid3d camera_from_world = map.world_from_camera[frame].Inverse();
    data["grids"].push_back(selection.Shows(frame) ? PageGridInFrame(sequence, frame, grids,
                                                                     [&](const Detection&) {
                                                                       return camera_from_world;
                                                                     })
                                                   : json());
  }
}

// Adds static true objects and true poses, moved to the world of the map, unless that is the true
// one.
void AddAlignedTruth(const Sequence& sequence, const PageSelection& selection,
                     PageVariant* variant) {
  const auto& quality = variant->metrics.map_quality;
  if (!quality) return;
  json objects = json::array(), trajectory = json::array();
  int place_of_segment = 0;
  for (const int segment : ListSegments(sequence)) {
    const int place = place_of_segment++;
    const auto aligned = quality->alignments.of_segment.find(segment);
    if (aligned == quality->alignments.of_segment.end()) continue;
    if (aligned->second.kind == AlignmentKind::kNone) return;
    const Alignment map_from_truth = aligned->second.Inverse();
    for (const TrueObject& object : sequence.true_objects) {
      if (object.segment != segment || !object.is_static) continue;
      Landmark truth = map_from_truth.Apply(object.truth.landmark_in_world);
      truth.shape_exponents = kCuboidExponent;
      objects.push_back({{"segment", place}, {"landmark", PageLandmark(truth)}});
    }
    for (const int index : selection.frames) {
      const Frame& frame = sequence.frames[index];
      if (frame.segment != segment || !frame.true_world_from_camera) continue;
      const Rigid3d pose = map_from_truth.Apply(*frame.true_world_from_camera);
      trajectory.push_back({{"segment", place}, {"pose", PagePose(pose)}});
    }
  }
  variant->data["truth"] = {{"objects", objects}, {"trajectory", trajectory}};
}

// Adds outlines of all estimates and, for each object, its first observation that has a landmark.
void AddFrames(const LandmarkEstimates& estimates, const Sequence& sequence,
               const PageSelection& selection, PageVariant* variant) {
  std::vector<ObjectEstimate> first(sequence.objects.size());
  for (size_t i = 0; i < first.size(); ++i) first[i].object_index = static_cast<int>(i);
  std::vector<json> outlines(selection.detections.size());
  for (const ObservationEstimate& estimate : estimates.observations) {
    const Detection& detection = sequence.detections[estimate.detection_index];
    ObjectEstimate& object = first[detection.object_index];
    ++object.observations;
    if (!object.landmark_in_world) object.failure = estimate.failure;
    if (estimate.hypotheses.empty()) continue;
    const Landmark& landmark = estimate.hypotheses.front().landmark_in_camera;
    if (!object.landmark_in_world) {
      object.landmark_in_world = Transform(sequence.FrameOf(detection).world_from_camera, landmark);
      object.failure.clear();
    }
    if (!selection.Shows(detection.frame_index)) continue;
    outlines[selection.PlaceOfDetection(estimate.detection_index)] =
        PageOutline(sequence.CameraOf(detection), landmark);
  }
  AddObjects(first, sequence, variant);
  variant->data["outlines"] = outlines;
}

// Image points of the points that may be of the objects of a map, in the frames that see them: by
// selected detection [x, y, responsibility in %, ...], or null where there are none. `points` are
// those that the map was made from. Throws InputError where the map refers to a point that is not
// among them.
json PagePoints(const MapEstimate& map, const std::vector<MapPoint>& points,
                const Sequence& sequence, const PageSelection& selection) {
  std::map<std::pair<int, int>, size_t> places;  // in the selection, by frame and object
  for (size_t i = 0; i < selection.detections.size(); ++i) {
    const Detection& detection = sequence.detections[selection.detections[i]];
    places.try_emplace({detection.frame_index, detection.object_index}, i);
  }
  std::vector<json> page(selection.detections.size());
  for (const ObjectEstimate& estimate : map.objects) {
    for (const PointPosterior& posterior : estimate.points) {
      if (static_cast<size_t>(posterior.point) >= points.size()) {
        throw InputError(
            fmt::format("points.h5: has {} points; expected point {} of map.json among them: is "
                        "the map of other points?",
                        points.size(), posterior.point));
      }
      for (const PointObservation& observation : points[posterior.point].observations) {
        const auto frame = FindFrameIndex(sequence, observation);
        if (!frame) continue;
        const auto place = places.find({static_cast<int>(*frame), estimate.object_index});
        const auto pixel = UndistortedPixel(sequence, observation);
        if (place == places.end() || !pixel) continue;
        json& of_detection = page[place->second];
        for (const json& coordinate : PagePixels({*pixel})) of_detection.push_back(coordinate);
        of_detection.push_back(std::lround(100.0 * posterior.responsibility));
      }
    }
  }
  return page;
}

}  // namespace

PageVariant ReadPageVariant(const VariantResult& result, const Sequence& sequence,
                            const PageSelection& selection) {
  PageVariant variant = {Utf8(result.name), *result.metrics};
  for (const char* key : {"trajectory", "solver", "planes", "grids", "points", "truth"}) {
    variant.data[key] = nullptr;
  }
  const fs::path& folder = result.folder;
  if (ShowsStage(result, "optimise", "map.json")) {
    CheckWasMadeOf(folder / "map.json", "map", folder / "sequence.json");
    const MapEstimate map = ReadMap(folder / "map.json", sequence);
    AddMap(map, sequence, selection, &variant);
    AddAlignedTruth(sequence, selection, &variant);
    const bool has_points = std::ranges::any_of(
        map.objects, [](const ObjectEstimate& object) { return !object.points.empty(); });
    if (has_points && ShowsStage(result, "track", "points.h5")) {
      variant.data["points"] =
          PagePoints(map, ReadPoints(folder / "points.h5"), sequence, selection);
    }
    return variant;
  }
  const char* file = ShowsStage(result, "refine", "refined.json") ? "refined.json" : "initial.json";
  CheckWasMadeOf(folder / file, "landmarks", folder / "sequence.json");
  const LandmarkEstimates estimates = ReadLandmarks(folder / file, sequence);
  if (estimates.observations.empty()) {
    variant.kind = VariantKind::kViews;
    AddObjects(estimates.objects, sequence, &variant);
    AddOutlines(PosesOf(sequence), sequence, selection, &variant);
  } else {
    variant.kind = VariantKind::kFrames;
    AddFrames(estimates, sequence, selection, &variant);
  }
  return variant;
}

}  // namespace soslam
