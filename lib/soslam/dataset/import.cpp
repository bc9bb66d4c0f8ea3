// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>
#include <variant>

#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/class_names.h"
#include "soslam/dataset/dataset_checks.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/gate.h"
#include "soslam/model/describe_sequence.h"
#include "soslam/model/occlusion.h"

namespace soslam {
namespace {

DatasetContent ReadContent(const std::filesystem::path& folder, const ImportOptions& options) {
  switch (options.format) {
    case DatasetFormat::kKittiTracking:
      return ReadKittiTracking(folder, options);
    case DatasetFormat::kKittiObject:
      return ReadKittiObject(folder, options);
    case DatasetFormat::kSlamSynthetic:
      return ReadSlamSynthetic(folder, options);
    case DatasetFormat::kSoslam:
    case DatasetFormat::kTumRgbd:
    case DatasetFormat::kIclNuim:
      return ReadSoslamFolder(folder, options);
  }
  throw std::logic_error("format without a reader");
}

// Position of a dataset frame in Sequence::frames, or the reason why it is not used.
using FrameSlot = std::variant<int, RejectReason>;

// Creates the detections of a sequence whose frames, planes and objects are known.
class DetectionImporter {
 public:
  DetectionImporter(const DatasetContent& content, const ImportOptions& options, Sequence* sequence)
      : content_(content),
        options_(options),
        sequence_(sequence),
        planes_from_truth_(options.camera_planes == PlanePoses::kGroundTruth &&
                           content.has_true_poses) {
    if (const auto violation = AscendingIdsViolation("object", sequence->objects);
        !violation.empty()) {
      throw InputError(violation);
    }
    int in_segment = 0;
    for (size_t i = 0; i < content.frames.size(); ++i) {
      const Frame& frame = content.frames[i].frame;
      const bool is_first = i == 0 || frame.segment != content.frames[i - 1].frame.segment;
      in_segment = is_first ? 0 : in_segment + 1;
      if (in_segment < options.first_frame ||
          (in_segment - options.first_frame) % options.frame_stride != 0) {
        slots_[frame.id] = RejectReason::kFrameNotUsed;
      } else if (options.images_only && frame.image.empty()) {
        slots_[frame.id] = RejectReason::kFrameWithoutImage;
      } else if (!content.frames[i].has_pose) {
        slots_[frame.id] = RejectReason::kFrameWithoutPose;
      } else {
        slots_[frame.id] = static_cast<int>(sequence->frames.size());
        sequence->frames.push_back(frame);
      }
    }
  }

  void Import() {
    Rejections rejected;
    std::vector<DetectionRow> usable, in_view;
    for (const DetectionRow& row : content_.rows) {
      const auto reason = Gate(row);
      if (!reason) usable.push_back(row);
      if (!reason || IsInView(*reason)) in_view.push_back(row);
      if (reason) rejected.Add(row, *reason);
    }
    CheckBoxesOfImages(in_view);
    Sequence all_in_view = *sequence_;
    usable = WithoutDuplicates(std::move(usable), &rejected);
    if (content_.has_object_ids) {
      std::map<int, int> observations;  // by object
      for (const DetectionRow& row : usable) ++observations[row.object_id];
      std::erase_if(usable, [&](const DetectionRow& row) {
        if (observations[row.object_id] >= options_.min_observations) return false;
        rejected.Add(row, RejectReason::kTooFewObservations);
        return true;
      });
    }
    sequence_->detections = Detections(usable);

    Rejections not_reported;
    all_in_view.detections = Detections(WithoutDuplicates(std::move(in_view), &not_reported));
    ListBoxesInView(all_in_view, sequence_);
    MarkHiddenEdges(options_.hidden_edge_fraction, sequence_);
    Keep(rejected);
    Keep(content_.rejected);
    for (const auto& label : content_.labels_in_frames) {
      const auto* frame_index = std::get_if<int>(&slots_.at(label.frame_id));
      if (frame_index == nullptr) continue;
      sequence_->truth_in_frames.push_back(
          {*frame_index, label.true_object_id, label.landmark_in_camera});
    }
    std::ranges::sort(sequence_->truth_in_frames, {}, [](const TruthInFrame& truth) {
      return std::pair(truth.frame_index, truth.true_object_id);
    });
  }

 private:
  // The pose that transforms world planes into a frame. Never a mixture of the two trajectories.
  std::optional<Rigid3d> PlanePose(const Frame& frame) const {
    return planes_from_truth_ ? frame.true_world_from_camera
                              : std::optional(frame.world_from_camera);
  }

  // Throws InputError for more boxes in an image than detectors leave after non-maximum suppression
  // (300 where COCO's usual limits hold): what may occlude what takes time with their square.
  void CheckBoxesOfImages(const std::vector<DetectionRow>& rows) const {
    constexpr int kMost = 1000;
    std::map<int, int> boxes;
    for (const DetectionRow& row : rows) {
      if (++boxes[row.frame_id] <= kMost) continue;
      const auto all = std::ranges::count(rows, row.frame_id, &DetectionRow::frame_id);
      throw InputError(fmt::format(
          "{}: is one of {} boxes of image {}; expected at most {} in an image: are they a "
          "network's output before non-maximum suppression? min_score drops the less certain ones",
          row.place, all, row.frame_id, kMost));
    }
  }

  std::optional<RejectReason> Gate(const DetectionRow& row) const {
    const FrameSlot& slot = slots_.at(row.frame_id);
    if (const auto* reason = std::get_if<RejectReason>(&slot)) return *reason;
    const Frame& frame = sequence_->frames[std::get<int>(slot)];
    const bool needs_plane_pose = !row.plane_in_camera && !sequence_->planes.empty();
    if (needs_plane_pose && !PlanePose(frame)) return RejectReason::kFrameWithoutPose;
    return GateRow(row, sequence_->CameraOf(frame), options_);
  }

  // Stores the counts of all rejected detections, and those of used frames.
  void Keep(const Rejections& rejected) {
    for (const auto& [reason, count] : rejected.counts) {
      sequence_->rejected_detections[reason] += count;
    }
    for (const auto& [row, reason] : rejected.rows) {
      const auto* frame_index = std::get_if<int>(&slots_.at(row.frame_id));
      if (frame_index == nullptr) continue;
      sequence_->rejected.push_back({*frame_index, row.label, row.score, row.box,
                                     TrueObjectId(row.object_id), RejectingStage::kImport,
                                     NameOf(reason)});
    }
  }

  std::optional<int> TrueObjectId(int object_id) const {
    const bool is_known =
        content_.has_object_ids &&
        std::ranges::binary_search(sequence_->true_objects, object_id, {}, &TrueObject::id);
    return is_known ? std::optional(object_id) : std::nullopt;
  }

  std::vector<Detection> Detections(const std::vector<DetectionRow>& rows) const {
    std::vector<Detection> detections;
    for (const DetectionRow& row : rows) {
      Detection detection;
      detection.frame_index = std::get<int>(slots_.at(row.frame_id));
      const auto object =
          std::ranges::lower_bound(sequence_->objects, row.object_id, {}, &Object::id);
      if (object == sequence_->objects.end() || object->id != row.object_id) {
        throw std::logic_error(fmt::format("no reader makes object {}", row.object_id));
      }
      detection.object_index = static_cast<int>(object - sequence_->objects.begin());
      detection.score = row.score;
      detection.box = row.box;
      if (row.plane_in_camera) {
        detection.plane_in_camera = *row.plane_in_camera;
      } else if (object->plane_index != kNoPlane) {
        const Rigid3d world_from_camera = *PlanePose(sequence_->FrameOf(detection));
        detection.plane_in_camera = Transform(
            world_from_camera.Inverse(), sequence_->planes[object->plane_index].plane_in_world);
      }
      detection.is_one_sided =
          EdgesCutByBorder(row.box_in_image_file.value_or(row.box), sequence_->CameraOf(detection));
      detection.true_landmark_in_camera = row.true_landmark_in_camera;
      detection.true_object_id = TrueObjectId(row.object_id);
      detections.push_back(detection);
    }
    return detections;
  }

  const DatasetContent& content_;
  const ImportOptions& options_;
  Sequence* sequence_;
  std::map<int, FrameSlot> slots_;  // of all frames, by id
  bool planes_from_truth_;
};

// Drops objects without detections, in datasets in which each detection is a separate object; this
// includes those of objects.json, whose detections are unknown.
void DropUndetectedObjects(Sequence* sequence) {
  std::vector<bool> is_kept(sequence->objects.size());
  for (const Detection& detection : sequence->detections) {
    is_kept[detection.object_index] = true;
  }
  std::vector<int> new_index(is_kept.size());
  std::vector<Object> kept;
  for (size_t i = 0; i < is_kept.size(); ++i) {
    new_index[i] = static_cast<int>(kept.size());
    if (is_kept[i]) kept.push_back(std::move(sequence->objects[i]));
  }
  sequence->objects = std::move(kept);
  for (Detection& detection : sequence->detections) {
    detection.object_index = new_index[detection.object_index];
  }
}

}  // namespace

Sequence ImportDataset(const std::filesystem::path& folder, const ImportOptions& options,
                       std::vector<std::filesystem::path>* files_read) {
  if (!IsFolder(folder)) {
    throw InputError(folder.string() + ": is not a folder; expected a dataset folder");
  }
  const DatasetContent content = ReadContent(folder, options);
  Sequence sequence = content.sequence;
  sequence.name = std::filesystem::canonical(folder).filename().string();
  sequence.odometry_source = options.odometry_source;
  sequence.image_orientation = options.image_orientation;
  sequence.moving_labels = options.moving_labels;
  std::ranges::sort(sequence.true_objects, {}, &TrueObject::id);
  for (TrueObject& object : sequence.true_objects) {
    object.is_ignored = !IsListed(object.label, options.labels);
  }
  sequence.odometry_world = options.folder.odometry_has_own_scale ? OdometryWorld::kOwnWithScale
                            : options.folder.align_odometry       ? OdometryWorld::kOwn
                                                                  : OdometryWorld::kOfTruth;
  DetectionImporter(content, options, &sequence).Import();
  sequence.findings = CheckDataset({folder, options, content, sequence});
  std::vector<std::string> errors;
  for (const Finding& finding : sequence.findings) {
    if (finding.severity == Severity::kError) errors.push_back(InWords(finding));
  }
  if (!errors.empty()) {
    throw InputError(fmt::format("{}: {}", folder.string(), fmt::join(errors, "; also: ")));
  }
  sequence = HoldOutFrames(std::move(sequence), options.held_out);
  if (sequence.detections.empty()) {
    std::string message = fmt::format("{}: no usable detection left; {}", folder.string(),
                                      DescribeRejections(sequence.rejected_detections));
    for (const Finding& finding : sequence.findings) message += "; " + InWords(finding);
    throw NothingUsableError(message);
  }
  if (!content.has_object_ids) DropUndetectedObjects(&sequence);
  if (files_read != nullptr) *files_read = content.files;
  return sequence;
}

}  // namespace soslam
