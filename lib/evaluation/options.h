// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"

namespace soslam {

enum class AlignmentChoice { kAuto, kNone, kRigid, kSimilarity };
inline constexpr const char* kAlignmentChoiceNames[] = {"auto", "none", "rigid", "similarity"};

// The paper's protocol has no settings: numbers from different runs stay comparable.
struct EvaluateOptions {
  AlignmentChoice alignment = AlignmentChoice::kAuto;

  void Describe(OptionVisitor& visit) {
    visit.Group("Comparison of maps");
    visit.Choice(
        "alignment", &alignment, kAlignmentChoiceNames,
        "how a map is moved, for map_quality only, so that its camera centres fit the true "
        "ones best: as a whole (rigid), also scaled (similarity), not at all (none); auto: "
        "none where odometry and truth are in one world, rigid where the odometry has a "
        "world of its own, similarity where it has a scale of its own");
  }
};

}  // namespace soslam
