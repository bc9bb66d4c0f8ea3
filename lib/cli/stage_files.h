// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "base/options.h"

namespace soslam {

// The options of a stage that has none.
struct NoOptions {
  void Describe(OptionVisitor& /*visit*/) {}
};

// The files that a stage was called with, keyed by argument name; absent when an optional one was
// not given. The second and later files of a repeatable argument are named by RepeatedName.
using StageFiles = std::map<std::string, std::filesystem::path>;

// Name of the file that a repeatable argument gives at `index` (from 0): "sequence", "sequence#1"
// and so on.
inline std::string RepeatedName(const std::string& argument, size_t index) {
  return index == 0 ? argument : argument + "#" + std::to_string(index);
}

// All files of a repeatable argument, in the order given.
inline std::vector<std::filesystem::path> FilesOf(const StageFiles& files,
                                                  const std::string& argument) {
  std::vector<std::filesystem::path> paths;
  for (auto file = files.find(argument); file != files.end();
       file = files.find(RepeatedName(argument, paths.size()))) {
    paths.push_back(file->second);
  }
  return paths;
}

}  // namespace soslam
