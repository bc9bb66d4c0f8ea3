// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "soslam/training/furniture_model.h"
#include "soslam/training/random.h"

namespace soslam {

// A random model of a kind of which libraries have few, of boxes and cylinders: "office chair",
// "cantilever chair", "shell chair", "sofa", "monitor", "laptop", "keyboard", "cabinet",
// "refrigerator", "desk", "bed". None for another kind.
std::optional<FurnitureModel> ParametricModel(const std::string& kind, Random* random);

}  // namespace soslam
