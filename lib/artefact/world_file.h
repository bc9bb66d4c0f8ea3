// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "artefact/json_file.h"
#include "ground/estimate_ground.h"
#include "ground/ground_checks.h"
#include "model/sequence.h"

namespace soslam {

// Writes world.json (kind "world", schemas/world.schema.json). Errors as WriteArtefact.
void WriteWorld(const std::filesystem::path& path, const GroundEstimate& estimate,
                const Sequence& input, const ArtefactInfo& info);

// The scale of a world.json that was read; none where it is unknown.
std::optional<WorldScale> ScaleOfWorld(const nlohmann::json& world);

// Why up may be wrong by more than its standard deviation, in words; empty where nothing says so.
std::string DoubtOfUp(const nlohmann::json& world);

// True if the lengths of a sequence without a world.json are in metres.
inline bool IsInMetresWithoutWorld(const Sequence& sequence) {
  return sequence.odometry_world != OdometryWorld::kOwnWithScale;
}

}  // namespace soslam
