// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "priors/options.h"
#include "stage/stage_files.h"

namespace soslam {

// A semantic table from data: files "base" (a table), "furniture" with "furniture_labels",
// "sequence" and "held_out" (any number, with ground truth), all optional; "output". Prints how
// well the table predicts the objects of the sequences that are held out; catalogue models that are
// such objects are not learned from. Throws NothingUsableError when there is not one row.
void RunLearnPriors(const LearnPriorsOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
