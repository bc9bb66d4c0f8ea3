// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/describe_sequence.h"

#include <map>
#include <set>
#include <tuple>

namespace soslam {

RejectedTable TableOfRejected(const std::vector<RejectedDetection>& rejected) {
  std::map<RejectedTable::Reason, int> reasons;
  std::map<std::string, int> labels;
  for (const RejectedDetection& detection : rejected) {
    reasons.try_emplace({detection.stage, detection.reason});
    labels.try_emplace(detection.label);
  }
  RejectedTable table;
  for (auto& [reason, row] : reasons) {
    row = static_cast<int>(table.reasons.size());
    table.reasons.push_back(reason);
  }
  for (auto& [label, row] : labels) {
    row = static_cast<int>(table.labels.size());
    table.labels.push_back(label);
  }
  for (const RejectedDetection& detection : rejected) {
    table.rows.push_back({detection.frame_index, reasons.at({detection.stage, detection.reason}),
                          labels.at(detection.label), detection.true_object_id, detection.score,
                          detection.box});
  }
  return table;
}

std::vector<RejectedDetection> RejectedOfTable(const RejectedTable& table) {
  std::vector<RejectedDetection> rejected;
  for (const RejectedTable::Row& row : table.rows) {
    const RejectedTable::Reason& reason = table.reasons.at(row.reason);
    rejected.push_back({row.frame_index, table.labels.at(row.label), row.score, row.box,
                        row.true_object_id, reason.stage, reason.reason});
  }
  return rejected;
}

std::string FramesViolation(const std::vector<Frame>& frames) {
  std::set<int> seen;
  for (size_t i = 0; i < frames.size(); ++i) {
    if (i > 0 && frames[i].segment == frames[i - 1].segment) continue;
    if (!seen.insert(frames[i].segment).second) {
      return fmt::format(
          "/frames/{} is of segment {} again; expected the frames of a segment without a gap", i,
          frames[i].segment);
    }
  }
  return AscendingIdsViolation("frame", frames);
}

std::string SupportsViolation(const Sequence& sequence) {
  for (size_t i = 0; i < sequence.objects.size(); ++i) {
    const bool is_known = sequence.objects[0].plane_index != kNoPlane;
    if ((sequence.objects[i].plane_index != kNoPlane) == is_known) continue;
    return fmt::format("/objects/{}/plane is {}; expected {}, as that of the first object is", i,
                       is_known ? "null" : "a plane", is_known ? "a plane" : "null");
  }
  return "";
}

namespace {

// Rows have a frame index and an index or id of an object.
template <typename Row>
std::string OrderViolation(const char* list, const std::vector<Row>& rows, int Row::*object) {
  const auto key = [&](const Row& row) { return std::tuple(row.frame_index, row.*object); };
  for (size_t i = 1; i < rows.size(); ++i) {
    if (key(rows[i]) > key(rows[i - 1])) continue;
    return fmt::format("/{}/{} is out of order; expected ascending frame, then object", list, i);
  }
  return "";
}

}  // namespace

std::string DetectionsViolation(const Sequence& sequence) {
  for (size_t i = 0; i < sequence.detections.size(); ++i) {
    const Detection& detection = sequence.detections[i];
    const size_t in_view = sequence.FrameOf(detection).boxes_in_view.size();
    if (static_cast<size_t>(detection.nearer_in_view) <= in_view) continue;
    return fmt::format(
        "/detections/{}/nearer_in_view is {}; expected at most the {} boxes_in_view of its frame",
        i, detection.nearer_in_view, in_view);
  }
  return OrderViolation("detections", sequence.detections, &Detection::object_index);
}

std::string HeldOutViolation(const Sequence& sequence) {
  for (size_t i = 0; i < sequence.held_out.size(); ++i) {
    const Frame& frame = sequence.held_out[i].frame;
    if (i > 0 && frame.id <= sequence.held_out[i - 1].frame.id) {
      return fmt::format("/held_out/{}/frame/frame is {} after {}; expected ascending ids", i,
                         frame.id, sequence.held_out[i - 1].frame.id);
    }
    const auto next = std::ranges::lower_bound(sequence.frames, frame.id, {}, &Frame::id);
    if (next != sequence.frames.end() && next->id == frame.id) {
      return fmt::format("/held_out/{}/frame/frame is {}; expected a frame that is not in /frames",
                         i, frame.id);
    }
    const bool has_neighbour =
        (next != sequence.frames.begin() && std::prev(next)->segment == frame.segment) ||
        (next != sequence.frames.end() && next->segment == frame.segment);
    if (!has_neighbour) {
      return fmt::format(
          "/held_out/{}/frame/segment is {}; expected that of a frame before or after", i,
          frame.segment);
    }
  }
  return "";
}

std::string TruthInFramesViolation(const std::vector<TruthInFrame>& rows) {
  return OrderViolation("truth_in_frames", rows, &TruthInFrame::true_object_id);
}

}  // namespace soslam
