// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "geometry/box.h"

namespace soslam {

// The stages that leave detections out.
enum class RejectingStage { kImport, kAssociate, kPlanes };
inline constexpr const char* kRejectingStageNames[] = {"import", "associate", "planes"};

// What was detected in a frame and is not used.
struct RejectedDetection {
  int frame_index = 0;  // into Sequence::frames
  std::string label;
  double score = 1.0;
  Box box;
  std::optional<int> true_object_id = std::nullopt;  // as Detection has it
  RejectingStage stage = RejectingStage::kImport;
  std::string reason;
};

}  // namespace soslam
