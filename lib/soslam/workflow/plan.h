// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "soslam/model/finding.h"

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
  bool reads_edits = false;           // kEditsFile of the results
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
  std::vector<Finding> findings;  // of the settings

  const StageInstance& Instance(const std::string& id) const;
};

// Folders of a plan; relative paths are relative to where make runs.
struct PlanFolders {
  std::filesystem::path dataset;
  std::filesystem::path pipelines;
  std::filesystem::path results;           // results of this dataset: <results>/<name>
  std::filesystem::path executables = {};  // programs of the stages; no part of a makefile
};

// The files that a stage instance depends on: executable, settings, input artefacts, listings,
// semantic table.
std::vector<std::filesystem::path> ListPrerequisites(const StageInstance& instance,
                                                     const PlanFolders& folders);

// Path of an artefact or the record of a stage instance, relative to the results of the dataset:
// "shared/refine-c664bee12d/done".
std::string InstancePath(const std::string& instance, const std::string& file);

// Listings of the dataset's files that import reads, and of its images: see RunPlan.
inline constexpr const char* kDatasetListing = "shared/dataset.txt";
inline constexpr const char* kImagesListing = "shared/images.txt";

// Corrections of the association by hand, in the results of the dataset. If it is there,
// association reads it; its content is no part of a key, so that changed edits replace the result.
inline constexpr const char* kEditsFile = "edits.json";

// The stage runs needed by these variants of a dataset. Throws SettingsError as ReadVariant;
// InputError if the semantic table that the settings name does not exist.
Plan MakePlan(const std::filesystem::path& pipelines, const std::string& dataset,
              const std::vector<std::string>& variants, bool has_edits = false);

// Stage instances of a plan that form one job on a cluster.
struct WorkUnit {
  std::string name;                         // "trunk", or the id of the first instance of a branch
  std::vector<std::string> instances = {};  // ids, each after the instances that it reads from
  std::vector<std::string> variants = {};   // variants that are complete when this unit is
  std::vector<std::string> needs = {};      // ids of the trunk's instances that a branch reads from
};

inline constexpr const char* kTrunk = "trunk";

// Splits a plan into the trunk, which all others need, and its branches. A branch begins at a stage
// that can take long (refine, optimise) and continues to the end of all variants that share its
// beginning, so branches do not share instances and can run in parallel. Everything else is the
// trunk: stages that take less time than a job costs, and the edges, which many branches read.
std::vector<WorkUnit> SplitPlan(const Plan& plan);

// Text of the makefile that executes a plan: one goal per variant, "all" first, and one rule per
// stage instance. It needs GNU make >= 4.3; $(BIN) is the folder of the executables, $(LAUNCH) the
// command that starts them ("srun -n1"; may be empty). For clusters there is a goal per work unit,
// listed in $(units), and `before-<unit>`, which is up to date when everything that the unit needs
// from the trunk is.
std::string PlanMakefile(const Plan& plan, const std::string& dataset, const PlanFolders& folders);

// Reads the folders named in a makefile by PlanMakefile. Throws InputError when there is no such
// file, or no folder of settings, which is relative to where the plan was made.
PlanFolders ReadPlanFolders(const std::filesystem::path& makefile);

}  // namespace soslam
