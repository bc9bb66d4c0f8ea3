// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

namespace soslam {

// Where a dataset of somebody else's may be: in the folder that the environment variable
// SOSLAM_DATA_ROOT names, or else in shared/data beside the project.
inline std::filesystem::path RealDataset(const std::string& name) {
  const char* root = std::getenv("SOSLAM_DATA_ROOT");
  return std::filesystem::path(root != nullptr ? root : SOSLAM_SOURCE_DIR "/../shared/data") / name;
}

}  // namespace soslam
