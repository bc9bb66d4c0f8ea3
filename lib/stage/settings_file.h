// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace soslam {

// The JSON object in a file that a user writes settings in. Throws SettingsError, naming the file,
// when it cannot be read, is malformed or holds something else.
nlohmann::json ReadSettingsFile(const std::filesystem::path& path);

}  // namespace soslam
