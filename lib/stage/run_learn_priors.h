// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "cli/stage_files.h"
#include "priors/options.h"

namespace soslam {

// soslam-learn-priors: learns a semantic table from data: files "base" (a table), "furniture" with
// "furniture_labels", "sequence" and "held_out" (any number, with ground truth), all optional;
// "output". Prints how well the table predicts the objects of the held-out sequences; catalogue
// models of these objects are excluded from learning. Throws NothingUsableError when the table has
// no row.
void RunLearnPriors(const LearnPriorsOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
