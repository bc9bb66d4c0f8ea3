// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "soslam/artefact/described_json.h"
#include "soslam/artefact/json_file.h"
#include "soslam/geometry/angles.h"
#include "soslam/inspection/inspection.h"
#include "soslam/model/describe_estimates.h"
#include "soslam/model/metric_catalogue.h"

namespace soslam {
namespace {

const std::vector<ValueColumn> kColumns = {
    {"yaw_deg", "of the x axis about the object's own z axis"},
    {"sigma_centre_m", "standard deviation of the centre, over all directions"},
    {"sigma_yaw_deg", "standard deviation of the yaw"},
    {"sigma_size_percent", "root mean square of the standard deviations of the half axes"}};

std::vector<Value> DeriveCells(const ObjectEstimate& estimate) {
  std::vector<Value> cells(kColumns.size());
  if (!estimate.landmark_in_world) return cells;
  const Eigen::Quaterniond& rotation = estimate.landmark_in_world->frame_from_object.rotation;
  cells[0] = kDegPerRad * Yaw(rotation * Eigen::Vector3d::UnitZ(), rotation);
  if (!estimate.covariance) return cells;
  cells[1] = std::sqrt(estimate.covariance->block<3, 3>(3, 3).trace());
  cells[2] = *YawSigmaDeg(estimate);
  cells[3] = 100.0 * std::sqrt(estimate.covariance->bottomRightCorner<3, 3>().trace() / 3.0);
  return cells;
}

}  // namespace

void AddDerivedColumns(const std::string& kind, const nlohmann::json& document,
                       Inspection* inspection) {
  LandmarkEstimates estimates;
  if (kind == "landmarks") {
    estimates = DescribedFromJson<Artefact<LandmarkEstimates>>(document).body;
  } else if (kind == "map") {
    estimates.objects = DescribedFromJson<Artefact<MapEstimate>>(document).body.objects;
  }
  std::vector<std::vector<Value>> observations, objects;
  for (const ObservationEstimate& one : estimates.observations) {
    ObjectEstimate best;
    if (!one.hypotheses.empty()) best.landmark_in_world = one.hypotheses.front().landmark_in_camera;
    observations.push_back(DeriveCells(best));
  }
  for (const ObjectEstimate& one : estimates.objects) objects.push_back(DeriveCells(one));
  for (const auto& [name, cells] :
       {std::pair("observations", observations), {"objects", objects}}) {
    const auto table = std::ranges::find(inspection->tables, name, &ValueTable::name);
    if (cells.empty()) continue;
    table->columns.insert(table->columns.end(), kColumns.begin(), kColumns.end());
    for (size_t i = 0; i < cells.size(); ++i) {
      table->rows[i].insert(table->rows[i].end(), cells[i].begin(), cells[i].end());
    }
  }
}

}  // namespace soslam
