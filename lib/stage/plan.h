// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace soslam {

// An artefact of a stage instance.
struct ArtefactSource {
  std::string instance;  // StageInstance::Id()
  std::string file;      // "initial.json"
};

// One run of a stage with certain settings on certain inputs. Variants that agree in both share it.
struct StageInstance {
  std::string stage;
  // First 10 hex digits of a SHA-256 over stage, settings and the keys of its inputs; it does not
  // depend on where files lie.
  std::string key;
  nlohmann::json settings;                       // every option, resolved
  std::map<std::string, ArtefactSource> inputs;  // by argument of the stage: "landmarks"
  std::string semantic_table;         // relative to the pipelines folder; empty: not read
  std::vector<std::string> variants;  // that use it

  std::string Id() const { return stage + "-" + key; }
};

struct VariantChain {
  std::string name;
  std::vector<std::string> instances;  // ids, in the order in which they run
};

struct Plan {
  std::vector<StageInstance> instances;  // each after those that it reads from
  std::vector<VariantChain> variants;

  const StageInstance& Instance(const std::string& id) const;
};

// What a stage writes: argument name and file name. None for programs that are no stage of a plan.
struct StageOutput {
  std::string argument;
  std::string file;
};
const std::vector<StageOutput>& OutputsOfStage(const std::string& stage);

// A file that a stage instance is made from.
struct Prerequisite {
  enum class Folder { kExecutables, kPipelines, kResults };  // the last one of this dataset
  Folder folder;
  std::string path;  // relative to it
};
std::vector<Prerequisite> PrerequisitesOf(const StageInstance& instance);

// Where the artefacts and the record of a stage instance lie, relative to the results of the
// dataset: "shared/refine-c664bee12d/done".
std::string InstancePath(const std::string& instance, const std::string& file);

// What lists the files of the dataset that import reads, and its images: see RunPlan.
inline constexpr const char* kDatasetListing = "shared/dataset.txt";
inline constexpr const char* kImagesListing = "shared/images.txt";

// The stage runs that these variants of a dataset need. Throws SettingsError as ReadVariant.
Plan MakePlan(const std::filesystem::path& pipelines, const std::string& dataset,
              const std::vector<std::string>& variants);

}  // namespace soslam
