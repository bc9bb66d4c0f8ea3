// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/world_file.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "artefact/model_json.h"
#include "artefact/planes_file.h"
#include "geometry/angles.h"

namespace soslam {
namespace {

using nlohmann::json;

json UpToJson(const GroundEstimate& estimate) {
  return {{"up_in_input", VectorToJson(estimate.up_in_input)},
          {"sigma_deg", kDegPerRad * estimate.tilt_sigma},
          {"found_by", estimate.planes.empty() ? "cameras" : "planes"},
          {"cameras_held", NameOf(estimate.attitude.holding)},
          {"verticals", estimate.verticals},
          {"sigma_of_cameras_deg", kDegPerRad * estimate.attitude_tilt_sigma},
          {"angle_to_cameras_deg", kDegPerRad * estimate.attitude_tilt}};
}

json ScaleToJson(const GroundEstimate& estimate) {
  if (!estimate.scale) return {};
  std::set<std::string> labels;
  for (const GroundObject& object : estimate.objects) {
    if (object.agreement >= 0.5) labels.insert(object.label);
  }
  const ScalePosterior& scale = *estimate.scale;
  return {{"metres_per_unit", std::exp(scale.log_scale)},
          {"log_sigma", scale.log_sigma},
          {"interval_95", {std::exp(scale.low), std::exp(scale.high)}},
          {"found_by", estimate.scale_found_by},
          {"objects", estimate.AgreeingObjects()},
          {"independent_objects", estimate.independent_objects},
          {"labels", labels},
          {"misfit", scale.misfit},
          {"other_scales_probability", scale.second_mode_share}};
}

json ObjectToJson(const GroundObject& object) {
  json centre;
  if (object.centre_in_world) centre = VectorToJson(*object.centre_in_world);
  return {{"label", object.label},
          {"boxes", object.boxes},
          {"plane", object.plane == kNoPlane ? json() : json(object.plane)},
          {"centre_in_world", centre},
          {"height_m", object.height_m},
          {"log_scale", object.log_scale},
          {"log_sigma", object.log_sigma},
          {"weight", object.weight},
          {"agreement", object.agreement}};
}

}  // namespace

void WriteWorld(const std::filesystem::path& path, const GroundEstimate& estimate,
                const Sequence& input, const ArtefactInfo& info) {
  const Eigen::Quaterniond& rotation = estimate.output_from_input.rigid.rotation;
  json body = {
      {"dataset", input.name},
      {"up", UpToJson(estimate)},
      {"scale", ScaleToJson(estimate)},
      {"output_from_input",
       {{"scale", estimate.output_from_input.scale},
        {"rotation_xyzw", std::vector<double>(rotation.coeffs().begin(), rotation.coeffs().end())},
        {"translation", VectorToJson(estimate.output_from_input.rigid.translation)}}},
      {"planes", json::array()},
      {"points", estimate.points},
      {"planes_of_points", estimate.planes_of_points},
      {"objects", json::array()}};
  for (size_t i = 0; i < estimate.planes.size(); ++i) {
    json plane = PlaneToJson(estimate.planes[i], 0.0);
    plane["plane"] = i;
    plane["points"] = estimate.points_on_planes[i];
    plane["objects"] = std::ranges::count_if(estimate.objects, [&](const GroundObject& object) {
      return object.plane == static_cast<int>(i);
    });
    body["planes"].push_back(std::move(plane));
  }
  for (const GroundObject& object : estimate.objects)
    body["objects"].push_back(ObjectToJson(object));
  WriteArtefact(path, "world", info, std::move(body));
}

}  // namespace soslam
