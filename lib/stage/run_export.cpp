// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <functional>

#include "artefact/atomic_file.h"
#include "artefact/files.h"
#include "artefact/json_file.h"
#include "base/error.h"
#include "exchange/exports.h"
#include "exchange/world.h"
#include "stage/stages.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

constexpr std::array kOutputs = {"trajectory", "ply", "gltf", "coco", "coco_dataset", "csv"};

struct Output {
  fs::path path;
  std::string bytes;
};

bool OnlyTrajectory(const StageFiles& files) {
  return std::ranges::none_of(kOutputs, [&](const std::string& output) {
    return output != "trajectory" && files.contains(output);
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
      {!options.truth && !has_map && !OnlyTrajectory(files),
       "there are no objects; expected --map, or truth = true"},
      {has_metrics && !has_map,
       "--metrics is given without --map; expected the map that it evaluates"},
      {options.aligned && !has_metrics,
       "aligned is true without --metrics; expected metrics.json of the map"}};
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

std::vector<World> ReadWorlds(const ExportOptions& options, const StageFiles& files) {
  const PlaneNeed need = OnlyTrajectory(files) ? PlaneNeed::kNotNeeded : PlaneNeed::kNeeded;
  const Sequence sequence = ReadSequence(files.at("sequence"), need);
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

// Creates all outputs before any is written, so that a failure leaves no partial result.
std::vector<Output> MakeOutputs(const std::vector<World>& worlds, const ExportOptions& options,
                                const StageFiles& files) {
  std::vector<Output> outputs;
  const auto add = [&](const std::string& name,
                       const std::function<std::string(const std::vector<World>&)>& text) {
    if (files.contains(name)) outputs.push_back({files.at(name), text(worlds)});
  };
  const auto add_each = [&](const std::string& name,
                            const std::function<std::string(const World&)>& text) {
    if (!files.contains(name)) return;
    const fs::path& path = files.at(name);
    for (const World& world : worlds) {
      // With several segments, segment 3 of map.ply becomes map-3.ply.
      const std::string name_of_segment =
          fmt::format("{}-{}{}", path.stem().string(), world.segment, path.extension().string());
      outputs.push_back(
          {worlds.size() == 1 ? path : path.parent_path() / name_of_segment, text(world)});
    }
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
  return outputs;
}

}  // namespace

void RunExport(const ExportOptions& options, const StageFiles& files, int /*threads*/) {
  CheckFiles(options, files);
  const std::vector<World> worlds = ReadWorlds(options, files);
  const bool has_frame =
      std::ranges::any_of(worlds, [](const World& world) { return !world.frames.empty(); });
  if (files.contains("trajectory") && !has_frame) {
    throw NothingUsableError(files.at("sequence").string() + ": has no poses of this kind");
  }
  const bool has_landmark = std::ranges::any_of(worlds, [](const World& world) {
    return std::ranges::any_of(world.objects, [](const WorldObject& object) {
      return object.estimate.landmark_in_world.has_value();
    });
  });
  if (!OnlyTrajectory(files) && !has_landmark) {
    throw NothingUsableError(files.at(files.contains("map") ? "map" : "sequence").string() +
                             ": has no landmarks of this kind");
  }
  for (const Output& output : MakeOutputs(worlds, options, files)) {
    WriteTextFile(output.path, output.bytes);
    fmt::print("{}\n", output.path.string());
  }
}

}  // namespace soslam
