// SPDX-License-Identifier: BSD-3-Clause
#include "exchange/evaluated_world.h"

#include <map>

#include "artefact/model_json.h"
#include "evaluation/alignment.h"

namespace soslam {
namespace {

using nlohmann::json;

// Covariance of rotation, centre and log half axes in the moved world.
Covariance9 Moved(const Covariance9& covariance, const Alignment& alignment) {
  const Eigen::Matrix3d rotation = alignment.truth_from_scaled.rotation.toRotationMatrix();
  Covariance9 jacobian = Covariance9::Identity();
  jacobian.block<3, 3>(0, 0) = rotation;
  jacobian.block<3, 3>(3, 3) = alignment.scale * rotation;
  return jacobian * covariance * jacobian.transpose();
}

void Move(const Alignment& alignment, World* world) {
  for (WorldFrame& frame : world->frames) {
    frame.world_from_camera = alignment.Apply(frame.world_from_camera);
  }
  for (WorldObject& object : world->objects) {
    object.support_normal = alignment.truth_from_scaled.rotation * object.support_normal;
    ObjectEstimate& estimate = object.estimate;
    if (estimate.landmark_in_world) {
      estimate.landmark_in_world = alignment.Apply(*estimate.landmark_in_world);
    }
    if (estimate.covariance) estimate.covariance = Moved(*estimate.covariance, alignment);
  }
}

LandmarkVerdict VerdictFromJson(const json& row) {
  LandmarkVerdict verdict{row.at("fate").get<std::string>()};
  if (!row.at("true_object").is_null()) verdict.true_object = row["true_object"].get<int>();
  if (!row.at("errors").is_null()) verdict.iou = row["errors"].at("iou").get<double>();
  if (!row.at("reason").is_null()) verdict.reason = row["reason"].get<std::string>();
  return verdict;
}

}  // namespace

void AddVerdicts(const json& quality, std::vector<World>* worlds) {
  std::map<int, LandmarkVerdict> of_object;
  for (const json& row : quality.at("landmarks")) {
    of_object[row.at("object").get<int>()] = VerdictFromJson(row);
  }
  for (World& world : *worlds) {
    for (WorldObject& object : world.objects) {
      const auto verdict = of_object.find(object.id);
      if (verdict != of_object.end()) object.verdict = verdict->second;
    }
  }
}

void AlignWorlds(const json& quality, std::vector<World>* worlds) {
  std::map<int, Alignment> of_segment;
  for (const json& alignment : quality.at("alignments")) {
    Alignment& of_its_segment = of_segment[alignment.at("segment").get<int>()];
    alignment.at("scale").get_to(of_its_segment.scale);
    alignment.at("truth_from_scaled").get_to(of_its_segment.truth_from_scaled);
  }
  for (World& world : *worlds) Move(of_segment.at(world.segment), &world);
}

}  // namespace soslam
