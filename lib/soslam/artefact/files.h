// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "soslam/artefact/json_file.h"
#include "soslam/model/associations.h"
#include "soslam/model/edits.h"
#include "soslam/model/estimates.h"
#include "soslam/model/image_matches.h"
#include "soslam/model/image_turns.h"
#include "soslam/model/map_points.h"
#include "soslam/model/metrics.h"
#include "soslam/model/reconstruction.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"
#include "soslam/model/world.h"

namespace soslam {

// Artefacts of one JSON file each (schemas/<kind>.schema.json), and points.h5 and
// matches.h5. Files refer to
// frames, planes and objects by id. Where nothing else is said, writers throw as WriteArtefact and
// readers as ReadArtefact.

// Whether a reader needs the support planes of a sequence.
enum class PlaneNeed { kNeeded, kNotNeeded };

// Kind "sequence". ReadSequence throws InputError also for a file without the planes that are
// needed.
Sequence ReadSequence(const std::filesystem::path& path, PlaneNeed need = PlaneNeed::kNeeded);
// Writes the sequence with its own findings.
void WriteSequence(const std::filesystem::path& path, const Sequence& sequence,
                   const ArtefactInfo& info);

// Kind "reconstruction".
void WriteReconstruction(const std::filesystem::path& path, const ReconstructionSummary& summary,
                         const ArtefactInfo& info);
Artefact<ReconstructionSummary> ReadReconstruction(const std::filesystem::path& path);

// Writes points.h5 (layout: schemas/hdf5-layout.md) atomically, points and observations in the
// given order. Throws SettingsError when it cannot be written.
void WritePoints(const std::filesystem::path& path, const std::vector<MapPoint>& points,
                 const ArtefactInfo& info);
// The points in file order. Throws InputError when the file is missing, damaged, not of kind
// "points" or too new, when its arrays do not fit each other, or a number is not possible.
std::vector<MapPoint> ReadPoints(const std::filesystem::path& path);

// Writes matches.h5 as WritePoints does points.h5.
void WriteMatches(const std::filesystem::path& path, const ImageMatches& matches,
                  const ArtefactInfo& info);
// Tracks and colours in file order. Throws as ReadPoints, for kind "matches", and for a track with
// fewer than two observations, or whose frame ids do not ascend.
ImageMatches ReadMatches(const std::filesystem::path& path);

// Kinds "associations", "planes", "turns" and "world".
void WriteAssociations(const std::filesystem::path& path, const Associations& associations,
                       const ArtefactInfo& info);
Artefact<Associations> ReadAssociations(const std::filesystem::path& path);
// An edits.json, written by people. Throws InputError.
Edits ReadEdits(const std::filesystem::path& path);
void WritePlanes(const std::filesystem::path& path, const PlanesReport& report,
                 const ArtefactInfo& info);
void WriteTurns(const std::filesystem::path& path, const ImageTurns& turns,
                const ArtefactInfo& info);
Artefact<ImageTurns> ReadTurns(const std::filesystem::path& path);
void WriteWorld(const std::filesystem::path& path, const WorldReport& report,
                const ArtefactInfo& info);
Artefact<WorldReport> ReadWorld(const std::filesystem::path& path);

// A semantic table, written by people or by soslam-learn-priors; written as kind "semantic_table".
SemanticTable ReadSemanticTable(const std::filesystem::path& path);
SemanticRows ReadSemanticRows(const std::filesystem::path& path);
void WriteSemanticRows(const std::filesystem::path& path, const SemanticRows& rows,
                       const ArtefactInfo& info);

// Kind "landmarks": initial.json, refined.json. `sequence` is the one that the estimates belong to.
// ReadLandmarks throws InputError also for a detection that the sequence lacks.
LandmarkEstimates ReadLandmarks(const std::filesystem::path& path, const Sequence& sequence);
void WriteLandmarks(const std::filesystem::path& path, const LandmarkEstimates& estimates,
                    const Sequence& sequence, const ArtefactInfo& info);
// Kind "map". `sequence` is the one that the map was made from. ReadMap throws InputError also for
// an object that the sequence lacks, and for a trajectory that does not have exactly its frames.
MapEstimate ReadMap(const std::filesystem::path& path, const Sequence& sequence);
void WriteMap(const std::filesystem::path& path, const MapEstimate& map, const Sequence& sequence,
              const ArtefactInfo& info);

// Kind "metrics".
void WriteMetrics(const std::filesystem::path& path, const Metrics& metrics,
                  const Sequence& sequence, const ArtefactInfo& info);

// Throws InputError, naming both files, unless an artefact of this kind, JSON or HDF5, was made of
// `input`, a JSON artefact: by the SHA-256 in its header. Where the file that it was made of lies
// beside it, as in results, the message says how the two differ: "border_px: 30.0 -> 0.0". Errors
// also as CheckArtefactHeader.
void CheckWasMadeOf(const std::filesystem::path& artefact, const std::string& kind,
                    const std::filesystem::path& input);

}  // namespace soslam
