// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/cli/command_line.h"
#include "soslam/dataset/dataset_content.h"
#include "soslam/dataset/gate.h"
#include "soslam/dataset/import_options.h"
#include "soslam/priors/furniture_catalogue.h"
#include "soslam/priors/learn_priors.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"
#include "soslam/synthesis/scene.h"
#include "soslam/synthesis/simulate.h"
#include "soslam/system/run_log.h"

namespace soslam {
void RunImport(const ImportOptions& options, const StageFiles& files, int threads) {
  const auto& folder = files.at("dataset");
  std::vector<std::filesystem::path> inputs;
  Sequence sequence = ImportDataset(folder, options, &inputs);
  if (options.scene_axes) AddSceneAxes(folder, threads, &sequence, &inputs);
  // Findings of soslam-reconstruct when it made the poses of the dataset, and images to which it
  // gave none. Other programs have files of that name as well.
  const std::filesystem::path reconstructed = folder / "reconstruction.json";
  if (Exists(reconstructed) && options.folder.trajectory_format == TrajectoryFormat::kTum &&
      ParseJsonFile(reconstructed).contains("artefact")) {
    Artefact<ReconstructionSummary> reconstruction = ReadReconstruction(reconstructed);
    std::ranges::move(reconstruction.findings, std::back_inserter(sequence.findings));
    sequence.images_without_pose = std::move(reconstruction.body.images_without_pose);
    sequence.findings = WorstFirst(std::move(sequence.findings));
    inputs.push_back(reconstructed);
  }
  ReportFindings("import", sequence.findings);
  WriteSequence(files.at("output"), sequence, {OptionsToJson(options), inputs, {}, "import"});
  fmt::print("{}: {} frames, {} objects, {} detections used, {}\n", sequence.name,
             sequence.frames.size(), sequence.objects.size(), sequence.detections.size(),
             DescribeRejections(sequence.rejected_detections));
}

void RunSynthesise(const SynthesiseOptions& options, const StageFiles& files, int threads) {
  const std::filesystem::path& path = files.at("scene");
  Scene scene = ReadScene(path);
  if (options.seed >= 0) scene.seed = options.seed;
  NoteSeed(scene.seed);
  if (Simulate(scene, options.noise).detections.empty()) {
    throw NothingUsableError(path.string() +
                             ": no object is detected in any frame; expected objects in sight, "
                             "as the scene's boxes and min_visible_share ask for");
  }
  WriteDataset(scene, options.noise, files.at("output"), threads);
}

namespace {

std::vector<Sequence> ReadSequences(const std::vector<std::filesystem::path>& paths) {
  std::vector<Sequence> sequences;
  for (const std::filesystem::path& path : paths) sequences.push_back(ReadSequence(path));
  return sequences;
}

void PrintErrors(const Sequence& sequence, const SemanticTable& table) {
  double absolute = 0.0;
  double squared = 0.0;
  const std::vector<PriorError> errors = PriorErrors(sequence, table);
  for (const PriorError& error : errors) {
    fmt::print("{}: {}: log error {:.2f} {:.2f}, in sigmas {:.2f} {:.2f}{}\n", sequence.name,
               error.label, error.log_error.x(), error.log_error.y(), error.normalised.x(),
               error.normalised.y(), table.Contains(error.label) ? "" : " (default)");
    absolute += error.log_error.cwiseAbs().mean();
    squared += error.normalised.squaredNorm() / 2.0;
  }
  const auto count = static_cast<double>(errors.size());
  fmt::print("{}: {} of {} objects predicted", sequence.name, errors.size(),
             sequence.objects.size());
  if (!errors.empty()) {
    fmt::print(", mean absolute log error {:.3f}, root mean square {:.2f} sigmas", absolute / count,
               std::sqrt(squared / count));
  }
  fmt::print("\n");
}

}  // namespace

void RunLearnPriors(const LearnPriorsOptions& options, const StageFiles& files, int /*threads*/) {
  if (files.count("furniture") != files.count("furniture_labels")) {
    throw SettingsError("found one of --furniture and --furniture_labels; expected both or none");
  }
  const std::vector<std::filesystem::path> sequence_files = FilesOf(files, "sequence");
  const std::vector<std::filesystem::path> held_out_files = FilesOf(files, "held_out");
  const std::vector<Sequence> sequences = ReadSequences(sequence_files);
  const std::vector<Sequence> held_out = ReadSequences(held_out_files);
  for (const Sequence& sequence : held_out) {
    if (std::ranges::find(sequences, sequence.name, &Sequence::name) == sequences.end()) continue;
    throw SettingsError(
        fmt::format("sequence '{}' is given as --sequence and as --held_out; expected one of them",
                    sequence.name));
  }

  SemanticRows base;
  if (files.contains("base")) base = ReadSemanticRows(files.at("base"));
  const SemanticTable base_table = LookUpTable(base);
  std::vector<PriorSource> sources;
  if (files.contains("furniture")) {
    const std::string catalogue = files.at("furniture").filename().string();
    std::vector<CatalogueModel> models = ReadFurnitureCatalogue(files.at("furniture"));
    const size_t all = models.size();
    for (const Sequence& sequence : held_out) {
      models = ExcludeObjects(sequence, base_table, std::move(models));
    }
    fmt::print("{}: {} models, {} left out as objects of sequences that are held out\n", catalogue,
               all, all - models.size());
    sources.push_back(
        SourceOfCatalogue(catalogue, models, ReadCatalogueNames(files.at("furniture_labels"))));
  }
  for (const Sequence& sequence : sequences) {
    sources.push_back(SourceOfSequence(sequence, base_table, options.min_views));
  }
  SemanticRows learned = LearnPriors(base, sources, options);
  if (options.edge_bias) LearnEdgeBias(sequences, options.no_bias_weight, &learned);
  if (learned.rows.empty()) {
    throw NothingUsableError("no label: neither base table nor ground truth nor furniture has one");
  }

  ArtefactInfo info = {
      .settings = OptionsToJson(options), .inputs = sequence_files, .stage = "learn-priors"};
  for (const char* name : {"base", "furniture", "furniture_labels"}) {
    if (files.contains(name)) info.inputs.push_back(files.at(name));
  }
  info.inputs.insert(info.inputs.end(), held_out_files.begin(), held_out_files.end());
  WriteSemanticRows(files.at("output"), learned, info);
  for (const Sequence& sequence : held_out) PrintErrors(sequence, LookUpTable(learned));
  fmt::print("{} labels\n", learned.rows.size());
}

}  // namespace soslam
