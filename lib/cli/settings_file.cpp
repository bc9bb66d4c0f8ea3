// SPDX-License-Identifier: BSD-3-Clause
#include "cli/settings_file.h"

#include "artefact/json_file.h"
#include "base/error.h"

namespace soslam {
namespace {

// Converts InputError to SettingsError, which has another exit code.
nlohmann::json ParseAsSettings(const std::filesystem::path& path) {
  try {
    return ParseJsonFile(path);
  } catch (const InputError& error) {
    throw SettingsError(error.what());
  }
}

}  // namespace

nlohmann::json ReadSettingsFile(const std::filesystem::path& path) {
  nlohmann::json settings = ParseAsSettings(path);
  if (!settings.is_object()) {
    throw SettingsError(path.string() + ": expected an object of settings, found a JSON " +
                        settings.type_name());
  }
  return settings;
}

}  // namespace soslam
