// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "soslam/base/options.h"
#include "soslam/cli/command_line.h"
#include "soslam/inspection/overlay.h"

namespace soslam {

// Options of the stages, each beside the code that it configures.
struct AssociateOptions;
struct DetectorOptions;
struct EdgesOptions;
struct EvaluateOptions;
struct FrameOptions;
struct GroundOptions;
struct ImportOptions;
struct InitialiseOptions;
struct LearnPriorsOptions;
struct MatchOptions;
struct OptimiseOptions;
struct OrientationOptions;
struct PlanesOptions;
struct ReconstructOptions;
struct TrackOptions;
struct TrainingCropsOptions;

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

// soslam-appearance: writes what the inner layers of "network" and the "head" on them say of each
// box in the images of "dataset". Throws InputError, also for a head of another network.
void RunAppearance(const NoOptions& options, const StageFiles& files, int threads);

// soslam-training-crops: renders models of "groups" from "furniture" and writes to "output" what
// "network" says of the crops. Throws InputError.
void RunTrainingCrops(const TrainingCropsOptions& options, const StageFiles& files, int threads);

// soslam-frames: chooses frames from "images", a folder of photos or a video, and writes the
// dataset folder "output": rgb/, rgb.txt, frames.json and README.md. With "detections", a
// detections.csv for all images, the folder also has that of the chosen ones. Prints how many are
// chosen, and how many are left out for which reason. Throws InputError for a bad folder or video,
// or boxes of none of the images, SettingsError for a folder that must not be replaced, and
// NothingUsableError if fewer than two frames remain.
void RunFrames(const FrameOptions& options, const StageFiles& files, int threads);

// soslam-truth: the ground truth of photos, by that of the folder "truth", a dataset with true
// poses and objects whose images have the names of these photos. Files: "dataset", the folder that
// soslam-frames wrote; "output", a folder for groundtruth.txt and objects.json. Photos that have no
// image of their name there have no true pose. Prints a one-line summary. Throws InputError for bad
// files, frames of a video, and fewer than three photos with a true pose.
void RunTruth(const NoOptions& options, const StageFiles& files, int threads);

// The classes of a network as the options rename, select and group them, from class 0 on.
struct DetectorLabels {
  std::vector<std::string> names;
  std::vector<bool> are_kept;
  std::vector<int> groups;  // classes of one group count as one for max_overlap
};

// Applies rename_labels, keep_labels, interchangeable_labels and class_agnostic to the names of the
// network's classes. Throws SettingsError for malformed options and for labels that no class has.
DetectorLabels LabelsForDetector(std::vector<std::string> classes, const DetectorOptions& options);

// soslam-detect: runs a detector network on every image of a dataset. Files: "dataset", the folder
// with rgb.txt; "network", ONNX; "labels" (optional), the names of its classes, one per line:
// without it those in the network's file, or COCO's; "output", a detections.csv without object ids,
// with its provenance as comments above the header. Prints the format that the network was found to
// have, and a one-line summary. Throws SettingsError for a
// backend that is not there and for what must be set; InputError for a bad list, image, network or
// label file, and for a network whose boxes cannot be; NothingUsableError when nothing was
// detected.
void RunDetect(const DetectorOptions& options, const StageFiles& files, int threads);

// soslam-reconstruct: poses, calibration and sparse points by structure from motion. Files:
// "dataset", a folder with rgb.txt, the images and what is given; "model" (optional), a finished
// model of COLMAP, which does not run then; "output", the folder for camera.json, odometry.txt,
// points.h5 and reconstruction.json, usually the same as "dataset", where COLMAP's own files are in
// colmap/. A model whose points no image shows gets those of soslam-track. What is given is not
// changed. Prints a one-line summary. Throws SettingsError when
// COLMAP is missing, and when poses of another source would be replaced; InputError for bad files,
// fewer than two images, and images of several sizes; NothingUsableError when no image has
// features, or nothing was triangulated; NumericalError when no two images make a model.
void RunReconstruct(const ReconstructOptions& options, const StageFiles& files, int threads);

// soslam-track: sparse points from features that are followed through the images, triangulated from
// the frames' poses, which stay as they are. Files: "dataset", the folder of the frames' images;
// "sequence", sequence.json; "output", points.h5, whose world is that of the sequence's poses.
// Prints a one-line summary. Where no track gives a point, the file is empty, with a warning.
// Throws InputError for a bad image, NothingUsableError when no frame has an image.
void RunTrack(const TrackOptions& options, const StageFiles& files, int threads);

// soslam-match: points that several images show, also images far apart: features that lie on each
// other's epipolar lines by the frames' poses, and look alike. Files: "dataset", the folder of the
// frames' images; "sequence", sequence.json; "output", matches.h5. Prints a one-line summary. Where
// no two images share a point, the file is empty, with a warning. Throws as RunTrack.
void RunMatch(const MatchOptions& options, const StageFiles& files, int threads);

// soslam-edges: computes the edge maps of the undistorted image of every frame. Files: "dataset",
// the folder of the frames' images; "sequence", sequence.json; "output", edges.h5. Throws
// InputError for an image that is missing, damaged, outside the dataset folder or not of the
// camera's size; NothingUsableError when no frame has an image; SettingsError.
void RunEdges(const EdgesOptions& options, const StageFiles& files, int threads);

// soslam-associate: estimates which detections belong to the same object. Files: "sequence",
// sequence.json, whose objects and ids are used only to measure the agreement; "table", the
// semantic table; "matches" (optional), matches.h5; "output", the sequence with the estimated
// objects, to write; "associations", associations.json to write: all decisions and their reasons.
// Throws InputError; NothingUsableError when no object is found; SettingsError, also when the
// setting `association` is `given`.
void RunAssociate(const AssociateOptions& options, const StageFiles& files, int threads);

// soslam-planes: files "sequence", "table" and, with verticals, the images of folder "dataset" to
// "output", the sequence with estimated planes, and "report", planes.json. Throws SettingsError for
// planes = given and for verticals without a dataset, InputError for estimated planes of several
// segments, NothingUsableError when no plane is found or no object is on one.
void RunPlanes(const PlanesOptions& options, const StageFiles& files, int threads);

// soslam-ground: files "sequence", "points" (points.h5), "table" and, with verticals, the images of
// folder "dataset" to "output", the sequence with z up, in metres, with support planes, and
// "world", world.json. Throws InputError for several segments, NothingUsableError without frames,
// SettingsError for verticals without a dataset.
void RunGround(const GroundOptions& options, const StageFiles& files, int threads);

// soslam-initialise: sequence.json and the semantic table, for CubeSLAM's cuboids also edges.h5,
// with point_evidence points.h5, to initial.json: files "sequence", "table", "edges" and "points"
// (optional), "output". Throws SettingsError when a file is missing that the settings need,
// InputError for edges or points of another sequence, NothingUsableError when no observation gave a
// landmark.
void RunInitialise(const InitialiseOptions& options, const StageFiles& files, int threads);

// soslam-refine: initial.json and edges.h5, with point_evidence also points.h5, to refined.json and
// symmetry.h5: files "sequence", "table", "initial", "edges", "points" (optional), "output",
// "curves". Throws SettingsError for a descriptor that does not go with mirror_plane_range, and
// without points that the settings need; InputError as RunInitialise; NothingUsableError when
// initial.json has no single-frame landmarks.
void RunRefine(const OrientationOptions& options, const StageFiles& files, int threads);

// soslam-optimise: initial.json or refined.json to map.json: files "sequence", "landmarks",
// "table", "output", for symmetry and edge_alignment "edges", for point_evidence "points". Throws
// SettingsError when a file is missing that the settings need, or symmetry has a descriptor without
// derivative; InputError as RunInitialise; NothingUsableError when no object has an initial guess.
void RunOptimise(const OptimiseOptions& options, const StageFiles& files, int threads);

// soslam-evaluate: evaluates any landmarks artefact (initial.json, refined.json, map.json) and
// writes metrics.json: files "sequence", "landmarks", "output". Without ground truth the summary
// has 0 objects and no numbers.
void RunEvaluate(const EvaluateOptions& options, const StageFiles& files, int threads);

struct ExportOptions {
  bool truth = false;
  bool aligned = false;

  void Describe(OptionVisitor& visit) {
    visit.Group("Objects");
    visit.Flag("truth", &truth,
               "Export the ground truth of the sequence, poses and objects, in place of a map");
    visit.Flag("aligned", &aligned,
               "Write the map where its evaluation moves it, into the world of the ground truth");
  }
};

// soslam-export: writes "sequence" and, unless truth is set, "map" (with its evaluation "metrics")
// to one or more of "trajectory", "ply", "gltf", "coco", "coco_dataset", "csv", "boxes", the folder
// "colmap", "transforms" and the folder "overlays". Without a map, only the sequence's own poses
// are exported. Of "points", "colmap" has those that its poses place; with the images of folder
// "dataset" they have colours, "transforms" has the way to the images, and "overlays" shows them.
// With several segments, each in its own world, all but tables of the whole sequence ("coco",
// "coco_dataset", "csv") and "overlays" become one file or folder per segment, map-3.ply. Throws
// SettingsError without an output, for objects without a map or truth, for both, for points without
// "colmap", for overlays without "dataset", and for an extension that glTF does not have;
// NothingUsableError when there is no pose, image or landmark to write; InputError for images and
// points as their readers. Nothing is written in these cases, but for overlays before an image that
// cannot be read.
void RunExport(const ExportOptions& options, const StageFiles& files, int threads);

// A report always contains all datasets and variants, so that reports of different runs can be
// compared.
struct ReportOptions {
  std::string compare =
      "InitP InitS, InitPT InitSTE, InitS InitST InitSTE InitSTEP, OursP OursS, OursPT OursSTE, "
      "OursS OursST OursSTE OursSTEP";
  std::string maps = "OursS OursSTE OursS-raw OursSTE-raw OursS-raw-planes OursSTE-raw-planes";
  std::string what_if = "InitSTE MultiView OursS OursSTE";

  void Describe(OptionVisitor& visit) {
    visit.Group("Tables");
    visit.Text("compare", &compare,
               "paired differences: lists of variants, divided by commas; in each list, every "
               "variant is compared with those before it");
    visit.Text("maps", &maps,
               "variants whose maps are compared with all true objects in tables over all "
               "datasets: what is right, what is missed or false and why, what limits the rest");
    visit.Text("what_if", &what_if,
               "variants in the table of what IoU would be with one thing of each landmark "
               "replaced by the true one");
  }
};

// Collects <dataset>/<variant>/metrics.json and the timing.json of the stages from folder "results"
// into tables: those of the paper, beside the values in file "published" if there is one; paired
// differences between variants; maps over all datasets; and all metrics of each dataset. Folder
// "datasets" has the settings of the datasets, which say what tables are to say of them. Prints the
// tables and writes them to file "output" as Markdown, and each to the folder "tables" beside it as
// CSV and LaTeX; renews the tables in file "page" if there is one. Throws NothingUsableError when
// there are no metrics at all, InputError for a file that is not valid, SettingsError for invalid
// comparisons.
void RunReport(const ReportOptions& options, const StageFiles& files, int threads);

// soslam-pages: writes <results>/<dataset>/report.html for each dataset with results to show, and
// <results>/report.html with all of them, each of at most kMaxPageBytes. Files: "results". Images
// are read from the datasets if these still exist. Results that are unreadable or planned but
// incomplete are listed on the pages and on stderr. Throws NothingUsableError when there is nothing
// to show.
void RunPages(const NoOptions& options, const StageFiles& files, int threads);

struct PlanOptions {
  std::string name;
  std::string variants;

  void Describe(OptionVisitor& visit) {
    visit.Group("Plan");
    visit.Text("name", &name, "name of the dataset in results and settings; empty: its folder's");
    visit.Text("variants", &variants,
               "names of variants, separated by spaces; planned: those that were planned before; "
               "empty: all");
  }
};

// Words of a list of names, without duplicates.
std::vector<std::string> SplitAtSpaces(const std::string& text);

// All variants defined in folder `pipelines`; if the dataset `name` in folder `dataset` has no
// images, only variants that do not use images. Errors as RunPlan.
std::vector<std::string> PossibleVariants(const std::filesystem::path& pipelines,
                                          const std::string& name,
                                          const std::filesystem::path& dataset);

// Variants of folder `pipelines` that have been planned in the results folder of a dataset.
std::vector<std::string> PlannedVariants(const std::filesystem::path& pipelines,
                                         const std::filesystem::path& results);

// soslam-plan: resolves the variants that folder "pipelines" defines for the dataset in folder
// "dataset". Writes under <results>/<name>, each only when its content changes: plan.mk, see
// PlanMakefile; shared/<stage>-<key>/settings.json; shared/dataset.txt and shared/images.txt, which
// list the dataset's files with size and time; and <variant>/stages.txt. Prints the findings of the
// plan. Throws InputError when there is no such dataset; as MakePlan; SettingsError for a path with
// characters that make cannot handle.
void RunPlan(const PlanOptions& options, const StageFiles& files, int threads);

struct StatusOptions {
  std::string name;
  std::string variants;
  std::string explain;

  void Describe(OptionVisitor& visit) {
    visit.Group("Status");
    visit.Text("name", &name, "name of the dataset in results; empty: all that were planned");
    visit.Text("variants", &variants, "names of variants, separated by spaces; empty: all");
    visit.Text("explain", &explain,
               "a stage: says why it would run again; empty: a table of all stages");
  }
};

// soslam-status: plans the datasets in folder "results" again, and prints which stages of which
// variants are done, stale, failed or missing, or why one stage would run. "executables" is the
// folder of the stages' programs; "under_way", if given, lists queued and running stages, see
// ReadStagesUnderWay. Throws InputError when that dataset was never planned; SettingsError for an
// unknown variant or stage, and as RunPlan.
void RunStatus(const StatusOptions& options, const StageFiles& files, int threads);

struct DoctorOptions {
  std::string name;

  void Describe(OptionVisitor& visit) {
    visit.Group("Doctor");
    visit.Text("name", &name, "name of the dataset in results");
  }
};

// Prints the findings of all completed stages of a dataset in folder "results", and the errors of
// failed ones: worst first, each with its likely cause and remedy. The exit code is kFindings when
// there is an error. Throws InputError when nothing was planned for the dataset; SettingsError as
// MakePlan.
int RunDoctor(const DoctorOptions& options, const StageFiles& files, int threads);

// soslam-verify: prints which files of folder "results" differ from their run.json, one line each,
// and a table of all datasets. Datasets are in folder "data_root"; without it at their recorded
// place. The exit code is kFindings when there is any. Throws as FindRuns.
int RunVerify(const NoOptions& options, const StageFiles& files, int threads);

// Prints each object of map "map" that has a lower minimum of its cost than its landmark
// (CheckMinima), with the inputs and settings in the record of the map's run. Returns kFindings if
// there is one.
int RunCheckMinima(const NoOptions& options, const StageFiles& files, int threads);

// soslam-reproduce: repeats the runs of the variants in folder "results", as recorded in their
// run.json, with the programs in folder "executables", into a folder beside "results" that is
// removed at the end. Prints which artefacts are identical, and the first difference in the others.
// Datasets are in folder "data_root"; without it at their recorded place. The exit code is
// kFindings when an artefact differs or could not be made again. Throws as FindRuns; SettingsError
// when nothing can be written beside "results".
int RunReproduce(const NoOptions& options, const StageFiles& files, int threads);

// Arguments of soslam-inspect.
struct InspectRequest {
  std::filesystem::path file;
  bool headline = false;                     // one line instead, or two, of a map.json
  std::optional<std::string> table;          // the one that is wanted, whole; the first one as CSV
  std::optional<std::filesystem::path> csv;  // output path of the table; "-" is standard output
  std::optional<std::filesystem::path> image;     // output path of the picture, a .png
  std::optional<std::filesystem::path> sequence;  // the sequence that the artefact was made from
  std::optional<std::filesystem::path> dataset;   // folder with the images
  std::optional<int> frame_id;                    // frame of the picture
  std::optional<int> object_id;  // of the picture; without a picture, of all rows that are wanted
  EdgeLayer layer = EdgeLayer::kAll;
};

// Writes the requested table and picture and returns the text for standard output: with `headline`
// one line on a map.json, "9 objects, scale +- 18 %, 2 objects uncertain", whose sequence.json is
// beside it unless another one is given; a table as CSV if requested there; nothing if files were
// requested; otherwise one table, or facts and tables of the artefact, with escape sequences if
// `is_coloured`. Throws InputError for a file that is no artefact, SettingsError for a table or
// picture that this artefact cannot give.
std::string RunInspect(const InspectRequest& request, bool is_coloured);

}  // namespace soslam
