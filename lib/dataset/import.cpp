// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/import.h"

#include <fmt/format.h>

#include <cstdio>
#include <utility>
#include <variant>

#include "artefact/ids.h"
#include "base/error.h"
#include "dataset/bound_edges.h"
#include "dataset/dataset_files.h"
#include "dataset/dataset_json.h"
#include "dataset/detections_csv.h"
#include "dataset/gate.h"
#include "dataset/object_table.h"
#include "dataset/tum_list.h"
#include "model/occlusion.h"

namespace soslam {
namespace {

// Per row of rgb.txt: its position in Sequence::frames, or why it is not there.
using FrameSlot = std::variant<int, RejectReason>;

std::vector<FrameSlot> ReadFrames(const DatasetFiles& files, const ImportOptions& options,
                                  Sequence* sequence) {
  const auto images = ReadImageList(files.images);
  const auto trajectory = ReadTrajectory(files.trajectory);
  const auto truth =
      files.groundtruth ? ReadTrajectory(*files.groundtruth) : std::vector<TimedPose>();
  std::vector<FrameSlot> slots;
  for (int id = 0; id < static_cast<int>(images.size()); ++id) {
    const ListedImage& image = images[static_cast<size_t>(id)];
    const auto pose = NearestPose(trajectory, image.timestamp, options.max_time_difference_s);
    if (id % options.frame_stride != 0) {
      slots.push_back(RejectReason::kFrameNotUsed);
    } else if (!pose) {
      slots.push_back(RejectReason::kFrameWithoutPose);
    } else {
      slots.push_back(static_cast<int>(sequence->frames.size()));
      sequence->frames.push_back(
          {id, image.timestamp, image.image, *pose,
           NearestPose(truth, image.timestamp, options.max_time_difference_s)});
    }
  }
  return slots;
}

// The pose that carries world planes into a frame. Never a mixture of the two trajectories.
std::optional<Rigid3d> PlanePose(const Frame& frame, bool from_truth) {
  return from_truth ? frame.true_world_from_camera : std::optional(frame.world_from_camera);
}

std::optional<RejectReason> Gate(const DetectionRow& row, const std::vector<FrameSlot>& slots,
                                 const Sequence& sequence, bool planes_from_truth,
                                 const ImportOptions& options) {
  if (row.frame_id < 0 || row.frame_id >= static_cast<int>(slots.size())) {
    throw InputError(fmt::format("{}: frame is {}; expected a row of rgb.txt, 0 to {}", row.place,
                                 row.frame_id, slots.size() - 1));
  }
  const FrameSlot& slot = slots[static_cast<size_t>(row.frame_id)];
  if (const auto* reason = std::get_if<RejectReason>(&slot)) return *reason;
  const Frame& frame = sequence.frames[static_cast<size_t>(std::get<int>(slot))];
  if (!PlanePose(frame, planes_from_truth)) return RejectReason::kFrameWithoutPose;
  return GateBox(row, sequence.camera, options);
}

std::vector<DetectionRow> UsableRows(const std::vector<DetectionRow>& rows,
                                     const std::vector<FrameSlot>& slots, bool planes_from_truth,
                                     const ImportOptions& options, Sequence* sequence) {
  RejectionCounts* rejected = &sequence->rejected_detections;
  std::vector<DetectionRow> usable;
  for (const DetectionRow& row : rows) {
    if (const auto reason = Gate(row, slots, *sequence, planes_from_truth, options)) {
      ++(*rejected)[RejectReasonName(*reason)];
    } else {
      usable.push_back(row);
    }
  }
  usable = WithoutDuplicates(std::move(usable), rejected);
  return WithEnoughObservations(usable, options.min_observations, rejected);
}

// The rows of what the camera sees: also of objects that are not used because they are close to the
// border or seen too rarely.
std::vector<DetectionRow> RowsInView(const std::vector<DetectionRow>& rows,
                                     const std::vector<FrameSlot>& slots, bool planes_from_truth,
                                     const ImportOptions& options, const Sequence& sequence) {
  std::vector<DetectionRow> in_view;
  for (const DetectionRow& row : rows) {
    const auto reason = Gate(row, slots, sequence, planes_from_truth, options);
    if (!reason || *reason == RejectReason::kNearBorder) in_view.push_back(row);
  }
  RejectionCounts not_reported;
  return WithoutDuplicates(std::move(in_view), &not_reported);
}

Detection MakeDetection(const DetectionRow& row, int frame_index, int object_index,
                        bool planes_from_truth, const Sequence& sequence) {
  const Object& object = sequence.objects[static_cast<size_t>(object_index)];
  const SupportPlane& plane = sequence.planes[static_cast<size_t>(object.plane_index)];
  const Frame& frame = sequence.frames[static_cast<size_t>(frame_index)];
  const Rigid3d world_from_camera = *PlanePose(frame, planes_from_truth);
  return {frame_index,
          object_index,
          row.score,
          row.box,
          Transform(world_from_camera.Inverse(), plane.plane_in_world),
          {},
          {}};
}

void RequireDetections(const std::filesystem::path& folder, const Sequence& sequence) {
  if (!sequence.detections.empty()) return;
  throw NothingUsableError(fmt::format("{}: no usable detection left; {}", folder.string(),
                                       DescribeRejections(sequence.rejected_detections)));
}

}  // namespace

Sequence ImportDataset(const std::filesystem::path& folder, const ImportOptions& options) {
  const DatasetFiles files = FindDatasetFiles(folder, options.trajectory);
  if (files.trajectory_is_fallback) {
    fmt::print(stderr, "warning: {}: no {}.txt; using {} as the trajectory\n", folder.string(),
               kTrajectorySourceNames[static_cast<int>(options.trajectory)],
               files.trajectory.filename().string());
  }
  Sequence sequence;
  sequence.name = std::filesystem::canonical(folder).filename().string();
  sequence.camera = ReadCamera(files.camera);
  sequence.planes = ReadPlanes(files.planes);
  const std::vector<FrameSlot> slots = ReadFrames(files, options, &sequence);
  const std::vector<DetectionRow> rows = ReadDetections(files.detections);
  sequence.objects = ListObjects(files, rows, sequence.planes);
  const IdTable<Object> object_ids("object", sequence.objects);

  const bool planes_from_truth =
      options.camera_planes == PlanePoses::kGroundTruth && files.groundtruth.has_value();
  const auto detections_of = [&](const std::vector<DetectionRow>& some_rows) {
    std::vector<Detection> detections;
    for (const DetectionRow& row : some_rows) {
      const int frame_index = std::get<int>(slots[static_cast<size_t>(row.frame_id)]);
      detections.push_back(MakeDetection(row, frame_index, object_ids.IndexOf(row.object_id),
                                         planes_from_truth, sequence));
    }
    return detections;
  };
  sequence.detections =
      detections_of(UsableRows(rows, slots, planes_from_truth, options, &sequence));
  RequireDetections(folder, sequence);
  Sequence in_view = sequence;
  in_view.detections = detections_of(RowsInView(rows, slots, planes_from_truth, options, sequence));
  for (Detection& detection : sequence.detections) {
    detection.nearer_boxes = NearerBoxes(in_view, detection);
  }
  MarkBoundEdges(options, &sequence);
  return sequence;
}

}  // namespace soslam
