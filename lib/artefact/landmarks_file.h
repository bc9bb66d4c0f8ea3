// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "artefact/json_file.h"
#include "model/estimates.h"
#include "model/sequence.h"

namespace soslam {

// The artefact of kind "landmarks": initial.json, refined.json. `sequence` is the one that the
// estimates belong to; files refer to its frames and objects by id. ReadLandmarks throws InputError
// for a file that is not valid or refers to a detection that the sequence lacks.
LandmarkEstimates ReadLandmarks(const std::filesystem::path& path, const Sequence& sequence);
// Errors as WriteArtefact.
void WriteLandmarks(const std::filesystem::path& path, const LandmarkEstimates& estimates,
                    const Sequence& sequence, const ArtefactInfo& info);

// The artefact of kind "map". `sequence` is the one that the map was made from; files refer to its
// frames and objects by id. Throws InputError for a file that is not valid, refers to an object
// that the sequence lacks, or whose trajectory does not have exactly the sequence's frames.
MapEstimate ReadMap(const std::filesystem::path& path, const Sequence& sequence);
// Errors as WriteArtefact.
void WriteMap(const std::filesystem::path& path, const MapEstimate& map, const Sequence& sequence,
              const ArtefactInfo& info);

// Number of observations and objects with a failure, per reason.
std::map<std::string, int> CountFailures(const LandmarkEstimates& estimates);

}  // namespace soslam
