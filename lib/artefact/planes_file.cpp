// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>

#include "artefact/files.h"
#include "artefact/model_json.h"
#include "geometry/angles.h"

namespace soslam {
namespace {

using nlohmann::json;

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

}  // namespace

json PlaneToJson(const EstimatedPlane& plane, double tilt_variance) {
  json covariance, tilt_sigma, height_sigma;
  if (plane.covariance) {
    covariance = MatrixToJson(*plane.covariance);
    tilt_sigma = kDegPerRad *
                 std::sqrt((*plane.covariance)(0, 0) + (*plane.covariance)(1, 1) + tilt_variance);
    height_sigma = std::sqrt((*plane.covariance)(2, 2));
  }
  return {{"plane_in_world", plane.plane_in_world},
          {"point_in_world", VectorToJson(plane.point_in_world)},
          {"x_axis_in_world", VectorToJson(plane.x_axis_in_world)},
          {"covariance", covariance},
          {"tilt_sigma_deg", tilt_sigma},
          {"height_sigma_m", height_sigma}};
}

namespace {

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
  json body = {{"dataset", given.name},
               {"planes", json::array()},
               {"objects", json::array()},
               {"up_of_cameras_in_world", VectorToJson(estimate.up_of_cameras)},
               {"cost", estimate.cost},
               {"rounds", estimate.rounds},
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

}  // namespace soslam
