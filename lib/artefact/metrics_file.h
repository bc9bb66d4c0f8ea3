// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

#include "artefact/json_file.h"
#include "evaluation/map_quality.h"
#include "evaluation/metrics.h"
#include "model/sequence.h"

namespace soslam {

// Writes metrics.json (kind "metrics", schemas/metrics.schema.json).
void WriteMetrics(const std::filesystem::path& path, const Metrics& metrics,
                  const Sequence& sequence, const ArtefactInfo& info);

}  // namespace soslam
