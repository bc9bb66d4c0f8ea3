// SPDX-License-Identifier: BSD-3-Clause
#include "dataset/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <tuple>
#include <utility>

#include "dataset/text_file.h"
#include "geometry/box.h"

namespace soslam {

bool IsWanted(const std::string& label, const ImportOptions& options) {
  if (Trimmed(options.labels).empty()) return true;
  const auto listed = SplitFields(options.labels);
  return std::find(listed.begin(), listed.end(), label) != listed.end();
}

const char* RejectReasonName(RejectReason reason) {
  constexpr std::array kNames = {"frame_not_listed",   "frame_not_used",  "frame_without_image",
                                 "frame_without_pose", "other_label",     "truncated",
                                 "occluded",           "low_score",       "beyond_lens_model",
                                 "empty_box",          "outside_image",   "low_box",
                                 "near_border",        "duplicate",       "too_few_observations",
                                 "without_object_id",  "matches_no_label"};
  return kNames.at(static_cast<size_t>(reason));
}

void Rejections::Add(const DetectionRow& row, RejectReason reason) {
  ++counts[RejectReasonName(reason)];
  rows.push_back({row.frame_id, row.object_id, row.label, row.score, row.box, reason});
}

std::string DescribeRejections(const RejectionCounts& rejected) {
  int total = 0;
  std::vector<std::string> parts;
  for (const auto& [reason, count] : rejected) {
    total += count;
    parts.push_back(fmt::format("{} {}", reason, count));
  }
  return fmt::format("{} detections rejected{}{}", total, parts.empty() ? "" : ": ",
                     fmt::join(parts, ", "));
}

bool IsInView(RejectReason reason) {
  switch (reason) {
    case RejectReason::kOtherLabel:
    case RejectReason::kTruncated:
    case RejectReason::kOccluded:
    case RejectReason::kLowBox:
    case RejectReason::kNearBorder:
      return true;
    default:
      return false;
  }
}

std::optional<RejectReason> GateRow(const DetectionRow& row, const Camera& camera,
                                    const ImportOptions& options) {
  // A box exactly border_px from the border is kept regardless of rounding.
  constexpr double kTolerancePx = 1e-9;
  const Box box = row.box_in_image_file.value_or(row.box);
  if (!IsWanted(row.label, options)) return RejectReason::kOtherLabel;
  if (row.score < options.min_score) return RejectReason::kLowScore;
  if (box.Width() <= 0.0 || box.Height() <= 0.0) return RejectReason::kEmptyBox;
  if (box.x_max <= -0.5 || box.y_max <= -0.5 || box.x_min >= camera.width - 0.5 ||
      box.y_min >= camera.height - 0.5) {
    return RejectReason::kOutsideImage;
  }
  if (row.truncation > options.max_truncation) return RejectReason::kTruncated;
  if (row.occlusion > options.max_occlusion) return RejectReason::kOccluded;
  if (box.Height() < options.min_box_height_px) return RejectReason::kLowBox;
  if (DistanceToBorder(box, camera.width, camera.height) < options.border_px - kTolerancePx) {
    return RejectReason::kNearBorder;
  }
  return std::nullopt;
}

std::vector<DetectionRow> WithoutDuplicates(std::vector<DetectionRow> rows, Rejections* rejected) {
  const auto best_first = [](const DetectionRow& a, const DetectionRow& b) {
    return std::tuple(a.frame_id, a.object_id, -a.score) <
           std::tuple(b.frame_id, b.object_id, -b.score);
  };
  const auto same = [](const DetectionRow& a, const DetectionRow& b) {
    return a.frame_id == b.frame_id && a.object_id == b.object_id;
  };
  std::stable_sort(rows.begin(), rows.end(), best_first);
  std::vector<DetectionRow> kept;
  for (DetectionRow& row : rows) {
    if (!kept.empty() && same(kept.back(), row)) {
      rejected->Add(row, RejectReason::kDuplicate);
    } else {
      kept.push_back(std::move(row));
    }
  }
  return kept;
}

std::vector<DetectionRow> WithEnoughObservations(std::vector<DetectionRow> rows,
                                                 int min_observations, Rejections* rejected) {
  std::map<int, int> observations;
  for (const DetectionRow& row : rows) ++observations[row.object_id];
  std::erase_if(rows, [&](const DetectionRow& row) {
    if (observations[row.object_id] >= min_observations) return false;
    rejected->Add(row, RejectReason::kTooFewObservations);
    return true;
  });
  return rows;
}

}  // namespace soslam
