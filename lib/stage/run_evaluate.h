// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "evaluation/options.h"

namespace soslam {

// soslam-evaluate: evaluates any landmarks artefact (initial.json, refined.json, map.json) and
// writes metrics.json: files "sequence", "landmarks", "output". Without ground truth the summary
// has 0 objects and no numbers.
void RunEvaluate(const EvaluateOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
