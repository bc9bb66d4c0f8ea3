// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/files.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "soslam/base/paths.h"
#include "soslam/base/text.h"
#include "soslam/cli/command_line.h"
#include "soslam/evaluation/statistics.h"
#include "soslam/exchange/exports.h"
#include "soslam/exchange/world.h"
#include "soslam/stage/export_images.h"
#include "soslam/stage/read_evidence.h"
#include "soslam/stage/stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr std::array kOutputs = {"trajectory", "ply",   "gltf",   "coco",       "coco_dataset",
                                 "csv",        "boxes", "colmap", "transforms", "overlays"};
// Outputs of poses alone, which need no objects.
constexpr std::array kPoseOutputs = {"trajectory", "colmap", "transforms"};

struct Output {
  fs::path path;
  std::string bytes;
};

bool OnlyPoses(const StageFiles& files) {
  return std::ranges::none_of(kOutputs, [&](const std::string& output) {
    return files.contains(output) && std::ranges::find(kPoseOutputs, output) == kPoseOutputs.end();
  });
}

void CheckFiles(const ExportOptions& options, const StageFiles& files) {
  if (std::ranges::none_of(kOutputs, [&](const char* output) { return files.contains(output); })) {
    throw SettingsError(fmt::format("nothing to write; expected at least one of --{}",
                                    fmt::join(kOutputs, ", --")));
  }
  const bool has_map = files.contains("map"), has_metrics = files.contains("metrics");
  const std::pair<bool, const char*> faults[] = {
      {options.truth && has_map, "truth is true and --map is given; expected one of them"},
      {!options.truth && !has_map && !OnlyPoses(files),
       "there are no objects; expected --map, or truth = true"},
      {has_metrics && !has_map,
       "--metrics is given without --map; expected the map that it evaluates"},
      {options.aligned && !has_metrics,
       "aligned is true without --metrics; expected metrics.json of the map"},
      {files.contains("points") && !files.contains("colmap"),
       "--points is given without --colmap; expected the model that they belong to"},
      {files.contains("overlays") && !files.contains("dataset"),
       "--overlays is given without --dataset; expected the folder with the images"}};
  for (const auto& [is_fault, message] : faults) {
    if (is_fault) throw SettingsError(message);
  }
  const auto gltf = files.find("gltf");
  if (gltf == files.end()) return;
  const fs::path extension = gltf->second.extension();
  if (extension != ".glb" && extension != ".gltf") {
    throw SettingsError(
        fmt::format("{}: has another extension; expected .glb or .gltf", gltf->second.string()));
  }
}

std::vector<World> ReadWorlds(const Sequence& sequence, const ExportOptions& options,
                              const StageFiles& files) {
  if (options.truth) return WorldsOfTruth(sequence);
  if (!files.contains("map")) return WorldsOfOdometry(sequence);
  CheckWasMadeOf(files.at("map"), "map", files.at("sequence"));
  std::vector<World> worlds = WorldsOfMap(sequence, ReadMap(files.at("map"), sequence));
  if (!files.contains("metrics")) return worlds;
  const fs::path& metrics = files.at("metrics");
  CheckWasMadeOf(metrics, "metrics", files.at("map"));
  const auto quality = ReadArtefact(metrics, "metrics").value("map_quality", nlohmann::json());
  if (!quality.is_null()) {
    AddVerdicts(quality, &worlds);
    if (options.aligned) AlignWorlds(quality, &worlds);
  } else if (options.aligned) {
    throw NothingUsableError(metrics.string() +
                             ": has no map_quality, so no alignment; expected metrics of a map "
                             "whose dataset says what is true (objects.json)");
  }
  return worlds;
}

// Median reprojection error of points from which poses are not those of their images.
constexpr double kMaxMedianErrorPx = 4.0;

bool HasImage(const World& world) {
  return std::ranges::any_of(world.frames,
                             [](const WorldFrame& frame) { return !frame.image.empty(); });
}

// Creates all outputs before any is written, so that a failure leaves no partial result.
std::vector<Output> MakeOutputs(const std::vector<World>& worlds, const ExportOptions& options,
                                const StageFiles& files) {
  std::vector<Output> outputs;
  const auto add = [&](const std::string& name,
                       const std::function<std::string(const std::vector<World>&)>& text) {
    if (files.contains(name)) outputs.push_back({files.at(name), text(worlds)});
  };
  // With several segments, segment 3 of map.ply becomes map-3.ply.
  const auto path_of = [&](const std::string& name, const World& world) {
    const fs::path path = PlainPath(files.at(name));
    if (worlds.size() == 1) return files.at(name);
    return path.parent_path() /
           fmt::format("{}-{}{}", path.stem().string(), world.segment, path.extension().string());
  };
  const auto add_each = [&](const std::string& name,
                            const std::function<std::string(const World&)>& text) {
    if (!files.contains(name)) return;
    for (const World& world : worlds) outputs.push_back({path_of(name, world), text(world)});
  };
  const LabelColours colours = ColoursOfLabels(worlds);
  add_each("trajectory", TumTrajectoryText);
  add_each("ply", [&](const World& world) { return PlyText(world, colours); });
  add_each("gltf", [&](const World& world) {
    return files.at("gltf").extension() == ".glb" ? GlbBytes(world, colours)
                                                  : GltfText(world, colours);
  });
  add("coco", CocoResultsText);
  add("coco_dataset", [&](const std::vector<World>& all) {
    return CocoDatasetText(all,
                           options.truth ? CocoAnnotations::kVisibleBoxes : CocoAnnotations::kNone);
  });
  add("csv", LandmarksCsvText);
  add_each("boxes", BoxesCsvText);
  const fs::path images = FolderOfImages(worlds);
  for (const World& world : worlds) {
    if (!HasImage(world)) continue;
    if (files.contains("colmap")) {
      const fs::path folder = path_of("colmap", world);
      const ColmapTexts texts = ColmapModelTexts(world, images);
      outputs.push_back({folder / "cameras.txt", texts.cameras});
      outputs.push_back({folder / "images.txt", texts.images});
      outputs.push_back({folder / "points3D.txt", texts.points3D});
    }
    if (files.contains("transforms")) {
      const fs::path file = path_of("transforms", world);
      // The dataset folder as seen from that of the file; empty if it is not known.
      const auto dataset = files.find("dataset");
      const fs::path seen = dataset == files.end()
                                ? fs::path()
                                : fs::relative(dataset->second, PlainPath(file).parent_path());
      outputs.push_back({file, TransformsText(world, seen)});
    }
  }
  return outputs;
}

// Throws NothingUsableError if there is nothing of what is asked for.
void CheckWorlds(const std::vector<World>& worlds, const StageFiles& files) {
  const std::string sequence = files.at("sequence").string();
  const auto any = [&](const auto& has) { return std::ranges::any_of(worlds, has); };
  if (files.contains("trajectory") &&
      !any([](const World& world) { return !world.frames.empty(); })) {
    throw NothingUsableError(sequence + ": has no poses of this kind");
  }
  const bool needs_images =
      files.contains("colmap") || files.contains("transforms") || files.contains("overlays");
  if (needs_images && !any(HasImage)) {
    throw NothingUsableError(sequence + ": has no frame with an image and a pose of this kind");
  }
  const bool has_landmark = any([](const World& world) {
    return std::ranges::any_of(world.objects, [](const WorldObject& object) {
      return object.estimate.landmark_in_world.has_value();
    });
  });
  if (!OnlyPoses(files) && !has_landmark) {
    throw NothingUsableError(files.at(files.contains("map") ? "map" : "sequence").string() +
                             ": has no landmarks of this kind");
  }
}

}  // namespace

void RunExport(const ExportOptions& options, const StageFiles& files, int threads) {
  CheckFiles(options, files);
  const PlaneNeed need = OnlyPoses(files) ? PlaneNeed::kNotNeeded : PlaneNeed::kNeeded;
  const Sequence sequence = ReadSequence(files.at("sequence"), need);
  std::vector<World> worlds = ReadWorlds(sequence, options, files);
  CheckWorlds(worlds, files);
  if (files.contains("points")) {
    const std::vector<MapPoint> points = ReadCheckedPoints(sequence, files);
    AddPoints(sequence, points, &worlds);
    std::vector<double> errors_px;
    for (const World& world : worlds) {
      for (const WorldPoint& point : world.points) {
        errors_px.push_back(point.reprojection_error_px);
      }
    }
    const size_t placed = errors_px.size();
    const std::optional<double> median_px = MedianOf(errors_px);
    if (2 * placed < points.size() || !(median_px.value_or(0.0) <= kMaxMedianErrorPx)) {
      ReportFindings(
          "export",
          {{"points_and_poses", Severity::kWarning,
            fmt::format("{}: {} of {} points can be placed by the poses that are written, at a "
                        "median reprojection error of {:.1f} px",
                        files.at("points").string(), placed, points.size(),
                        median_px.value_or(0.0)),
            fmt::format("most of them, at less than {} px", kMaxMedianErrorPx),
            "points of other images, or poses that drift",
            "points that were made of these images"}});
    }
    if (files.contains("dataset")) ColourPoints(sequence, files, threads, &worlds);
  }
  // Other programs may read images as they are stored, where EXIF turns them.
  if (files.contains("dataset") && (files.contains("colmap") || files.contains("transforms"))) {
    ReportFindings("export", CheckTurnedImages(sequence, files));
  }
  const std::vector<Output> outputs = MakeOutputs(worlds, options, files);
  if (files.contains("overlays")) {
    const size_t count = WriteOverlays(sequence, worlds, files, threads);
    fmt::print("{}: {}\n", files.at("overlays").string(), Counted(count, "image"));
  }
  for (const Output& output : outputs) {
    std::error_code ignored;  // writing says what is wrong
    fs::create_directories(output.path.parent_path(), ignored);
    WriteTextFile(output.path, output.bytes);
    fmt::print("{}\n", output.path.string());
  }
}

}  // namespace soslam
