// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "evaluation/alignment.h"
#include "mapping/options.h"

namespace soslam {

// soslam-optimise: initial.json or refined.json to map.json: files "sequence", "landmarks",
// "table", "output" and, for symmetry, "edges". Throws SettingsError when symmetry is on without
// edges or with a descriptor that has no derivative, NothingUsableError when no object has an
// initial guess.
void RunOptimise(const OptimiseOptions& options, const StageFiles& files, int threads);

// soslam-evaluate: evaluates any landmarks artefact (initial.json, refined.json, map.json) and
// writes metrics.json: files "sequence", "landmarks", "output". Without ground truth the summary
// has 0 objects and no numbers.
void RunEvaluate(const EvaluateOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
