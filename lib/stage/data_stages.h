// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "cli/stage_files.h"
#include "dataset/import_options.h"
#include "priors/learn_priors.h"

namespace soslam {

// soslam-import: reads the folder "dataset", writes the sequence artefact "output" and prints a
// one-line summary of how much is used. Errors as ImportDataset and WriteSequence.
void RunImport(const ImportOptions& options, const StageFiles& files, int threads);

struct SynthesiseOptions {
  bool noise = true;
  int seed = -1;

  void Describe(OptionVisitor& visit) {
    visit.Group("Noise");
    visit.Flag("noise", &noise, "add the scene's noise; without it every measurement is exact");
    visit.Integer("seed", &seed, {-1, 2147483647}, "seed of the noise; -1: the scene's own");
  }
};

// soslam-synthesise: creates the dataset folder "output" from the scene description in file
// "scene", see WriteDataset. Throws InputError for a scene that is not valid, SettingsError for a
// folder that must not be replaced, and NothingUsableError when no object is detected in any frame.
void RunSynthesise(const SynthesiseOptions& options, const StageFiles& files, int threads);

// soslam-learn-priors: learns a semantic table from data: files "base" (a table), "furniture" with
// "furniture_labels", "sequence" and "held_out" (any number, with ground truth), all optional;
// "output". Prints how well the table predicts the objects of the held-out sequences; catalogue
// models of these objects are excluded from learning. Throws NothingUsableError when the table has
// no row.
void RunLearnPriors(const LearnPriorsOptions& options, const StageFiles& files, int threads);

}  // namespace soslam
