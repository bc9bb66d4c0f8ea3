// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <vector>

#include "model/sequence.h"

namespace soslam {

// The image of each frame in the dataset folder. Throws InputError, naming `sequence_file`, for a
// path that leaves the folder.
std::vector<std::filesystem::path> ImagePaths(const Sequence& sequence,
                                              const std::filesystem::path& dataset,
                                              const std::filesystem::path& sequence_file);

}  // namespace soslam
