// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <map>
#include <string>
#include <utility>

#include "artefact/files.h"
#include "artefact/model_json.h"
#include "base/error.h"

namespace soslam {

// Before version 1.1 there was no bias of the detector, before 1.9 no cost of boxes.
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE_WITH_DEFAULT(SolverSummary, initial_cost, final_cost, box_cost,
                                                expected_box_cost, iterations, converged,
                                                cost_per_iteration, residuals, gated,
                                                detector_bias_px)

namespace {

using nlohmann::json;
using FrameAndObjectId = std::pair<int, int>;

FrameAndObjectId Ids(const Detection& detection, const Sequence& sequence) {
  return {sequence.frames.at(detection.frame_index).id,
          sequence.objects.at(detection.object_index).id};
}

json ObservationToJson(const ObservationEstimate& estimate, const Sequence& sequence) {
  const auto [frame_id, object_id] =
      Ids(sequence.detections.at(estimate.detection_index), sequence);
  const auto hypothesis_to_json = [](const Hypothesis& hypothesis) -> json {
    return {{"landmark", LandmarkToJson(hypothesis.landmark_in_camera, "camera")},
            {"cost", hypothesis.cost}};
  };
  return {{"frame", frame_id},
          {"object", object_id},
          {"hypotheses", ListToJson(estimate.hypotheses, hypothesis_to_json)},
          {"failure", estimate.failure}};
}

std::vector<ObservationEstimate> ObservationsFromJson(const json& json, const Sequence& sequence) {
  std::map<FrameAndObjectId, int> detection_indices;
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    detection_indices[Ids(sequence.detections[i], sequence)] = static_cast<int>(i);
  }
  std::vector<ObservationEstimate> estimates;
  for (const auto& row : json) {
    const FrameAndObjectId ids = {row.at("frame").get<int>(), row.at("object").get<int>()};
    const auto found = detection_indices.find(ids);
    if (found == detection_indices.end()) {
      throw InputError(
          fmt::format("/observations/{}: the sequence has no detection of object {} "
                      "in frame {}",
                      estimates.size(), ids.second, ids.first));
    }
    const auto hypotheses = ListFromJson(row, "hypotheses", [](const auto& hypothesis) {
      return Hypothesis{LandmarkFromJson(hypothesis.at("landmark"), "camera"),
                        hypothesis.at("cost")};
    });
    estimates.push_back({found->second, hypotheses, row.at("failure")});
  }
  return estimates;
}

}  // namespace

LandmarkEstimates ReadLandmarks(const std::filesystem::path& path, const Sequence& sequence) {
  return ReadArtefactAs(path, "landmarks", [&](const json& json) {
    return LandmarkEstimates{ObservationsFromJson(json.at("observations"), sequence),
                             ObjectEstimatesFromJson(json.at("objects"), sequence)};
  });
}

void WriteLandmarks(const std::filesystem::path& path, const LandmarkEstimates& estimates,
                    const Sequence& sequence, const ArtefactInfo& info) {
  WriteArtefact(path, "landmarks", info,
                {{"observations", ListToJson(estimates.observations, &ObservationToJson, sequence)},
                 {"objects", ObjectEstimatesToJson(estimates.objects, sequence)},
                 {"failures", CountFailures(estimates)}});
}

namespace {

json TrajectoryToJson(const std::vector<Rigid3d>& world_from_camera, const Sequence& sequence) {
  json trajectory = json::array();
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    trajectory.push_back({{"frame", sequence.frames[i].id},
                          {"timestamp", sequence.frames[i].timestamp},
                          {"world_from_camera", world_from_camera.at(i)}});
  }
  return trajectory;
}

std::vector<Rigid3d> TrajectoryFromJson(const json& json, const Sequence& sequence) {
  if (json.size() != sequence.frames.size()) {
    throw InputError(
        fmt::format("/trajectory has {} poses; expected {}, as the sequence has frames",
                    json.size(), sequence.frames.size()));
  }
  std::vector<Rigid3d> world_from_camera;
  for (size_t i = 0; i < json.size(); ++i) {
    const int frame_id = json[i].at("frame").get<int>();
    if (frame_id != sequence.frames[i].id) {
      throw InputError(fmt::format("/trajectory/{}/frame is {}; expected {}, as in the sequence", i,
                                   frame_id, sequence.frames[i].id));
    }
    world_from_camera.push_back(json[i].at("world_from_camera").get<Rigid3d>());
  }
  return world_from_camera;
}

json PlanesToJson(const std::vector<Plane>& planes_in_world, const Sequence& sequence) {
  json planes = json::array();
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    planes.push_back({{"plane", sequence.planes[i].id}, {"plane_in_world", planes_in_world.at(i)}});
  }
  return planes;
}

// Before version 1.3 all planes were given.
std::vector<Plane> PlanesFromJson(const json& map, const Sequence& sequence) {
  std::vector<Plane> planes = PlanesOf(sequence);
  if (!map.contains("planes")) return planes;
  const json& found = map["planes"];
  if (found.size() != planes.size()) {
    throw InputError(fmt::format("/planes has {}; expected {}, as the sequence has", found.size(),
                                 planes.size()));
  }
  for (size_t i = 0; i < planes.size(); ++i) {
    const int id = found[i].at("plane").get<int>();
    if (id != sequence.planes[i].id) {
      throw InputError(fmt::format("/planes/{}/plane is {}; expected {}, as in the sequence", i, id,
                                   sequence.planes[i].id));
    }
    planes[i] = found[i].at("plane_in_world").get<Plane>();
  }
  return planes;
}

}  // namespace

MapEstimate ReadMap(const std::filesystem::path& path, const Sequence& sequence) {
  return ReadArtefactAs(path, "map", [&](const json& json) {
    return MapEstimate{ObjectEstimatesFromJson(json.at("objects"), sequence),
                       TrajectoryFromJson(json.at("trajectory"), sequence),
                       PlanesFromJson(json, sequence), json.at("solver").get<SolverSummary>()};
  });
}

void WriteMap(const std::filesystem::path& path, const MapEstimate& map, const Sequence& sequence,
              const ArtefactInfo& info) {
  WriteArtefact(path, "map", info,
                {{"objects", ObjectEstimatesToJson(map.objects, sequence)},
                 {"trajectory", TrajectoryToJson(map.world_from_camera, sequence)},
                 {"planes", PlanesToJson(map.planes_in_world, sequence)},
                 {"solver", map.solver}});
}

std::map<std::string, int> CountFailures(const LandmarkEstimates& estimates) {
  std::map<std::string, int> failures;
  for (const auto& observation : estimates.observations) {
    if (!observation.failure.empty()) ++failures[observation.failure];
  }
  for (const auto& object : estimates.objects) {
    if (!object.failure.empty()) ++failures[object.failure];
  }
  return failures;
}

}  // namespace soslam
