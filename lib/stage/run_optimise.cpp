// SPDX-License-Identifier: BSD-3-Clause
#include "stage/run_optimise.h"

#include <fmt/format.h>

#include <algorithm>

#include "artefact/edges_file.h"
#include "artefact/landmarks_file.h"
#include "artefact/map_file.h"
#include "artefact/semantic_table_file.h"
#include "artefact/sequence_file.h"
#include "base/error.h"
#include "mapping/back_end.h"

namespace soslam {
namespace {

void CheckSymmetry(const OptimiseOptions& options, const StageFiles& files) {
  if (!options.symmetry) return;
  if (files.count("edges") == 0) {
    throw SettingsError("symmetry = true needs --edges FILE; found none");
  }
  if (options.symmetry_options.descriptor == Descriptor::kBrief) {
    throw SettingsError("symmetry needs a descriptor with a derivative; found descriptor = brief");
  }
}

// The images of each object's first observation, by detection index.
std::map<int, std::shared_ptr<const SymmetryImage>> FirstObservationImages(
    const Sequence& sequence, const std::filesystem::path& edges_file) {
  EdgesReader edges(edges_file);
  std::map<int, std::shared_ptr<const SymmetryImage>> images;
  for (const std::vector<int>& detections : DetectionsByObject(sequence)) {
    if (detections.empty()) continue;
    const Detection& first = sequence.detections[static_cast<size_t>(detections.front())];
    const int frame_id = sequence.frames[static_cast<size_t>(first.frame_index)].id;
    images[detections.front()] =
        std::make_shared<const SymmetryImage>(edges.Read(frame_id), first.box);
  }
  return images;
}

}  // namespace

void RunOptimise(const OptimiseOptions& options, const StageFiles& files, int /*threads*/) {
  CheckSymmetry(options, files);
  const Sequence sequence = ReadSequence(files.at("sequence"));
  const auto ratios =
      ObjectRatios(sequence, ReadSemanticTable(files.at("table")), options.ratio_prior);
  const LandmarkEstimates estimates = ReadLandmarks(files.at("landmarks"), sequence);
  BackEndInput input{sequence, ChooseStarts(sequence, estimates), ratios, {}};
  if (std::none_of(input.starts.begin(), input.starts.end(),
                   [](const auto& start) { return start.has_value(); })) {
    throw NothingUsableError(files.at("landmarks").string() + ": no landmark to start from");
  }
  ArtefactInfo info = {OptionsToJson(options),
                       {files.at("sequence"), files.at("landmarks"), files.at("table")}};
  if (options.symmetry) {
    input.symmetry_images = FirstObservationImages(sequence, files.at("edges"));
    info.inputs.push_back(files.at("edges"));
  }
  const MapEstimate map = OptimiseMap(input, options);
  WriteMap(files.at("output"), map, sequence, info);
  fmt::print("{} iterations, cost {:.6g} -> {:.6g}{}\n", map.solver.iterations,
             map.solver.initial_cost, map.solver.final_cost,
             map.solver.converged ? "" : ", not converged");
}

}  // namespace soslam
