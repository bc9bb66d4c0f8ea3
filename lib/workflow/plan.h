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

// One run of a stage with certain settings and inputs. Variants with equal settings and inputs
// share it.
struct StageInstance {
  std::string stage;
  // First 10 hex digits of a SHA-256 over stage, settings and the keys of its inputs; independent
  // of where files are stored.
  std::string key;
  nlohmann::json settings;                       // every option, resolved
  std::map<std::string, ArtefactSource> inputs;  // keyed by argument of the stage: "landmarks"
  std::string semantic_table;         // relative to the pipelines folder; empty: not read
  std::vector<std::string> variants;  // variants that use it

  std::string Id() const { return stage + "-" + key; }
};

struct VariantChain {
  std::string name;
  std::vector<std::string> instances;  // ids, in order of execution
};

struct Plan {
  std::vector<StageInstance> instances;  // each after the instances that it reads from
  std::vector<VariantChain> variants;

  const StageInstance& Instance(const std::string& id) const;
};

// An output of a stage: argument name and file name. OutputsOfStage is empty for programs that are
// not stages of a plan.
struct StageOutput {
  std::string argument;
  std::string file;
};
const std::vector<StageOutput>& OutputsOfStage(const std::string& stage);

// True for stages that get the dataset's folder.
bool ReadsDataset(const std::string& stage);

// A file that a stage instance depends on: executable, settings, input artefact, listing or
// semantic table.
struct Prerequisite {
  enum class Folder { kExecutables, kPipelines, kResults };  // kResults: results of this dataset
  Folder folder;
  std::string path;  // relative to it
};
std::vector<Prerequisite> PrerequisitesOf(const StageInstance& instance);

// Path of an artefact or the record of a stage instance, relative to the results of the dataset:
// "shared/refine-c664bee12d/done".
std::string InstancePath(const std::string& instance, const std::string& file);

// Listings of the dataset's files that import reads, and of its images: see RunPlan.
inline constexpr const char* kDatasetListing = "shared/dataset.txt";
inline constexpr const char* kImagesListing = "shared/images.txt";

// The stage runs needed by these variants of a dataset. Throws SettingsError as ReadVariant.
Plan MakePlan(const std::filesystem::path& pipelines, const std::string& dataset,
              const std::vector<std::string>& variants);

}  // namespace soslam
