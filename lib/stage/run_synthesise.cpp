// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_synthesise.h"

#include "base/error.h"
#include "base/run_log.h"
#include "synthesis/scene_file.h"
#include "synthesis/simulate.h"
#include "synthesis/write_dataset.h"

namespace soslam {

void RunSynthesise(const SynthesiseOptions& options, const StageFiles& files, int threads) {
  const std::filesystem::path& path = files.at("scene");
  Scene scene = ReadScene(path);
  if (options.seed >= 0) scene.seed = options.seed;
  NoteSeed(scene.seed);
  if (Simulate(scene, options.noise).detections.empty()) {
    throw NothingUsableError(path.string() +
                             ": no object is detected in any frame; expected objects wholly inside "
                             "the image with their centre in sight");
  }
  WriteDataset(scene, options.noise, files.at("output"), threads);
}

}  // namespace soslam
