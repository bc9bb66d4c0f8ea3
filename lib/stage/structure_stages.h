// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "association/options.h"
#include "cli/stage_files.h"
#include "planes/options.h"

namespace soslam {

// soslam-associate: estimates which detections belong to the same object. Files: "sequence",
// sequence.json, whose objects and ids are used only to measure the agreement; "table", the
// semantic table; "output", the sequence with the estimated objects, to write; "associations",
// associations.json to write: all decisions and their reasons. Throws InputError;
// NothingUsableError when no object is found; SettingsError, also when the setting `association` is
// `given`.
void RunAssociate(const AssociateOptions& options, const StageFiles& files, int threads);

// soslam-planes: files "sequence", "table" and, with verticals, the images of folder "dataset" to
// "output", the sequence with estimated planes, and "report", planes.json. Throws SettingsError for
// planes = given and for verticals without a dataset, InputError for estimated planes of several
// segments, NothingUsableError as EstimatePlanes, and when no object is on a plane.
void RunPlanes(const PlanesOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
