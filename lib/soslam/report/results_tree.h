// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "soslam/base/description.h"
#include "soslam/model/metric_catalogue.h"
#include "soslam/system/process.h"

namespace soslam {

// The numbers of a sequence.json.
struct DatasetCounts {
  int frames = 0;         // held-out ones included
  int objects = 0;        // true ones that a map should contain
  int round_objects = 0;  // those of them whose yaw has no meaning
};

// Kind of a dataset's boxes.
enum class BoxesOf { kDetector, kSimulation, kLabels };
inline constexpr std::array kBoxesOfNames = {"detector", "simulation", "labels"};
inline constexpr const auto& NamesOf(BoxesOf) { return kBoxesOfNames; }

// The field "about" of pipelines/datasets/<name>.json (schemas/about.schema.json).
struct AboutDataset {
  std::optional<BoxesOf> boxes_of = {};  // none: not said
  std::string boxes = {};
  std::string annotation = {};
  bool partly_annotated = false;
  std::string published = {};
  std::string differs = {};

  bool HasDetectorBoxes() const { return boxes_of == BoxesOf::kDetector; }
};

// A dataset's facts in tables, beside its name.
struct DatasetFacts : AboutDataset {
  std::optional<DatasetCounts> counts = std::nullopt;  // none without a sequence.json
  std::string odometry = {};                           // origin of the pose estimates
};

template <typename Visitor>
void Describe(Visitor& visit, AboutDataset& about) {
  visit.OrAbsent("boxes_of", &about.boxes_of,
                 "kind of boxes; means over all datasets with a detector's boxes "
                 "have rows of their own");
  visit.OrAbsent("boxes", &about.boxes, "whose boxes: names of detectors", kNotEmpty);
  visit.OrAbsent("annotation", &about.annotation, "who measured the objects, and how", kNotEmpty);
  visit.OrAbsent("partly_annotated", &about.partly_annotated,
                 "true: things of the same kinds stand there that nobody has measured");
  visit.OrAbsent("published", &about.published,
                 "dataset of the publication whose rows stand below, where it has another name",
                 kNotEmpty);
  visit.OrAbsent("differs", &about.differs, "in what it differs from that", kNotEmpty);
}

// Reads the field "about" of a file of settings, if it is there and has one. Throws InputError.
void ReadAbout(const std::filesystem::path& settings, DatasetFacts* facts);

// At most so many objects are few: their mean says little of a method.
inline constexpr int kFewObjects = 2;

// Letters for what limits the means of a row over so many objects of the dataset: "p, r"; kNoValue
// if there is nothing. MarksNote says what they mean.
std::string FormatMarks(const DatasetFacts& facts, int objects);
std::string MarksNote();

// In what the dataset differs from the published one of its rows: "9 frames, 4 objects; boxes:
// YOLOX-nano; ...".
std::string DifferencesInWords(const DatasetFacts& facts);

// The runs, <stage>-<key>, that a stages.txt or .linked lists, in its order; empty if the file does
// not exist. Throws InputError for an entry that is not the name of a folder.
std::vector<std::string> RunsIn(const std::filesystem::path& list);

// The stage of a run: "learn-priors" for "learn-priors-0123456789".
std::string StageOf(const std::string& run);

// Error of the last run in a folder: the first line of its file `failed`; empty if it did not fail.
std::string FailureIn(const std::filesystem::path& run_folder);

// The methods that the paper compares, in its order, then the variants that this project adds: the
// same steps with superquadrics.
inline constexpr std::array kKnownVariants = {"SVD",    "Init1-1", "InitP",  "InitPT",    "Quadric",
                                              "OursP",  "OursPT",  "Cube",   "MultiView", "InitS",
                                              "InitST", "InitSTE", "InitSP", "InitSTEP",  "OursS",
                                              "OursST", "OursSTE", "OursSP", "OursSTEP"};
inline constexpr std::span kPaperVariants = std::span(kKnownVariants).first<7>();

// Run time of a stage, from its timing.json.
struct StageTiming {
  std::string stage;
  double peak_memory_mb = 0.0;
  double wall_s = 0.0;
  double cpu_s = 0.0;
  int threads = 1;
  std::optional<Machine> machine;  // none in files from before it was recorded
};

// timing.json.
template <typename Visitor>
void Describe(Visitor& visit, StageTiming& timing) {
  visit.Field("stage", &timing.stage, "name of the executable");
  visit.Field("wall_s", &timing.wall_s, "from start to end", kNotNegative);
  visit.Field("cpu_s", &timing.cpu_s, "of all threads, user and system", kNotNegative);
  visit.Field("peak_memory_mb", &timing.peak_memory_mb, "resident", kNotNegative);
  visit.Field("threads", &timing.threads, "that the stage was allowed", kAtLeastOne);
  visit.OrAbsent("machine", &timing.machine, "that it ran on; absent in older files");
}

// One run of a stage of a variant.
struct StageRun {
  std::string stage;                  // "initialise"
  std::filesystem::path folder;       // <dataset>/shared/<stage>-<key>
  std::optional<StageTiming> timing;  // none without timing.json
};

// <dataset>/<variant>/: a folder with metrics.json, stages.txt or both.
struct VariantResult {
  std::string name;
  std::filesystem::path folder;
  std::optional<Metrics> metrics = {};  // metrics.json, with ids for indices; none without it
  std::vector<StageRun> stages = {};    // in the order in which they run; empty without stages.txt
  // The runs, <stage>-<key>, that produced the other files of the folder; `stages` may be newer.
  std::vector<std::string> shown_runs = {};
  std::string unreadable =
      {};  // error of an invalid metrics.json or timing.json; empty if they are valid
};

// <results>/<dataset>/: at least one variant.
struct DatasetResult {
  std::string name;
  std::vector<VariantResult> variants;  // the paper's in its order, ours, then others by name
  DatasetFacts facts = {};              // empty until ReadFacts

  // The variant with that name if it has metrics, else null.
  const VariantResult* Evaluated(const std::string& variant) const;
};

// The names of the folders in a folder, sorted; empty if the folder does not exist.
std::vector<std::string> ListSubfolders(const std::filesystem::path& folder);

// The dataset's folder at the time when its runs were planned: the first line of shared/dataset.txt
// in its results. Empty without that file.
std::filesystem::path ReadDatasetFolder(const std::filesystem::path& results_of_dataset);

// All datasets in a results folder by name, including those without metrics; empty if the folder
// does not exist. A metrics.json or timing.json that is not valid either leads to an InputError
// that names file and field, or is noted with its variant, which then has neither metrics nor
// stages.
enum class DamagedFiles { kRefused, kNoted };
std::vector<DatasetResult> ReadResults(const std::filesystem::path& results,
                                       DamagedFiles damaged = DamagedFiles::kRefused);

// The facts of the dataset in <results>/<dataset>/: from the sequence.json of the first
// variant that has one, and from <settings>/<dataset>.json; `settings` may be empty. Throws
// InputError.
DatasetFacts ReadFacts(const DatasetResult& dataset, const std::filesystem::path& settings);

// A metric of the objects that have it, by their ids in the dataset. The variant must have metrics.
std::map<int, double> ObjectValues(const VariantResult& variant, const ObjectMetric& metric);

// The reason why the variant's folder does not show the planned results: "failed: refine: exit code
// 3: ..." or "incomplete: refine has not run"; empty if it does, and for folders without
// stages.txt.
std::string WhyUnfinished(const VariantResult& variant);

// True if this stage contributed to the results in the variant's folder: by its list of stages or,
// without one, by the stage's file in it.
bool ShowsStage(const VariantResult& variant, const std::string& stage, const std::string& file);

}  // namespace soslam
