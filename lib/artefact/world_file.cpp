// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "artefact/files.h"
#include "artefact/model_json.h"
#include "evaluation/result_checks.h"
#include "geometry/angles.h"
#include "ground/ground_checks.h"

namespace soslam {
namespace {

using nlohmann::json;

json UpToJson(const GroundEstimate& estimate) {
  return {
      {"up_in_input", VectorToJson(estimate.up_in_input)},
      {"sigma_deg", kDegPerRad * estimate.tilt_sigma},
      {"found_by", estimate.planes.empty() ? "cameras" : "planes"},
      {"cameras_held", estimate.cameras_are_turned ? "turned" : NameOf(estimate.attitude.holding)},
      {"verticals", estimate.verticals},
      {"sigma_of_cameras_deg", kDegPerRad * estimate.attitude_tilt_sigma},
      {"angle_to_cameras_deg", kDegPerRad * estimate.attitude_tilt}};
}

json ScaleToJson(const GroundEstimate& estimate, const std::vector<Finding>& findings) {
  const auto scale = WorldScaleOf(estimate, findings);
  if (!scale) return {};
  std::set<std::string> labels;
  for (const GroundObject& object : estimate.objects) {
    if (object.AgreesWithScale()) labels.insert(object.label);
  }
  return {{"metres_per_unit", scale->metres_per_unit},
          {"log_sigma", scale->log_sigma},
          {"interval_95", {scale->low, scale->high}},
          {"found_by", scale->found_by},
          {"objects", scale->objects},
          {"contradicted_by", scale->contradicted_by},
          {"independent_objects", estimate.IndependentObjects()},
          {"labels", labels},
          {"misfit", estimate.scale->misfit},
          {"other_scales_probability", estimate.scale->second_mode_share}};
}

json GroundObjectToJson(const GroundObject& object) {
  const auto& centre = object.centre_in_world;
  return {{"label", object.label},
          {"boxes", object.boxes},
          {"plane", object.plane == kNoPlane ? json() : json(object.plane)},
          {"centre_in_world", centre ? VectorToJson(*centre) : json()},
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
      {"scale", ScaleToJson(estimate, info.findings)},
      {"output_from_input",
       {{"scale", estimate.output_from_input.scale},
        {"rotation_xyzw", std::vector<double>(rotation.coeffs().begin(), rotation.coeffs().end())},
        {"translation", VectorToJson(estimate.output_from_input.rigid.translation)}}},
      {"planes", json::array()},
      {"points", estimate.points},
      {"planes_of_points", estimate.planes_of_points},
      {"objects", ListToJson(estimate.objects, &GroundObjectToJson)}};
  for (size_t i = 0; i < estimate.planes.size(); ++i) {
    json plane = PlaneToJson(estimate.planes[i], 0.0);
    plane["plane"] = i;
    plane["points"] = estimate.points_on_planes[i];
    plane["objects"] = std::ranges::count_if(estimate.objects, [&](const GroundObject& object) {
      return object.plane == static_cast<int>(i);
    });
    body["planes"].push_back(std::move(plane));
  }
  WriteArtefact(path, "world", info, std::move(body));
}

std::optional<WorldScale> ScaleOfWorld(const json& world) {
  const json& scale = world.at("scale");
  if (scale.is_null()) return std::nullopt;
  const auto& interval = scale.at("interval_95");
  return WorldScale{scale.at("metres_per_unit").get<double>(),
                    scale.at("log_sigma").get<double>(),
                    interval.at(0).get<double>(),
                    interval.at(1).get<double>(),
                    scale.at("found_by").get<std::vector<std::string>>(),
                    scale.at("objects").get<int>(),
                    scale.value("contradicted_by", std::vector<std::string>())};
}

std::string DoubtOfUp(const json& world) {
  const std::map<std::string, std::string> doubts = {
      {kHoldingOfPlanesCheck, "objects and flat surfaces contradict each other"},
      {kCamerasTurnedCheck, "the photos are turned in many ways"},
      {kFewObjectsOnPlanesCheck, "few objects stand on flat surfaces"},
      {kUpDirectionCheck, "objects look alike in other ways to hold the camera"}};
  std::vector<std::string> words;
  for (const json& finding : world.value("findings", json::array())) {
    const auto doubt = doubts.find(finding.at("check").get<std::string>());
    if (doubt != doubts.end()) words.push_back(doubt->second);
  }
  return fmt::format("{}", fmt::join(words, ", and "));
}

}  // namespace soslam
