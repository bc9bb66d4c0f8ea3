// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "cli/stage_files.h"

namespace soslam {

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

}  // namespace soslam
