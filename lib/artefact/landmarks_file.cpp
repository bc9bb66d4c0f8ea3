// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/landmarks_file.h"

#include <fmt/format.h>

#include <map>
#include <string>
#include <utility>

#include "artefact/json_geometry.h"
#include "artefact/object_estimate_json.h"
#include "base/error.h"

namespace soslam {
namespace {

using nlohmann::json;
using FrameAndObjectId = std::pair<int, int>;

FrameAndObjectId Ids(const Detection& detection, const Sequence& sequence) {
  return {sequence.frames.at(static_cast<size_t>(detection.frame_index)).id,
          sequence.objects.at(static_cast<size_t>(detection.object_index)).id};
}

json ObservationToJson(const ObservationEstimate& estimate, const Sequence& sequence) {
  const auto [frame_id, object_id] =
      Ids(sequence.detections.at(static_cast<size_t>(estimate.detection_index)), sequence);
  json hypotheses = json::array();
  for (const Hypothesis& hypothesis : estimate.hypotheses) {
    hypotheses.push_back({{"landmark", LandmarkToJson(hypothesis.landmark_in_camera, "camera")},
                          {"cost", hypothesis.cost}});
  }
  return {{"frame", frame_id},
          {"object", object_id},
          {"hypotheses", hypotheses},
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
    ObservationEstimate estimate{found->second, {}, row.at("failure").get<std::string>()};
    for (const auto& hypothesis : row.at("hypotheses")) {
      estimate.hypotheses.push_back({LandmarkFromJson(hypothesis.at("landmark"), "camera"),
                                     hypothesis.at("cost").get<double>()});
    }
    estimates.push_back(std::move(estimate));
  }
  return estimates;
}

// Number of observations and objects with a failure, per reason.
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

}  // namespace

LandmarkEstimates ReadLandmarks(const std::filesystem::path& path, const Sequence& sequence) {
  return ReadArtefactAs(path, "landmarks", [&](const json& json) {
    return LandmarkEstimates{ObservationsFromJson(json.at("observations"), sequence),
                             ObjectEstimatesFromJson(json.at("objects"), sequence)};
  });
}

void WriteLandmarks(const std::filesystem::path& path, const LandmarkEstimates& estimates,
                    const Sequence& sequence, const ArtefactInfo& info) {
  json observations = json::array();
  for (const ObservationEstimate& estimate : estimates.observations) {
    observations.push_back(ObservationToJson(estimate, sequence));
  }
  WriteArtefact(path, "landmarks", info,
                {{"observations", observations},
                 {"objects", ObjectEstimatesToJson(estimates.objects, sequence)},
                 {"failures", CountFailures(estimates)}});
}

}  // namespace soslam
