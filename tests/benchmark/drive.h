// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"

namespace soslam {

// Each object is seen in so many frames.
inline constexpr int kDriveViews = 20;

// A drive past objects of three shapes on both sides, half a metre per frame; boxes, odometry,
// ratios and starts have noise. Nothing hides anything, and no object is met twice.
struct Drive {
  // At least kDriveViews frames and two objects.
  Drive(int frames, int objects);

  Sequence sequence;
  std::vector<std::optional<ShapePrior>> priors;
  // In the world of the odometry, as estimates from the frames would be.
  std::vector<std::optional<Landmark>> initial_landmarks;
};

}  // namespace soslam
