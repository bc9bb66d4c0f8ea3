// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

#include "artefact/files.h"
#include "artefact/model_json.h"
#include "base/error.h"
#include "geometry/image_size.h"

namespace soslam {
namespace {

using nlohmann::json;

Frame FrameFromJson(const json& json) {
  Frame frame;
  json.at("frame").get_to(frame.id);
  json.at("timestamp").get_to(frame.timestamp);
  if (!json.at("image").is_null()) json["image"].get_to(frame.image);
  json.at("world_from_camera").get_to(frame.world_from_camera);
  json.at("true_world_from_camera").get_to(frame.true_world_from_camera);
  json.at("segment").get_to(frame.segment);
  if (json.contains("camera")) frame.camera = json["camera"].get<Camera>();
  frame.boxes_in_view = json.value("boxes_in_view", std::vector<Box>());
  return frame;
}

GroundTruth GroundTruthFromJson(const json& json) {
  return {LandmarkFromJson(json.at("landmark"), "world"), json.at("mirror_symmetric").get<bool>(),
          json.at("mirror_symmetric_yz").get<bool>(),
          json.at("rotationally_symmetric").get<bool>()};
}

SupportPlane SupportPlaneFromJson(const json& json) {
  return {json.at("plane").get<int>(), json.at("plane_in_world").get<Plane>(),
          json.value("attitude_information", std::optional<Eigen::Matrix3d>()),
          json.value("height_prior", std::optional<HeightPrior>()),
          json.value("scene_axis", std::optional<Eigen::Vector3d>())};
}

TrueObject TrueObjectFromJson(const json& json) {
  return {json.at("object").get<int>(),
          json.at("label").get<std::string>(),
          GroundTruthFromJson(json.at("ground_truth")),
          json.at("segment").get<int>(),
          json.at("is_static").get<bool>(),
          json.value("is_ignored", false)};
}

TruthInFrame TruthInFrameFromJson(const json& row, const std::vector<Frame>& frames) {
  const json pose = {{"rotation_xyzw", {row.at(2), row.at(3), row.at(4), row.at(5)}},
                     {"translation", {row.at(6), row.at(7), row.at(8)}}};
  Landmark landmark;
  landmark.frame_from_object = pose.get<Rigid3d>();
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    row.at(9 + axis).get_to(landmark.half_axes[axis]);
  }
  return {IndexOfId("frame", frames, row.at(0).get<int>()), row.at(1).get<int>(), landmark};
}

IgnoredThings IgnoredFromJson(const json& json) {
  IgnoredThings things;
  if (json.contains("label")) things.label = json["label"].get<std::string>();
  if (json.contains("landmark")) {
    things.volume_in_world = LandmarkFromJson(json["landmark"], "world");
  }
  return things;
}

Object ObjectFromJson(const json& json, const std::vector<SupportPlane>& planes) {
  Object object;
  json.at("object").get_to(object.id);
  json.at("label").get_to(object.label);
  const auto& plane = json.at("plane");
  object.plane_index = plane.is_null() ? kNoPlane : IndexOfId("plane", planes, plane.get<int>());
  const auto& truth = json.at("ground_truth");
  if (!truth.is_null()) object.ground_truth = GroundTruthFromJson(truth);
  json.at("is_static").get_to(object.is_static);
  object.labels = json.value("labels", std::vector<LabelProbability>());
  return object;
}

Distortion DistortionFromJson(const json& json) {
  const auto coefficients = json.get<std::vector<double>>();
  const auto distortion = DistortionOfCoefficients(coefficients);
  if (!distortion) {
    throw InputError(fmt::format("image_distortion has {} numbers; expected 5, 8, 12 or 14",
                                 coefficients.size()));
  }
  return *distortion;
}

std::array<bool, 4> OneSidedFromJson(const json& names) {
  std::array<bool, 4> is_one_sided;
  std::transform(kEdgeNames.begin(), kEdgeNames.end(), is_one_sided.begin(),
                 [&](const char* name) { return std::ranges::find(names, name) != names.end(); });
  return is_one_sided;
}

Detection DetectionFromJson(const json& json, const std::vector<Frame>& frames,
                            const std::vector<Object>& objects) {
  Detection detection;
  detection.frame_index = IndexOfId("frame", frames, json.at("frame").get<int>());
  detection.object_index = IndexOfId("object", objects, json.at("object").get<int>());
  json.at("score").get_to(detection.score);
  json.at("box").get_to(detection.box);
  const auto& plane = json.at("plane_in_camera");
  if (!plane.is_null()) plane.get_to(detection.plane_in_camera);
  detection.is_one_sided = OneSidedFromJson(json.at("bounds"));
  json.at("nearer_in_view").get_to(detection.nearer_in_view);
  if (json.contains("own_in_view")) detection.own_in_view = json["own_in_view"].get<int>();
  if (json.contains("true_landmark")) {
    detection.true_landmark_in_camera = LandmarkFromJson(json["true_landmark"], "camera");
  }
  detection.true_object_id = json.value("true_object", std::optional<int>());
  return detection;
}

HeldOutFrame HeldOutFromJson(const json& json) {
  return {FrameFromJson(json.at("frame")),
          json.at("boxes").get<std::vector<HeldOutFrame::LabelledBox>>()};
}

// The element of `list` whose index is in a row of rejected detections.
const json& Named(const json& list, const json& row, size_t field, size_t place) {
  const auto index = row.at(field).get<size_t>();
  if (index >= list.size()) {
    throw InputError(fmt::format("/rejected/rows/{}/{} is {}; expected less than {}", place, field,
                                 index, list.size()));
  }
  return list[index];
}

std::vector<RejectedDetection> RejectedFromJson(const json& json,
                                                const std::vector<Frame>& frames) {
  std::vector<RejectedDetection> all;
  const auto& rows = json.at("rows");
  for (size_t i = 0; i < rows.size(); ++i) {
    const auto& row = rows[i];
    const auto& reason = Named(json.at("reasons"), row, 1, i);
    RejectedDetection rejected;
    rejected.frame_index = IndexOfId("frame", frames, row.at(0).get<int>());
    rejected.stage = EnumFromName<RejectingStage>(kRejectingStageNames, reason.at("stage"));
    reason.at("reason").get_to(rejected.reason);
    Named(json.at("labels"), row, 2, i).get_to(rejected.label);
    if (!row.at(3).is_null()) rejected.true_object_id = row[3].get<int>();
    row.at(4).get_to(rejected.score);
    rejected.box = {row.at(5), row.at(6), row.at(7), row.at(8)};
    all.push_back(std::move(rejected));
  }
  return all;
}

// Checks that rows, with a frame index and then an index or id of an object, ascend by these.
template <typename Row>
void CheckOrder(const char* list, const std::vector<Row>& rows, int Row::*object) {
  const auto key = [&](const Row& row) { return std::tuple(row.frame_index, row.*object); };
  for (size_t i = 1; i < rows.size(); ++i) {
    if (key(rows[i]) <= key(rows[i - 1])) {
      throw InputError(
          fmt::format("/{}/{} is out of order; expected ascending frame, then object", list, i));
    }
  }
}

void CheckBoxesInView(const Sequence& sequence) {
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    const size_t in_view = sequence.FrameOf(detection).boxes_in_view.size();
    if (static_cast<size_t>(detection.nearer_in_view) > in_view) {
      throw InputError(fmt::format(
          "/detections/{}/nearer_in_view is {}; expected at most the {} boxes_in_view of its frame",
          i, detection.nearer_in_view, in_view));
    }
  }
}

// Checks that the frames of a segment are contiguous, as odometry and trajectories connect
// neighbouring frames.
void CheckSegments(const std::vector<Frame>& frames) {
  std::set<int> seen;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (i > 0 && frames[i].segment == frames[i - 1].segment) continue;
    if (!seen.insert(frames[i].segment).second) {
      throw InputError(fmt::format(
          "/frames/{} is of segment {} again; expected the frames of a segment without a gap", i,
          frames[i].segment));
    }
  }
}

// Checks held-out frames, whose poses follow from the estimates of their neighbours.
void CheckHeldOut(const Sequence& sequence) {
  for (size_t i = 0; i < sequence.held_out.size(); ++i) {
    const Frame& frame = sequence.held_out[i].frame;
    if (i > 0 && frame.id <= sequence.held_out[i - 1].frame.id) {
      throw InputError(
          fmt::format("/held_out/{}/frame/frame is {} after {}; expected ascending ids", i,
                      frame.id, sequence.held_out[i - 1].frame.id));
    }
    const auto next = std::ranges::lower_bound(sequence.frames, frame.id, {}, &Frame::id);
    if (next != sequence.frames.end() && next->id == frame.id) {
      throw InputError(fmt::format(
          "/held_out/{}/frame/frame is {}; expected a frame that is not in /frames", i, frame.id));
    }
    const bool has_neighbour =
        (next != sequence.frames.begin() && std::prev(next)->segment == frame.segment) ||
        (next != sequence.frames.end() && next->segment == frame.segment);
    if (!has_neighbour) {
      throw InputError(
          fmt::format("/held_out/{}/frame/segment is {}; expected that of a frame before or after",
                      i, frame.segment));
    }
  }
}

// Checks that all detected objects have a support plane or none has, and their detections likewise.
void CheckPlanes(const json& json) {
  const auto& detections = json.at("detections");
  const bool has_planes = !json.at("planes").empty();
  const bool is_known =
      has_planes && (detections.empty() || !detections[0].at("plane_in_camera").is_null());
  for (const auto& [list, field] : {std::pair("objects", "plane"),  //
                                    std::pair("detections", "plane_in_camera")}) {
    for (size_t i = 0; i < json.at(list).size(); ++i) {
      const auto& value = json[list][i].at(field);
      if (value.is_null() != is_known) continue;
      throw InputError(
          fmt::format("/{}/{}/{} is {}; expected {}, as {}", list, i, field,
                      value.is_null() ? "null" : "a plane", is_known ? "a plane" : "null",
                      has_planes ? "that of the first detection is" : "there are no planes"));
    }
  }
}

// Ground truth that does not depend on detections.
void TruthFromJson(const json& json, Sequence* sequence) {
  sequence->true_objects = ListFromJson(json, "true_objects", &TrueObjectFromJson);
  CheckAscendingIds("true object", sequence->true_objects);
  sequence->truth_in_frames =
      ListFromJson(json, "truth_in_frames", &TruthInFrameFromJson, sequence->frames);
  CheckOrder("truth_in_frames", sequence->truth_in_frames, &TruthInFrame::true_object_id);
  sequence->ignored = ListFromJson(json, "ignored", &IgnoredFromJson);
  sequence->odometry_world =
      EnumFromName<OdometryWorld>(kOdometryWorldNames, json.at("odometry_world"));
}

Sequence SequenceFromJson(const json& json) {
  Sequence sequence;
  json.at("name").get_to(sequence.name);
  json.at("camera").get_to(sequence.camera);
  sequence.odometry_source = json.value("odometry_source", "");
  if (json.contains("image_distortion")) {
    sequence.image_distortion = DistortionFromJson(json["image_distortion"]);
  }
  sequence.image_orientation =
      EnumFromName<ImageOrientation>(kImageOrientationNames, json.at("image_orientation"));
  CheckPlanes(json);
  sequence.frames = ListFromJson(json, "frames", &FrameFromJson);
  CheckSegments(sequence.frames);
  sequence.planes = ListFromJson(json, "planes", &SupportPlaneFromJson);
  CheckAscendingIds("plane", sequence.planes);
  sequence.objects = ListFromJson(json, "objects", &ObjectFromJson, sequence.planes);
  CheckAscendingIds("frame", sequence.frames);
  CheckAscendingIds("object", sequence.objects);
  sequence.detections =
      ListFromJson(json, "detections", &DetectionFromJson, sequence.frames, sequence.objects);
  CheckOrder("detections", sequence.detections, &Detection::object_index);
  CheckBoxesInView(sequence);
  sequence.held_out = ListFromJson(json, "held_out", &HeldOutFromJson);
  CheckHeldOut(sequence);
  json.at("rejected_detections").get_to(sequence.rejected_detections);
  TruthFromJson(json, &sequence);
  if (json.contains("rejected")) {
    sequence.rejected = RejectedFromJson(json["rejected"], sequence.frames);
  }
  sequence.images_without_pose = json.value("images_without_pose", std::vector<std::string>());
  sequence.findings = FindingsFromJson(json);
  return sequence;
}

}  // namespace

Sequence ReadSequence(const std::filesystem::path& path, PlaneNeed need) {
  Sequence sequence = ReadArtefactAs(path, "sequence", &SequenceFromJson);
  if (need == PlaneNeed::kNeeded && sequence.planes.empty()) {
    throw InputError(fmt::format(
        "{}: has no support planes; expected those of planes.json in the dataset, or estimated "
        "ones: settings {{\"planes\": {{\"planes\": \"estimated\"}}}}",
        path.string()));
  }
  if (need == PlaneNeed::kNeeded && !sequence.HasSupports()) {
    throw InputError(fmt::format(
        "{}: it is not known on which of the {} support planes its objects stand; expected "
        "support_plane of each object in objects.json, or association that finds it: settings "
        "{{\"associate\": {{\"association\": \"estimated\"}}}}",
        path.string(), sequence.planes.size()));
  }
  return sequence;
}

}  // namespace soslam
