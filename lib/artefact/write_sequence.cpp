// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <utility>

#include "artefact/files.h"
#include "artefact/model_json.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

using nlohmann::json;

json FrameToJson(const Frame& frame) {
  json fields = {{"frame", frame.id},
                 {"timestamp", frame.timestamp},
                 {"image", frame.image.empty() ? json() : json(frame.image)},
                 {"world_from_camera", frame.world_from_camera},
                 {"true_world_from_camera", frame.true_world_from_camera},
                 {"segment", frame.segment}};
  if (frame.camera) fields["camera"] = *frame.camera;
  if (!frame.boxes_in_view.empty()) fields["boxes_in_view"] = frame.boxes_in_view;
  return fields;
}

json GroundTruthToJson(const GroundTruth& truth) {
  return {{"landmark", LandmarkToJson(truth.landmark_in_world, "world")},
          {"mirror_symmetric", truth.mirror_symmetric},
          {"mirror_symmetric_yz", truth.mirror_symmetric_yz},
          {"rotationally_symmetric", truth.rotationally_symmetric}};
}

json SupportPlaneToJson(const SupportPlane& plane) {
  json fields = {{"plane", plane.id}, {"plane_in_world", plane.plane_in_world}};
  if (plane.attitude_information) fields["attitude_information"] = *plane.attitude_information;
  if (plane.height_prior) fields["height_prior"] = *plane.height_prior;
  if (plane.scene_axis_in_world) fields["scene_axis"] = *plane.scene_axis_in_world;
  return fields;
}

json ObjectToJson(const Object& object, const Sequence& sequence) {
  json fields = {
      {"object", object.id},
      {"label", object.label},
      {"plane",
       object.plane_index == kNoPlane ? json() : json(sequence.planes.at(object.plane_index).id)},
      {"ground_truth", object.ground_truth ? GroundTruthToJson(*object.ground_truth) : json()},
      {"is_static", object.is_static}};
  if (!object.labels.empty()) fields["labels"] = object.labels;
  return fields;
}

json TrueObjectToJson(const TrueObject& object) {
  json fields = {{"object", object.id},
                 {"label", object.label},
                 {"segment", object.segment},
                 {"is_static", object.is_static},
                 {"ground_truth", GroundTruthToJson(object.truth)}};
  if (object.is_ignored) fields["is_ignored"] = true;
  return fields;
}

// Row of numbers: frame, object, rotation (x, y, z, w), translation (m), half axes (m).
json TruthInFrameToJson(const TruthInFrame& truth, const Sequence& sequence) {
  const auto& [rotation, translation] = truth.landmark_in_camera.frame_from_object;
  const Eigen::Vector3d& half_axes = truth.landmark_in_camera.half_axes;
  json row = {sequence.frames.at(truth.frame_index).id, truth.true_object_id};
  for (const double number : rotation.coeffs()) row.push_back(number);
  for (const double number : translation) row.push_back(number);
  for (const double number : half_axes) row.push_back(number);
  return row;
}

json IgnoredToJson(const IgnoredThings& things) {
  json fields = json::object();
  if (things.label) fields["label"] = *things.label;
  if (things.volume_in_world) fields["landmark"] = LandmarkToJson(*things.volume_in_world, "world");
  return fields;
}

json OneSidedToJson(const std::array<bool, 4>& is_one_sided) {
  json names = json::array();
  for (size_t i = 0; i < is_one_sided.size(); ++i) {
    if (is_one_sided[i]) names.push_back(kEdgeNames[i]);
  }
  return names;
}

json DetectionToJson(const Detection& detection, const Sequence& sequence) {
  json fields = {{"frame", sequence.frames.at(detection.frame_index).id},
                 {"object", sequence.objects.at(detection.object_index).id},
                 {"score", detection.score},
                 {"box", detection.box},
                 {"plane_in_camera", sequence.ObjectOf(detection).plane_index == kNoPlane
                                         ? json()
                                         : json(detection.plane_in_camera)},
                 {"bounds", OneSidedToJson(detection.is_one_sided)},
                 {"nearer_in_view", detection.nearer_in_view}};
  if (detection.own_in_view) fields["own_in_view"] = *detection.own_in_view;
  if (detection.true_landmark_in_camera) {
    fields["true_landmark"] = LandmarkToJson(*detection.true_landmark_in_camera, "camera");
  }
  if (detection.true_object_id) fields["true_object"] = *detection.true_object_id;
  return fields;
}

json HeldOutToJson(const HeldOutFrame& held_out) {
  return {{"frame", FrameToJson(held_out.frame)}, {"boxes", held_out.boxes}};
}

// Rejected detections as rows of numbers, because they may be many: frame, index in `reasons`,
// index in `labels`, true object or null, score, box.
json RejectedToJson(const Sequence& sequence) {
  std::map<std::pair<RejectingStage, std::string>, size_t> reasons;
  std::map<std::string, size_t> labels;
  for (const RejectedDetection& rejected : sequence.rejected) {
    reasons.try_emplace({rejected.stage, rejected.reason});
    labels.try_emplace(rejected.label);
  }
  json fields = {{"reasons", json::array()}, {"labels", json::array()}, {"rows", json::array()}};
  for (auto& [reason, row] : reasons) {
    row = fields["reasons"].size();
    fields["reasons"].push_back({{"stage", kRejectingStageNames[static_cast<size_t>(reason.first)]},
                                 {"reason", reason.second}});
  }
  for (auto& [label, row] : labels) {
    row = fields["labels"].size();
    fields["labels"].push_back(label);
  }
  for (const RejectedDetection& rejected : sequence.rejected) {
    const Box& box = rejected.box;
    fields["rows"].push_back({sequence.frames.at(rejected.frame_index).id,
                              reasons.at({rejected.stage, rejected.reason}),
                              labels.at(rejected.label), rejected.true_object_id, rejected.score,
                              box.x_min, box.y_min, box.x_max, box.y_max});
  }
  return fields;
}

}  // namespace

void WriteSequence(const std::filesystem::path& path, const Sequence& sequence,
                   const ArtefactInfo& info) {
  json body = {
      {"name", sequence.name},
      {"camera", sequence.camera},
      {"image_orientation",
       kImageOrientationNames[static_cast<size_t>(sequence.image_orientation)]},
      {"frames", ListToJson(sequence.frames, &FrameToJson)},
      {"planes", ListToJson(sequence.planes, &SupportPlaneToJson)},
      {"objects", ListToJson(sequence.objects, &ObjectToJson, sequence)},
      {"detections", ListToJson(sequence.detections, &DetectionToJson, sequence)},
      {"rejected_detections", sequence.rejected_detections},
      {"true_objects", ListToJson(sequence.true_objects, &TrueObjectToJson)},
      {"odometry_world", kOdometryWorldNames[static_cast<size_t>(sequence.odometry_world)]},
      {"held_out", ListToJson(sequence.held_out, &HeldOutToJson)},
      {"truth_in_frames", ListToJson(sequence.truth_in_frames, &TruthInFrameToJson, sequence)},
      {"ignored", ListToJson(sequence.ignored, &IgnoredToJson)},
      {"images_without_pose", sequence.images_without_pose}};
  for (const char* name : {"held_out", "truth_in_frames", "ignored", "images_without_pose"}) {
    if (body[name].empty()) body.erase(name);
  }
  if (!sequence.odometry_source.empty()) body["odometry_source"] = sequence.odometry_source;
  if (sequence.image_distortion)
    body["image_distortion"] = DistortionCoefficients(*sequence.image_distortion);
  if (!sequence.rejected.empty()) body["rejected"] = RejectedToJson(sequence);
  ArtefactInfo with_findings = info;
  with_findings.findings = sequence.findings;
  WriteArtefact(path, "sequence", with_findings, std::move(body));
}

}  // namespace soslam
