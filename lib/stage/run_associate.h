// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "association/options.h"
#include "stage/stage_files.h"

namespace soslam {

// Finds out which detections are of the same object. Files: "sequence", sequence.json, whose
// objects and ids are not looked at but to say how well they agree; "table", the semantic table;
// "output", the sequence with the objects found, to write; "associations", associations.json to
// write: what was decided and why. Throws InputError; NothingUsableError when no object is found;
// SettingsError, also when the setting `association` is `given`.
void RunAssociate(const AssociateOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
