// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/map_file.h"

#include <fmt/format.h>

#include "artefact/json_geometry.h"
#include "artefact/object_estimate_json.h"
#include "base/error.h"

namespace soslam {
namespace {

using nlohmann::json;

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
  std::vector<Plane> planes;
  for (const SupportPlane& plane : sequence.planes) planes.push_back(plane.plane_in_world);
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

json SolverToJson(const SolverSummary& solver) {
  return {{"initial_cost", solver.initial_cost},
          {"final_cost", solver.final_cost},
          {"iterations", solver.iterations},
          {"converged", solver.converged},
          {"cost_per_iteration", solver.cost_per_iteration},
          {"residuals", solver.residuals},
          {"gated", solver.gated},
          {"detector_bias_px", solver.detector_bias_px}};
}

SolverSummary SolverFromJson(const json& json) {
  SolverSummary solver;
  json.at("initial_cost").get_to(solver.initial_cost);
  json.at("final_cost").get_to(solver.final_cost);
  json.at("iterations").get_to(solver.iterations);
  json.at("converged").get_to(solver.converged);
  json.at("cost_per_iteration").get_to(solver.cost_per_iteration);
  json.at("residuals").get_to(solver.residuals);
  json.at("gated").get_to(solver.gated);
  solver.detector_bias_px = json.value("detector_bias_px", solver.detector_bias_px);
  return solver;
}

}  // namespace

MapEstimate ReadMap(const std::filesystem::path& path, const Sequence& sequence) {
  return ReadArtefactAs(path, "map", [&](const json& json) {
    return MapEstimate{ObjectEstimatesFromJson(json.at("objects"), sequence),
                       TrajectoryFromJson(json.at("trajectory"), sequence),
                       PlanesFromJson(json, sequence), SolverFromJson(json.at("solver"))};
  });
}

void WriteMap(const std::filesystem::path& path, const MapEstimate& map, const Sequence& sequence,
              const ArtefactInfo& info) {
  WriteArtefact(path, "map", info,
                {{"objects", ObjectEstimatesToJson(map.objects, sequence)},
                 {"trajectory", TrajectoryToJson(map.world_from_camera, sequence)},
                 {"planes", PlanesToJson(map.planes_in_world, sequence)},
                 {"solver", SolverToJson(map.solver)}});
}

}  // namespace soslam
