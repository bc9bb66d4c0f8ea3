// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/object_estimate_json.h"

#include <array>

#include "artefact/ids.h"
#include "artefact/json_geometry.h"

namespace soslam {
namespace {

using nlohmann::json;
using CovarianceRows = std::array<std::array<double, 9>, 9>;

Covariance9 CovarianceFromJson(const json& json) {
  const auto rows = json.get<CovarianceRows>();
  return Eigen::Map<const Eigen::Matrix<double, 9, 9, Eigen::RowMajor>>(rows[0].data());
}

json EstimateToJson(const ObjectEstimate& estimate, const Sequence& sequence) {
  const auto& landmark = estimate.landmark_in_world;
  const auto& covariance = estimate.covariance;
  return {{"object", sequence.objects.at(static_cast<size_t>(estimate.object_index)).id},
          {"observations", estimate.observations},
          {"landmark", landmark ? LandmarkToJson(*landmark, "world") : json()},
          {"covariance", covariance ? CovarianceToJson(*covariance) : json()},
          {"failure", estimate.failure},
          {"proper_ellipsoid", estimate.proper_ellipsoid}};
}

}  // namespace

json CovarianceToJson(const Covariance9& covariance) {
  json rows = json::array();
  for (const auto& row : covariance.rowwise()) {
    rows.push_back(std::vector<double>(row.begin(), row.end()));
  }
  return rows;
}

json ObjectEstimatesToJson(const std::vector<ObjectEstimate>& estimates, const Sequence& sequence) {
  json rows = json::array();
  for (const ObjectEstimate& estimate : estimates) {
    rows.push_back(EstimateToJson(estimate, sequence));
  }
  return rows;
}

ObjectEstimate ObjectEstimateFromJson(const json& row) {
  ObjectEstimate estimate;
  row.at("observations").get_to(estimate.observations);
  const auto& landmark = row.at("landmark");
  if (!landmark.is_null()) estimate.landmark_in_world = LandmarkFromJson(landmark, "world");
  const auto& covariance = row.at("covariance");
  if (!covariance.is_null()) estimate.covariance = CovarianceFromJson(covariance);
  row.at("failure").get_to(estimate.failure);
  row.at("proper_ellipsoid").get_to(estimate.proper_ellipsoid);
  return estimate;
}

std::vector<ObjectEstimate> ObjectEstimatesFromJson(const json& json, const Sequence& sequence) {
  const IdTable<Object> objects("object", sequence.objects);
  std::vector<ObjectEstimate> estimates;
  for (const auto& row : json) {
    estimates.push_back(ObjectEstimateFromJson(row));
    estimates.back().object_index = objects.IndexOf(row.at("object").get<int>());
  }
  return estimates;
}

}  // namespace soslam
