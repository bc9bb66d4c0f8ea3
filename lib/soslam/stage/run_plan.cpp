// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <set>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/dataset/photo_folder.h"
#include "soslam/dataset/text_file.h"
#include "soslam/stage/stages.h"
#include "soslam/workflow/pipeline_settings.h"
#include "soslam/workflow/plan.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// Refuses names that make cannot handle: it splits lists at spaces and interprets several
// characters, which cannot all be quoted.
void RefuseIfUnfitForMake(const std::string& text, const std::string& what) {
  const bool fit =
      !text.empty() && text.front() != '-' && std::ranges::all_of(text, [](unsigned char c) {
        return std::isalnum(c) || c >= 0x80 ||
               std::string("_-./+@").find(static_cast<char>(c)) != std::string::npos;
      });
  if (!fit) {
    throw SettingsError(fmt::format(
        "{} '{}': expected a name of letters, digits and _ - . / + @ only (no spaces, no - first)",
        what, text));
  }
}

void RefuseIfNotAFolderName(const std::string& name, const std::string& what) {
  RefuseIfUnfitForMake(name, what);
  if (name.find('/') != std::string::npos || name.front() == '.' || name == "shared" ||
      name == "all" || name == "FORCE" || name == kTrunk) {
    throw SettingsError(fmt::format("{} '{}': cannot be the name of a results folder", what, name));
  }
}

// One line per file that changes whenever the file does, without reading it.
std::string Fingerprint(const fs::path& folder, const std::set<std::string>& names) {
  std::string text = fs::canonical(folder).string() + "\n";
  for (const std::string& name : names) {
    std::error_code error;
    const auto size = fs::file_size(folder / name, error);
    if (error) {
      text += name + " missing\n";
      continue;
    }
    const auto time = fs::last_write_time(folder / name).time_since_epoch();
    text += fmt::format("{} {} {}\n", name, size,
                        std::chrono::duration_cast<std::chrono::nanoseconds>(time).count());
  }
  return text;
}

// Files below a dataset folder, independent of its format: tables and lists, and all others, which
// are mostly images.
struct FoundFiles {
  std::set<std::string> tables;
  std::set<std::string> others;
};

FoundFiles FindFiles(const fs::path& dataset) {
  static const std::set<std::string> kTables = {".txt", ".csv", ".json", ".gz",
                                                ".tgz", ".tar", ".zip"};
  FoundFiles found;
  std::error_code error;  // a cycle of symbolic links, or an unreadable folder
  fs::recursive_directory_iterator entries(dataset, fs::directory_options::follow_directory_symlink,
                                           error);
  for (; !error && entries != fs::end(entries); entries.increment(error)) {
    const fs::directory_entry& entry = *entries;
    std::error_code ignored;  // a dangling link is no file
    if (!entry.is_regular_file(ignored)) continue;
    const fs::path extension = entry.path().extension();
    // turns.json tells up, as images do; the import does not read it.
    const bool is_table =
        kTables.contains(extension.string()) && entry.path().filename() != "turns.json";
    (is_table ? found.tables : found.others)
        .insert(entry.path().lexically_relative(dataset).string());
  }
  if (error) {
    throw InputError(
        fmt::format("{}: its files cannot be listed: {}", dataset.string(), error.message()));
  }
  return found;
}

void WriteFile(const fs::path& path, const std::string& text) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) {
    throw SettingsError(
        fmt::format("{}: cannot be made: {}", path.parent_path().string(), error.message()));
  }
  WriteTextFile(path, text);
}

// Option value for the variants planned before; all if there are none.
constexpr const char* kPlanned = "planned";

// Prints the variants that PossibleVariants excludes.
void PrintImpossible(const fs::path& pipelines, const std::string& dataset,
                     const std::vector<std::string>& possible) {
  std::vector<std::string> impossible = VariantNames(pipelines);
  std::erase_if(impossible, [&](const std::string& variant) {
    return std::ranges::find(possible, variant) != possible.end();
  });
  if (impossible.empty()) return;
  fmt::print("{}: no images; left out are {}\n", dataset, fmt::join(impossible, ", "));
}

}  // namespace

std::vector<std::string> PlannedVariants(const fs::path& pipelines, const fs::path& results) {
  std::vector<std::string> variants = VariantNames(pipelines);
  std::erase_if(variants, [&](const std::string& variant) {
    return !Exists(results / variant / "stages.txt");
  });
  return variants;
}

std::vector<std::string> PossibleVariants(const fs::path& pipelines, const std::string& name,
                                          const fs::path& dataset) {
  std::vector<std::string> variants = VariantNames(pipelines);
  if (std::ranges::any_of(FindFiles(dataset).others, HasNameOfImage)) return variants;
  std::erase_if(variants, [&](const std::string& variant) {
    const StageOptions options = ReadVariant(pipelines, name, variant).options;
    return options.contains("edges") || options.contains("match") || options.contains("appearance");
  });
  return variants;
}

std::vector<std::string> SplitAtSpaces(const std::string& text) {
  std::vector<std::string> words;
  for (const std::string_view word : SplitWords(text)) {
    if (std::ranges::find(words, word) == words.end()) words.emplace_back(word);
  }
  return words;
}

void RunPlan(const PlanOptions& options, const StageFiles& files, int /*threads*/) {
  const fs::path dataset = files.at("dataset").lexically_normal();
  if (!IsFolder(dataset)) {
    throw InputError(dataset.string() + ": no such dataset folder");
  }
  const std::string name =
      options.name.empty() ? fs::canonical(dataset).filename().string() : options.name;
  RefuseIfNotAFolderName(name, "dataset");
  for (const auto& [argument, path] : files) {
    if (argument != "edits") RefuseIfUnfitForMake(path.string(), "--" + argument);
  }
  const PlanFolders folders = {dataset, files.at("pipelines"), files.at("results") / name};

  const FoundFiles found = FindFiles(dataset);
  std::vector<std::string> variants = SplitAtSpaces(options.variants);
  if (options.variants == kPlanned) variants = PlannedVariants(folders.pipelines, folders.results);
  if (variants.empty()) {
    variants = PossibleVariants(folders.pipelines, name, dataset);
    PrintImpossible(folders.pipelines, name, variants);
  }
  for (const std::string& variant : variants) RefuseIfNotAFolderName(variant, "variant");

  const fs::path edits = folders.results / kEditsFile;
  const auto given_edits = files.find("edits");
  const bool gives_edits = given_edits != files.end();
  const Plan plan = MakePlan(folders.pipelines, name, variants, gives_edits || Exists(edits));
  if (gives_edits) {
    ReadEdits(given_edits->second);
    const auto is_corrected = [](const StageInstance& instance) {
      return instance.reads_edits && instance.stage == "associate";
    };
    if (std::ranges::none_of(plan.instances, is_corrected)) {
      throw SettingsError(fmt::format(
          "{}: corrects which boxes are of one object, which ids of the dataset give here; "
          "expected "
          "a variant with estimated association, as those of pipelines/raw_boxes, or no edits",
          given_edits->second.string()));
    }
    WriteFile(edits, ReadWholeFile(given_edits->second));
  }
  ReportFindings("plan", plan.findings);
  for (const StageInstance& instance : plan.instances) {
    if (!instance.semantic_table.empty()) {
      RefuseIfUnfitForMake(instance.semantic_table, "setting 'semantic_table'");
    }
    WriteFile(folders.results / InstancePath(instance.Id(), "settings.json"),
              instance.settings.dump(2) + "\n");
  }
  for (const VariantChain& variant : plan.variants) {
    WriteFile(folders.results / variant.name / "stages.txt",
              fmt::format("{}\n", fmt::join(variant.instances, "\n")));
  }
  // Imports depend on the content of tables, and on the existence of images.
  WriteFile(
      folders.results / kDatasetListing,
      Fingerprint(dataset, found.tables) + fmt::format("{}\n", fmt::join(found.others, "\n")));
  WriteFile(folders.results / kImagesListing, Fingerprint(dataset, found.others));
  WriteFile(folders.results / "plan.mk", PlanMakefile(plan, name, folders));
}

}  // namespace soslam
