// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "artefact/json_file.h"
#include "model/sequence.h"
#include "planes/planes_estimate.h"

namespace soslam {

// A plane as in planes.json, without its id and error. `tilt_variance` (rad^2) is added to the tilt
// of the covariance.
nlohmann::json PlaneToJson(const EstimatedPlane& plane, double tilt_variance);

// Writes planes.json (kind "planes", schemas/planes.schema.json). `given`: the sequence that the
// planes were estimated from, with its given planes. Errors as WriteArtefact.
void WritePlanes(const std::filesystem::path& path, const PlanesEstimate& estimate,
                 const Sequence& given, const ArtefactInfo& info);

}  // namespace soslam
