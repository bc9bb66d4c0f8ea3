// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace soslam {

// The files a stage was called with, by argument name; absent when an optional one was not given.
using StageFiles = std::map<std::string, std::filesystem::path>;

}  // namespace soslam
