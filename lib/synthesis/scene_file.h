// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "synthesis/scene.h"

namespace soslam {

// The scene in a JSON document, see schemas/scene.schema.json. Throws InputError, naming `where`
// and the field, when it is not valid or not possible: a duplicate id, an unknown plane, a normal
// that is not of unit length, the camera inside an object, behind a plane or looking straight up or
// down.
Scene ParseScene(const nlohmann::json& document, const std::string& where);

// The scene in a file; throws InputError as above, and when there is no such file.
Scene ReadScene(const std::filesystem::path& path);

}  // namespace soslam
