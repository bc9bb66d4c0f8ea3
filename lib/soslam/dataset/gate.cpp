// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/dataset/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "soslam/base/text.h"
#include "soslam/dataset/class_names.h"
#include "soslam/model/occlusion.h"
#include "soslam/model/reasons.h"

namespace soslam {

void Rejections::Add(const DetectionRow& row, RejectReason reason) {
  ++counts[NameOf(reason)];
  rows.emplace_back(row, reason);
}

std::string DescribeRejections(const RejectionCounts& rejected) {
  int total = 0;
  for (const auto& [reason, count] : rejected) total += count;
  return fmt::format("{} detections rejected{}", total,
                     rejected.empty() ? "" : ": " + CountsInWords(ReasonsInWords(rejected)));
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
  if (!IsListed(row.label, options.labels)) return RejectReason::kOtherLabel;
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
  std::ranges::stable_sort(rows, {}, [](const DetectionRow& row) {
    return std::tuple(row.frame_id, row.object_id, -row.score);
  });
  std::set<std::pair<int, int>> seen;
  std::erase_if(rows, [&](const DetectionRow& row) {
    if (seen.emplace(row.frame_id, row.object_id).second) return false;
    rejected->Add(row, RejectReason::kDuplicate);
    return true;
  });
  return rows;
}

std::array<bool, 4> EdgesCutByBorder(const Box& box, const Camera& camera) {
  // Edges this close to the image border count as cut by it: detectors end cut boxes a few pixels
  // before the border, and more where boxes are large. Fractions of the image's shorter side and of
  // the box's width or height; the larger one counts.
  constexpr double kCutAtBorderOfImage = 0.01;
  constexpr double kCutAtBorderOfBox = 0.02;
  const double of_image_px = kCutAtBorderOfImage * std::min(camera.width, camera.height);
  const double x_margin_px = std::max(of_image_px, kCutAtBorderOfBox * box.Width());
  const double y_margin_px = std::max(of_image_px, kCutAtBorderOfBox * box.Height());
  return {box.x_min + 0.5 <= x_margin_px,                 //
          box.y_min + 0.5 <= y_margin_px,                 //
          camera.width - 0.5 - box.x_max <= x_margin_px,  //
          camera.height - 0.5 - box.y_max <= y_margin_px};
}

// Nearer objects make only the lower edge one-sided. They stand on the same support, so they
// occlude what is behind them from the base upwards, and a box that ends within another has
// probably lost its base. Sides and tops are less certain: the box of a tall object full of gaps (a
// chair) covers much that is visible past its back and between its legs, and the edge of the object
// behind is then measured as well as any.
void MarkHiddenEdges(double hidden_edge_fraction, Sequence* sequence) {
  // Errors of a lower edge and of the upper edge of what hides it, as a fraction of the box's
  // height.
  constexpr double kEdgeErrorFraction = 0.05;
  // Rounding tolerance: a covered share equal to the option's value counts as occluded.
  constexpr double kShareTolerance = 1e-9;
  for (Detection& detection : sequence->detections) {
    const Box& box = detection.box;
    const double margin = kEdgeErrorFraction * box.Height();
    std::vector<std::pair<double, double>> intervals;  // of the lower edge, inside other boxes
    for (const Box& other : BoxesInFront(*sequence, detection)) {
      if (box.y_max < other.y_min - margin || box.y_max > other.y_max) continue;
      intervals.emplace_back(std::max(box.x_min, other.x_min), std::min(box.x_max, other.x_max));
    }
    std::ranges::sort(intervals);
    double covered = 0.0;
    double covered_until = -std::numeric_limits<double>::infinity();
    for (const auto& [begin, end] : intervals) {
      covered += std::max(0.0, end - std::max(begin, covered_until));
      covered_until = std::max(covered_until, end);
    }
    if (covered / box.Width() >= hidden_edge_fraction - kShareTolerance) {
      detection.is_one_sided[3] = true;
    }
  }
}

namespace {

// New place of a frame of the whole sequence.
struct Destination {
  bool is_held_out;
  size_t index;  // index in Sequence::held_out or Sequence::frames
};

// Elements of frames that are not held out, with new frame indices.
template <typename OfFrame>
std::vector<OfFrame> InKeptFrames(std::vector<OfFrame> all,
                                  const std::vector<Destination>& destinations) {
  std::vector<OfFrame> kept;
  for (OfFrame& one : all) {
    const auto [is_held_out, index] = destinations[one.frame_index];
    if (is_held_out) continue;
    one.frame_index = static_cast<int>(index);
    kept.push_back(std::move(one));
  }
  return kept;
}

}  // namespace

Sequence HoldOutFrames(Sequence sequence, HeldOutFrames held_out) {
  if (held_out == HeldOutFrames::kNone) return sequence;
  const std::vector<Frame> frames = std::exchange(sequence.frames, {});
  std::vector<Destination> destinations;
  size_t place = 0;
  for (size_t i = 0; i < frames.size(); ++i) {
    place = i > 0 && frames[i].segment == frames[i - 1].segment ? place + 1 : 0;
    if (place % 2 == 1) {
      destinations.push_back({true, sequence.held_out.size()});
      sequence.held_out.push_back({frames[i], {}});
      sequence.held_out.back().frame.boxes_in_view.clear();
    } else {
      destinations.push_back({false, sequence.frames.size()});
      sequence.frames.push_back(frames[i]);
    }
  }
  for (Detection& detection : std::exchange(sequence.detections, {})) {
    const auto [is_held_out, index] = destinations[detection.frame_index];
    if (is_held_out) {
      const std::string& label = sequence.ObjectOf(detection).label;
      sequence.held_out[index].boxes.push_back({label, detection.score, detection.box});
    } else {
      detection.frame_index = static_cast<int>(index);
      sequence.detections.push_back(std::move(detection));
    }
  }
  sequence.rejected = InKeptFrames(std::move(sequence.rejected), destinations);
  sequence.truth_in_frames = InKeptFrames(std::move(sequence.truth_in_frames), destinations);
  return sequence;
}

}  // namespace soslam
