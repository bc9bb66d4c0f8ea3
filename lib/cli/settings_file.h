// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace soslam {

// Reads a settings file written by a user, a JSON object. Throws SettingsError, naming the file,
// when it cannot be read, is malformed or is not an object.
nlohmann::json ReadSettingsFile(const std::filesystem::path& path);

}  // namespace soslam
