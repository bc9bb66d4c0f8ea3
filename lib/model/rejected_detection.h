// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "geometry/box.h"

namespace soslam {

// Stages that reject detections.
enum class RejectingStage { kImport, kAssociate, kPlanes };
inline constexpr const char* kRejectingStageNames[] = {"import", "associate", "planes"};

// A detection that is not used.
struct RejectedDetection {
  int frame_index = 0;  // index in Sequence::frames
  std::string label;
  double score = 1.0;
  Box box;
  std::optional<int> true_object_id = std::nullopt;  // see Detection::true_object_id
  RejectingStage stage = RejectingStage::kImport;
  std::string reason;
};

}  // namespace soslam
