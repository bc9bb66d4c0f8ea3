// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "soslam/model/sequence.h"

namespace soslam {

// Description of sequence.json, see base/description.h. Files refer to frames, planes and objects
// by id, code by index in a vector sorted by id.

template <typename Visitor>
void Describe(Visitor& visit, GroundTruth& truth) {
  visit.Field("landmark", &truth.landmark_in_world, "pose and size in the world", {}, kInWorld);
  visit.Field("mirror_symmetric", &truth.mirror_symmetric, "symmetric in its xz plane");
  visit.Field("mirror_symmetric_yz", &truth.mirror_symmetric_yz,
              "also symmetric in its yz plane: front and back look alike");
  visit.Field("rotationally_symmetric", &truth.rotationally_symmetric, "about its z axis");
}

template <typename Visitor>
void Describe(Visitor& visit, TrueObject& object) {
  visit.Field("object", &object.id, "id in the dataset");
  visit.Field("label", &object.label, "category", kNotEmpty);
  visit.Field("segment", &object.segment, "recording in whose world it is", kNotNegative);
  visit.Field("is_static", &object.is_static,
              "false: it moves, or is not known to stand still, and has no place in a map");
  visit.OrAbsent("is_ignored", &object.is_ignored,
                 "true: its label is none of those that the import was asked for; a landmark of it "
                 "is neither right nor wrong, and that there is none is no miss");
  visit.Field("ground_truth", &object.truth, "of an object that moves: where it was seen first");
}

// A row of numbers, because there may be many.
template <typename Visitor>
void Describe(Visitor& visit, TruthInFrame& truth) {
  Eigen::Quaterniond& rotation = truth.landmark_in_camera.frame_from_object.rotation;
  Eigen::Vector3d& translation = truth.landmark_in_camera.frame_from_object.translation;
  Eigen::Vector3d& half_axes = truth.landmark_in_camera.half_axes;
  visit.FrameIdItem(&truth.frame_index, "id of the frame");
  visit.Item(&truth.true_object_id, "id of the true object");
  visit.Item(&rotation.x(), "rotation of camera_from_object: unit quaternion, x");
  visit.Item(&rotation.y(), "y");
  visit.Item(&rotation.z(), "z");
  visit.Item(&rotation.w(), "w");
  visit.Check([&] {
    return std::abs(rotation.norm() - 1.0) <= 1e-6
               ? std::string()
               : fmt::format("rotation has norm {}; expected 1", rotation.norm());
  });
  visit.Item(&translation.x(), "translation, x, metres");
  visit.Item(&translation.y(), "y");
  visit.Item(&translation.z(), "z");
  visit.Item(&half_axes.x(), "half axis along x, metres", kPositive);
  visit.Item(&half_axes.y(), "along y", kPositive);
  visit.Item(&half_axes.z(), "along z", kPositive);
}

template <typename Visitor>
void Describe(Visitor& visit, IgnoredThings& things) {
  visit.OrAbsent("label", &things.label, "category; absent: whatever they are", kNotEmpty);
  visit.OrAbsent("landmark", &things.volume_in_world,
                 "volume in which they are, a box with these half axes; absent: wherever they are",
                 {}, kInWorld);
  visit.Check([&] {
    return things.label || things.volume_in_world ? "" : "has neither field; expected one";
  });
}

template <typename Visitor>
void Describe(Visitor& visit, Frame& frame) {
  visit.Field("frame", &frame.id, "id: row of the dataset's image list, from 0", kNotNegative);
  visit.Field("timestamp", &frame.timestamp, "seconds, within its segment");
  visit.OrNull("image", &frame.image, "path relative to the dataset folder; null: no image",
               kNotEmpty);
  visit.Field("world_from_camera", &frame.world_from_camera, "estimated pose: odometry");
  visit.Field("true_world_from_camera", &frame.true_world_from_camera,
              "true pose, for evaluation; null where it is not known");
  visit.Field("segment", &frame.segment,
              "recording that the frame belongs to, which has a world of its own; the frames of a "
              "segment follow each other",
              kNotNegative);
  visit.OrAbsent("camera", &frame.camera, "absent where it is that of the sequence");
  visit.OrAbsent("boxes_in_view", &frame.boxes_in_view,
                 "boxes of all that was detected in the frame, used or not, nearest first");
}

template <typename Visitor>
void Describe(Visitor& visit, HeightPrior& prior) {
  visit.Field("point_in_world", &prior.point_in_world, "point at a distance of 0");
  visit.Field("sigma_m", &prior.sigma_m, "standard deviation of that distance", kPositive);
}

template <typename Visitor>
void Describe(Visitor& visit, PointGround& ground) {
  visit.Field("up_in_world", &ground.up_in_world, "unit vector");
  visit.Field("up_information", &ground.up_information,
              "what is known of up n, as a cost half n^T information n (1 / rad^2)");
  visit.Field("planes", &ground.planes, "horizontal planes of points on which objects stand");
  visit.Check([&] {
    const Eigen::Vector3d& up = ground.up_in_world;
    const Eigen::Matrix3d with_up = ground.up_information + up * up.transpose();
    if (std::abs(up.norm() - 1.0) > 1e-6) return std::string("up_in_world has not the length 1");
    return with_up.determinant() > 0.0 ? std::string()
                                       : std::string("up_information says nothing of a direction");
  });
}

template <typename Visitor>
void Describe(Visitor& visit, SupportPlane& plane) {
  visit.Field("plane", &plane.id, "id");
  visit.Field("plane_in_world", &plane.plane_in_world, "where it is");
  visit.OrAbsent("attitude_information", &plane.attitude_information,
                 "of an estimated plane: what is known of its normal n without boxes, as a cost "
                 "half n^T information n (1 / rad^2); absent: the plane is given and exact. "
                 "Estimated planes of one normal are parallel");
  visit.OrAbsent("height_prior", &plane.height_prior,
                 "of an estimated plane: what is known of its height without boxes");
  visit.OrAbsent("scene_axis", &plane.scene_axis_in_world,
                 "unit vector in the plane along which, modulo quarter turns, most straight edges "
                 "of the scene lie; absent: unknown, or there is none");
}

template <typename Visitor>
void Describe(Visitor& visit, LabelProbability& label) {
  visit.Field("label", &label.label, "category", kNotEmpty);
  visit.Field("probability", &label.probability, "that the object is of it", kShare);
}

template <typename Visitor>
void Describe(Visitor& visit, Object& object) {
  visit.Field("object", &object.id, "id");
  visit.Field("label", &object.label, "category, the most probable one", kNotEmpty);
  std::optional<int> plane;
  if (object.plane_index != kNoPlane) plane = object.plane_index;
  visit.Id("plane", &plane, &Sequence::planes, "id of the plane that it stands on; null: unknown");
  visit.AfterReading([&] { object.plane_index = plane.value_or(kNoPlane); });
  visit.Field("ground_truth", &object.ground_truth,
              "for evaluation; null where it is not known. Of an object that moves, where it was "
              "seen first");
  visit.Field("is_static", &object.is_static,
              "false: it moves, or is not known to stand still, and has no place in a map");
  visit.OrAbsent("labels", &object.labels,
                 "categories that it may be of, most probable first, where that is uncertain");
  std::optional<KnownSize> size;
  if (object.known_size.Any()) size = object.known_size;
  visit.OrAbsent("known_size", &size, "lengths that a person measured, as edits.json has them");
  visit.AfterReading([&] { object.known_size = size.value_or(KnownSize()); });
}

template <typename Visitor>
void Describe(Visitor& visit, Detection& detection) {
  visit.Id("frame", &detection.frame_index, &Sequence::frames, "id of the frame");
  visit.Id("object", &detection.object_index, &Sequence::objects, "id of the object");
  visit.Field("score", &detection.score, "the detector's confidence");
  visit.Field("box", &detection.box, "pixels");
  const Sequence* sequence = visit.sequence();
  std::optional<Plane> plane = detection.plane_in_camera;
  const bool stands = sequence != nullptr && !sequence->objects.empty() &&
                      sequence->ObjectOf(detection).plane_index != kNoPlane;
  if (!stands) plane.reset();
  visit.Field("plane_in_camera", &plane,
              "support plane of the object in the frame of this camera; null: unknown");
  visit.Check([&] {
    return sequence == nullptr || stands == plane.has_value()
               ? ""
               : "plane_in_camera contradicts the plane of the object; expected both or none";
  });
  visit.AfterReading([&] { detection.plane_in_camera = plane.value_or(Plane()); });
  std::vector<BoxSide> bounds;
  for (size_t i = 0; i < detection.is_one_sided.size(); ++i) {
    if (detection.is_one_sided[i]) bounds.push_back(static_cast<BoxSide>(i));
  }
  visit.Field("bounds", &bounds,
              "edges of the box that the object may reach beyond, because the image border or a "
              "nearer object cuts it off");
  visit.Check([&] {
    const auto twice = [&](BoxSide edge) { return std::ranges::count(bounds, edge) > 1; };
    return std::ranges::any_of(bounds, twice) ? "bounds has an edge twice; expected once" : "";
  });
  visit.AfterReading([&] {
    detection.is_one_sided = {};
    for (const BoxSide edge : bounds) detection.is_one_sided[static_cast<size_t>(edge)] = true;
  });
  visit.Field("nearer_in_view", &detection.nearer_in_view,
              "what may hide this one: as many of the frame's boxes_in_view, from the first",
              kNotNegative);
  visit.OrAbsent("own_in_view", &detection.own_in_view,
                 "index of the one of these that is of the same object, and does not hide it",
                 kNotNegative);
  visit.OrAbsent("true_landmark", &detection.true_landmark_in_camera,
                 "true pose and size in the frame of this camera, where the dataset has these for "
                 "each frame",
                 {}, kInCamera);
  visit.OrAbsent("true_object", &detection.true_object_id,
                 "id of the one of true_objects that it is of, where the dataset says so");
}

template <typename Visitor>
void Describe(Visitor& visit, HeldOutFrame::LabelledBox& box) {
  visit.Field("label", &box.label, "category", kNotEmpty);
  visit.Field("score", &box.score, "the detector's confidence");
  visit.Field("box", &box.box, "pixels");
}

template <typename Visitor>
void Describe(Visitor& visit, HeldOutFrame& held_out) {
  visit.Field("frame", &held_out.frame, "the frame");
  visit.Field("boxes", &held_out.boxes, "usable detections, without their objects");
}

// Sequence::rejected as rows of numbers, because they may be many.
struct RejectedTable {
  struct Reason {
    RejectingStage stage;
    std::string reason;
    auto operator<=>(const Reason&) const = default;
  };
  struct Row {
    int frame_index;
    int reason;
    int label;
    std::optional<int> true_object_id;
    double score;
    Box box;
  };
  std::vector<Reason> reasons;
  std::vector<std::string> labels;
  std::vector<Row> rows;
};
RejectedTable TableOfRejected(const std::vector<RejectedDetection>& rejected);
std::vector<RejectedDetection> RejectedOfTable(const RejectedTable& table);

template <typename Visitor>
void Describe(Visitor& visit, RejectedTable::Reason& reason) {
  visit.Field("stage", &reason.stage, "stage that left them out");
  visit.Field("reason", &reason.reason, "as rejected_detections counts it", kNotEmpty);
}

template <typename Visitor>
void Describe(Visitor& visit, RejectedTable::Row& row) {
  visit.FrameIdItem(&row.frame_index, "id of the frame");
  visit.Item(&row.reason, "row of reasons", kNotNegative);
  visit.Item(&row.label, "row of labels", kNotNegative);
  visit.Item(&row.true_object_id, "id of the true object, null: unknown");
  visit.Item(&row.score, "score");
  visit.Item(&row.box.x_min, "x_min, pixels");
  visit.Item(&row.box.y_min, "y_min");
  visit.Item(&row.box.x_max, "x_max");
  visit.Item(&row.box.y_max, "y_max");
}

template <typename Visitor>
void Describe(Visitor& visit, RejectedTable& table) {
  visit.Field("reasons", &table.reasons, "why detections were not used");
  visit.Field("labels", &table.labels, "categories");
  visit.Field("rows", &table.rows, "detections");
  visit.Check([&] {
    for (size_t i = 0; i < table.rows.size(); ++i) {
      const auto& [frame, reason, label, true_object, score, box] = table.rows[i];
      if (reason < std::ssize(table.reasons) && label < std::ssize(table.labels)) continue;
      return fmt::format("row {} has reason {} and label {}; expected less than {} and {}", i,
                         reason, label, table.reasons.size(), table.labels.size());
    }
    return std::string();
  });
}

// The broken rule that no type expresses, in words, or empty: detections and other rows
// ascend by frame, then object; frames of a segment are contiguous, as odometry connects
// neighbours.
template <typename Item>
std::string AscendingIdsViolation(const char* name, const std::vector<Item>& items) {
  const auto pair = std::ranges::adjacent_find(items, std::greater_equal(), &Item::id);
  if (pair == items.end()) return "";
  return fmt::format("{} {} follows {} {}; expected ascending ids", name, std::next(pair)->id, name,
                     pair->id);
}
std::string FramesViolation(const std::vector<Frame>& frames);
std::string SupportsViolation(const Sequence& sequence);
std::string DetectionsViolation(const Sequence& sequence);
std::string HeldOutViolation(const Sequence& sequence);
std::string TruthInFramesViolation(const std::vector<TruthInFrame>& rows);

template <typename Visitor>
void Describe(Visitor& visit, Sequence& sequence) {
  visit.OfSequence(&sequence);
  visit.Field("name", &sequence.name, "name of the dataset");
  visit.Field("camera", &sequence.camera, "pinhole camera without distortion");
  visit.OrAbsent("odometry_source", &sequence.odometry_source,
                 "whose the pose estimates are, such as ORB-SLAM2; absent: unknown");
  std::vector<double> distortion;
  if (sequence.image_distortion) distortion = DistortionCoefficients(*sequence.image_distortion);
  visit.OrAbsent("image_distortion", &distortion,
                 "what the lens does to the image files: OpenCV's k1, k2, p1, p2, k3 and, as far "
                 "as they are not 0, k4, k5, k6, s1, s2, s3, s4, tau_x, tau_y. Boxes are those of "
                 "the camera without it");
  visit.AfterReading([&] { sequence.image_distortion = DistortionOfCoefficients(distortion); });
  visit.Check([&] {
    return distortion.empty() || (distortion.size() > 4 && sequence.image_distortion)
               ? std::string()
               : fmt::format("image_distortion has {} numbers; expected 5, 8, 12 or 14",
                             distortion.size());
  });
  visit.Field("image_orientation", &sequence.image_orientation,
              "what camera and boxes refer to where EXIF turns an image: the image as viewers show "
              "it (upright), or the pixels as the file stores them");
  visit.Field("frames", &sequence.frames, "images that are used, by ascending id");
  visit.Check([&] { return FramesViolation(sequence.frames); });
  visit.Field("planes", &sequence.planes, "support planes, by ascending id; empty: unknown");
  visit.Check([&] { return AscendingIdsViolation("plane", sequence.planes); });
  visit.OrAbsent("ground", &sequence.ground,
                 "what soslam-ground found of up and horizontal planes of points; not all that "
                 "objects stand on has points");
  visit.Field("objects", &sequence.objects, "by ascending id");
  visit.Check([&] { return AscendingIdsViolation("object", sequence.objects); });
  visit.Check([&] { return SupportsViolation(sequence); });
  visit.Field("detections", &sequence.detections, "those that are used, by frame, then object");
  visit.Check([&] { return DetectionsViolation(sequence); });
  visit.OrAbsent("held_out", &sequence.held_out,
                 "frames that no estimate may use, and what was detected there, by ascending id");
  visit.Check([&] { return HeldOutViolation(sequence); });
  visit.Field("rejected_detections", &sequence.rejected_detections,
              "number of detections of the dataset that were not used, by reason", kNotNegative);
  std::optional<RejectedTable> rejected;
  if (!sequence.rejected.empty()) rejected = TableOfRejected(sequence.rejected);
  visit.OrAbsent("rejected", &rejected, "detections of these frames that were not used");
  visit.AfterReading(
      [&] { sequence.rejected = RejectedOfTable(rejected.value_or(RejectedTable())); });
  visit.Field("true_objects", &sequence.true_objects,
              "what is known to be there, by ascending id, whatever is detected of it");
  visit.Check([&] { return AscendingIdsViolation("true object", sequence.true_objects); });
  visit.OrAbsent("truth_in_frames", &sequence.truth_in_frames,
                 "where true objects are in each frame, if the dataset has that");
  visit.Check([&] { return TruthInFramesViolation(sequence.truth_in_frames); });
  visit.OrAbsent("ignored", &sequence.ignored,
                 "things that are there and that nobody has measured: landmarks of these are "
                 "neither right nor wrong");
  visit.Field("odometry_world", &sequence.odometry_world,
              "world of world_from_camera, as the settings say: that of the truth, another one in "
              "metres, or another one of any unit");
  visit.OrDefault(
      "moving_labels", &sequence.moving_labels, Sequence().moving_labels,
      "labels of things that move, separated by commas: they get no place in a map, and "
      "points in their boxes are no evidence");
  visit.OrAbsent("images_without_pose", &sequence.images_without_pose,
                 "images to which the reconstruction gave no pose, which are not used");
  visit.OrAbsent("edits", &sequence.edits,
                 "corrections of the association by hand that were applied");
}

}  // namespace soslam
