// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "artefact/files.h"
#include "base/error.h"
#include "geometry/angles.h"
#include "model/map_points.h"
#include "model/reasons.h"
#include "report/page_parts.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Adds the covariance, in the order of Covariance9.
void AddCovariance(const Covariance9& covariance, const Landmark& landmark, json* object) {
  const Eigen::Vector3d up = landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d of_centre = covariance.block<3, 3>(3, 3);
  const auto numbers = [](const Eigen::Vector3d& v) { return PageNumbers({v[0], v[1], v[2]}); };
  for (int i = 0; i < 3; ++i) (*object)["centre_covariance"].push_back(numbers(of_centre.row(i)));
  (*object)["sigma_centre"] = numbers(of_centre.diagonal().cwiseSqrt());
  (*object)["sigma_log_half_axes"] = numbers(covariance.diagonal().tail<3>().cwiseSqrt());
  (*object)["sigma_yaw_deg"] =
      PageNumber(kDegPerRad * std::sqrt(up.dot(covariance.topLeftCorner<3, 3>() * up)));
}

// Numbers of an object's points: {"count", "of_object": the sum of their responsibilities}, or null
// without any.
json PagePointCounts(const ObjectEstimate& estimate) {
  if (estimate.points.empty()) return nullptr;
  double of_object = 0.0;
  for (const PointPosterior& point : estimate.points) of_object += point.responsibility;
  return {{"count", estimate.points.size()}, {"of_object", PageNumber(of_object)}};
}

json PageObjectEstimate(const ObjectEstimate& estimate) {
  json object = {{"landmark", nullptr},
                 {"failure", ReasonOf(estimate.failure).words},
                 {"observations", estimate.observations}};
  if (!estimate.landmark_in_world) return object;
  object["landmark"] = PageLandmark(*estimate.landmark_in_world);
  object["points"] = PagePointCounts(estimate);
  if (estimate.quarter_turn) object["quarter_turn"] = PageNumber(*estimate.quarter_turn);
  if (estimate.covariance) {
    AddCovariance(*estimate.covariance, *estimate.landmark_in_world, &object);
  }
  return object;
}

// Estimates in the order of the sequence's objects.
json PageObjects(const std::vector<ObjectEstimate>& estimates, const Sequence& sequence) {
  std::vector<json> objects(sequence.objects.size(), PageObjectEstimate({}));
  for (const ObjectEstimate& estimate : estimates) {
    objects[estimate.object_index] = PageObjectEstimate(estimate);
  }
  return objects;
}

// Outlines of the landmarks in the world, as each camera sees them.
json OutlinesOfObjects(const std::vector<ObjectEstimate>& estimates, const Sequence& sequence,
                       const std::vector<Rigid3d>& world_from_camera,
                       const PageSelection& selection) {
  std::vector<std::optional<Landmark>> landmarks(sequence.objects.size());
  for (const ObjectEstimate& estimate : estimates) {
    landmarks[estimate.object_index] = estimate.landmark_in_world;
  }
  json outlines = json::array();
  for (const int index : selection.detections) {
    const Detection& detection = sequence.detections[index];
    const auto& landmark = landmarks[detection.object_index];
    const Rigid3d& pose = world_from_camera[detection.frame_index];
    outlines.push_back(
        landmark ? PageOutline(sequence.CameraOf(detection), Transform(pose.Inverse(), *landmark))
                 : json());
  }
  return outlines;
}

// Given planes are the same in the map and are not added.
void AddPlanes(const MapEstimate& map, const Sequence& sequence, const PageSelection& selection,
               json* variant) {
  const bool are_given = std::ranges::none_of(sequence.planes, [](const SupportPlane& plane) {
    return plane.attitude_information.has_value();
  });
  if (are_given) return;
  const PlaneGrids grids = GridsOfMap(map, sequence);
  (*variant)["planes"] = PageGrids(grids);
  for (const int frame : selection.frames) {
    Rigid3d camera_from_world = map.world_from_camera[frame].Inverse();
    (*variant)["grids"].push_back(
        selection.Shows(frame)
            ? PageGridInFrame(sequence, frame, grids,
                              [&](const Detection&) { return camera_from_world; })
            : json());
  }
}

void AddMap(const MapEstimate& map, const Sequence& sequence, const PageSelection& selection,
            json* variant) {
  (*variant)["kind"] = "map";
  (*variant)["objects"] = PageObjects(map.objects, sequence);
  (*variant)["outlines"] =
      OutlinesOfObjects(map.objects, sequence, map.world_from_camera, selection);
  for (const int frame : selection.frames) {
    (*variant)["trajectory"].push_back(PagePose(map.world_from_camera[frame]));
  }
  (*variant)["solver"] = {{"converged", map.solver.converged},
                          {"iterations", map.solver.iterations},
                          {"cost_per_iteration", PageNumbers(map.solver.cost_per_iteration)},
                          {"residuals", map.solver.residuals},
                          {"gated", map.solver.gated}};
  AddPlanes(map, sequence, selection, variant);
}

void AddViews(const LandmarkEstimates& estimates, const Sequence& sequence,
              const PageSelection& selection, json* variant) {
  (*variant)["kind"] = "views";
  (*variant)["objects"] = PageObjects(estimates.objects, sequence);
  (*variant)["outlines"] =
      OutlinesOfObjects(estimates.objects, sequence, PosesOf(sequence), selection);
}

// The first observation of each object that has a landmark.
std::vector<ObjectEstimate> FirstEstimates(const LandmarkEstimates& estimates,
                                           const Sequence& sequence) {
  std::vector<ObjectEstimate> first(sequence.objects.size());
  for (size_t i = 0; i < first.size(); ++i) first[i].object_index = static_cast<int>(i);
  for (const ObservationEstimate& estimate : estimates.observations) {
    const Detection& detection = sequence.detections[estimate.detection_index];
    ObjectEstimate& object = first[detection.object_index];
    ++object.observations;
    if (object.landmark_in_world) continue;
    object.failure = estimate.failure;
    if (estimate.hypotheses.empty()) continue;
    object.landmark_in_world = Transform(sequence.FrameOf(detection).world_from_camera,
                                         estimate.hypotheses.front().landmark_in_camera);
    object.failure.clear();
  }
  return first;
}

void AddFrames(const LandmarkEstimates& estimates, const Sequence& sequence,
               const PageSelection& selection, json* variant) {
  std::vector<json> outlines(selection.detections.size());
  for (const ObservationEstimate& estimate : estimates.observations) {
    const Detection& detection = sequence.detections[estimate.detection_index];
    if (estimate.hypotheses.empty() || !selection.Shows(detection.frame_index)) continue;
    outlines[selection.PlaceOfDetection(estimate.detection_index)] =
        PageOutline(sequence.CameraOf(detection), estimate.hypotheses.front().landmark_in_camera);
  }
  (*variant)["kind"] = "frames";
  (*variant)["objects"] = PageObjects(FirstEstimates(estimates, sequence), sequence);
  (*variant)["outlines"] = outlines;
}

const MapPoint& PointAt(int index, const std::vector<MapPoint>& points) {
  if (static_cast<size_t>(index) < points.size()) return points[static_cast<size_t>(index)];
  throw InputError(fmt::format(
      "points.h5: has {} points; expected point {} of map.json among them: is the map of other "
      "points?",
      points.size(), index));
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
      for (const PointObservation& observation : PointAt(posterior.point, points).observations) {
        const auto frame = FrameIndexOf(sequence, observation);
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

void AddEstimates(const VariantResult& result, const Sequence& sequence,
                  const PageSelection& selection, json* variant) {
  const fs::path& folder = result.folder;
  if (ShowsStage(result, "optimise", "map.json")) {
    CheckWasMadeOf(folder / "map.json", "map", folder / "sequence.json");
    const MapEstimate map = ReadMap(folder / "map.json", sequence);
    AddMap(map, sequence, selection, variant);
    const bool has_points = std::ranges::any_of(
        map.objects, [](const ObjectEstimate& object) { return !object.points.empty(); });
    if (has_points && ShowsStage(result, "track", "points.h5")) {
      (*variant)["points"] = PagePoints(map, ReadPoints(folder / "points.h5"), sequence, selection);
    }
    return;
  }
  const char* file = ShowsStage(result, "refine", "refined.json") ? "refined.json" : "initial.json";
  CheckWasMadeOf(folder / file, "landmarks", folder / "sequence.json");
  const LandmarkEstimates estimates = ReadLandmarks(folder / file, sequence);
  if (estimates.observations.empty()) {
    AddViews(estimates, sequence, selection, variant);
  } else {
    AddFrames(estimates, sequence, selection, variant);
  }
}

}  // namespace

json PageVariant(const VariantResult& result, const Sequence& sequence,
                 const PageSelection& selection) {
  json variant = {{"name", result.name}, {"metrics", result.metrics}, {"trajectory", nullptr},
                  {"solver", nullptr},   {"planes", nullptr},         {"grids", nullptr},
                  {"points", nullptr}};
  for (const char* key : {"artefact", "findings"}) variant["metrics"].erase(key);
  AddEstimates(result, sequence, selection, &variant);
  return variant;
}

std::vector<size_t> DetailedVariants(const json& page) {
  const json& variants = page.at("variants");
  auto names = kKnownVariants;
  std::ranges::reverse(names);
  const std::array<std::string, 3> kinds = {"map", "views", "frames"};
  const auto place = [](const auto& in, const json& name) {
    return std::ranges::find(in, name.get<std::string>()) - in.begin();
  };
  const auto rank = [&](size_t index) {
    const json& variant = variants[index];
    return std::pair(place(kinds, variant.at("kind")), place(names, variant.at("name")));
  };
  std::vector<size_t> detailed;
  for (size_t i = 0; i < variants.size(); ++i) {
    if (!variants[i].at("numbers_only")) detailed.push_back(i);
  }
  std::ranges::stable_sort(detailed, {}, rank);
  return detailed;
}

}  // namespace soslam
