// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// Sets the scene axes of a sequence's planes from images of the dataset folder, if the sequence has
// one world. Images that are missing or damaged are left out. Those read are added to `inputs`.
void AddSceneAxes(const std::filesystem::path& folder, int threads, Sequence* sequence,
                  std::vector<std::filesystem::path>* inputs);

}  // namespace soslam
