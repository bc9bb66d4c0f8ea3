// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "artefact/files.h"
#include "artefact/model_json.h"
#include "evaluation/result_checks.h"
#include "geometry/angles.h"
#include "ground/ground_checks.h"

namespace soslam {

using nlohmann::json;

namespace {

json ErrorToJson(const std::optional<PlaneError>& error, const Sequence& given) {
  if (!error) return {};
  return {{"plane", given.planes[error->given_plane_index].id},
          {"angle_deg", kDegPerRad * error->angle},
          {"offset_m", error->offset}};
}

json HoldingToJson(const PlanesEstimate& estimate) {
  const auto to_json = [](const TriedHolding& one) -> json {
    return {{"held", NameOf(one.holding)},
            {"verticals", one.verticals},
            {"cost", one.cost},
            {"probability", one.probability},
            {"planes", one.planes}};
  };
  return {{"held", NameOf(estimate.holding)},
          {"verticals", estimate.verticals},
          {"is_clear", estimate.holding_tilt_variance == 0.0},
          {"tried", ListToJson(estimate.holdings, to_json)}};
}

// A plane in both kinds, without its id and error. `tilt_variance` (rad^2) is added to the tilt of
// the covariance.
json PlaneToJson(const EstimatedPlane& plane, double tilt_variance) {
  json tilt_sigma, height_sigma;
  if (plane.covariance) {
    tilt_sigma = kDegPerRad *
                 std::sqrt((*plane.covariance)(0, 0) + (*plane.covariance)(1, 1) + tilt_variance);
    height_sigma = std::sqrt((*plane.covariance)(2, 2));
  }
  return {{"plane_in_world", plane.plane_in_world},
          {"point_in_world", plane.point_in_world},
          {"x_axis_in_world", plane.x_axis_in_world},
          {"covariance", plane.covariance},
          {"tilt_sigma_deg", tilt_sigma},
          {"height_sigma_m", height_sigma}};
}

json SupportToJson(const ObjectSupport& support, const Object& object) {
  return {{"object", object.id},
          {"label", object.label},
          {"plane", support.reason == SupportReason::kNone ? json() : json(support.plane_index)},
          {"reason", kSupportReasonNames[static_cast<size_t>(support.reason)]},
          {"height_m", support.height},
          {"height_sigma_m", support.height_sigma},
          {"cost", support.cost}};
}

}  // namespace

void WritePlanes(const std::filesystem::path& path, const PlanesEstimate& estimate,
                 const Sequence& given, const ArtefactInfo& info) {
  json body = {{"dataset", given.name},      {"planes", json::array()},
               {"objects", json::array()},   {"up_of_cameras_in_world", estimate.up_of_cameras},
               {"cost", estimate.cost},      {"rounds", estimate.rounds},
               {"settled", estimate.settled}};
  if (!estimate.holdings.empty()) body["camera_holding"] = HoldingToJson(estimate);
  for (size_t i = 0; i < estimate.planes.size(); ++i) {
    const int index = static_cast<int>(i);
    json plane = PlaneToJson(estimate.planes[i], estimate.holding_tilt_variance);
    plane["plane"] = index;
    plane["error"] = ErrorToJson(CompareWithGiven(given, estimate, index), given);
    body["planes"].push_back(std::move(plane));
  }
  for (size_t i = 0; i < estimate.objects.size(); ++i) {
    body["objects"].push_back(SupportToJson(estimate.objects[i], given.objects[i]));
  }
  WriteArtefact(path, "planes", info, std::move(body));
}

namespace {

json UpToJson(const GroundEstimate& estimate) {
  return {{"up_in_input", estimate.up_in_input},
          {"sigma_deg", kDegPerRad * estimate.tilt_sigma},
          {"found_by", estimate.planes.empty() ? "cameras" : "planes"},
          {"cameras_held",
           estimate.cameras_are_turned ? "turned" : NameOf(estimate.up_of_cameras.holding)},
          {"verticals", estimate.verticals},
          {"sigma_of_cameras_deg", kDegPerRad * estimate.cameras_tilt_sigma},
          {"angle_to_cameras_deg", kDegPerRad * estimate.tilt_to_cameras}};
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
  return {{"label", object.label},
          {"boxes", object.boxes},
          {"plane", object.plane == kNoPlane ? json() : json(object.plane)},
          {"centre_in_world", object.centre_in_world},
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
        {"translation", estimate.output_from_input.rigid.translation}}},
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
