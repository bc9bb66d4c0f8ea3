// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <map>
#include <string>
#include <utility>

#include "artefact/files.h"
#include "artefact/model_json.h"
#include "base/error.h"

namespace soslam {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(SolverSummary, initial_cost, final_cost, box_cost,
                                   expected_box_cost, iterations, converged, cost_per_iteration,
                                   residuals, gated, detector_bias_px)

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
          fmt::format("/observations/{}: the sequence has no detection of object {} in frame {}",
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

// The values of a list in a map that has one row per item of the sequence, in their order.
template <typename Value, typename Items>
std::vector<Value> ValuesOfItems(const json& rows, const std::string& list, const char* item_name,
                                 const char* value_name, const Items& items) {
  if (rows.size() != items.size()) {
    throw InputError(fmt::format("/{} has {} rows; expected {}, one per {} of the sequence", list,
                                 rows.size(), items.size(), item_name));
  }
  std::vector<Value> values;
  for (size_t i = 0; i < rows.size(); ++i) {
    const int id = rows[i].at(item_name).get<int>();
    if (id != items[i].id) {
      throw InputError(fmt::format("/{}/{}/{} is {}; expected {}, as in the sequence", list, i,
                                   item_name, id, items[i].id));
    }
    values.push_back(rows[i].at(value_name).get<Value>());
  }
  return values;
}

json TrajectoryToJson(const std::vector<Rigid3d>& world_from_camera, const Sequence& sequence) {
  json trajectory = json::array();
  for (size_t i = 0; i < sequence.frames.size(); ++i) {
    trajectory.push_back({{"frame", sequence.frames[i].id},
                          {"timestamp", sequence.frames[i].timestamp},
                          {"world_from_camera", world_from_camera.at(i)}});
  }
  return trajectory;
}

json PlanesToJson(const std::vector<Plane>& planes_in_world, const Sequence& sequence) {
  json planes = json::array();
  for (size_t i = 0; i < sequence.planes.size(); ++i) {
    planes.push_back({{"plane", sequence.planes[i].id}, {"plane_in_world", planes_in_world.at(i)}});
  }
  return planes;
}

}  // namespace

MapEstimate ReadMap(const std::filesystem::path& path, const Sequence& sequence) {
  return ReadArtefactAs(path, "map", [&](const json& json) {
    MapEstimate map;
    map.objects = ObjectEstimatesFromJson(json.at("objects"), sequence);
    map.world_from_camera = ValuesOfItems<Rigid3d>(json.at("trajectory"), "trajectory", "frame",
                                                   "world_from_camera", sequence.frames);
    map.planes_in_world = ValuesOfItems<Plane>(json.at("planes"), "planes", "plane",
                                               "plane_in_world", sequence.planes);
    json.at("solver").get_to(map.solver);
    return map;
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
