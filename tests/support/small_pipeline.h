// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "support/run_command.h"
#include "support/temporary_folder.h"

namespace soslam {

// Three ellipsoids along the world's axes on a floor, seen from in front of them: boxes, true poses
// and the true ratios determine them, and their texture is symmetric. Labels: chest, stool,
// armchair; ids 1, 2, 3. Every frame sees all three, at least 30 px from the border.
inline nlohmann::json SmallScene(int frames) {
  nlohmann::json scene = nlohmann::json::parse(R"({
    "name": "small",
    "camera": {"width": 480, "height": 360, "fx": 400, "fy": 400, "cx": 239.5, "cy": 179.5},
    "planes": [{"id": 0, "label": "floor", "normal": [0, 0, 1], "d": 0}],
    "objects": [
      {"id": 1, "label": "chest", "shape": "ellipsoid", "half_axes": [0.30, 0.50, 0.25],
       "plane": 0, "position": [2.9, 0.1], "yaw_deg": 180},
      {"id": 2, "label": "stool", "shape": "ellipsoid", "half_axes": [0.22, 0.30, 0.36],
       "plane": 0, "position": [3.1, -1.1], "yaw_deg": 180},
      {"id": 3, "label": "armchair", "shape": "ellipsoid", "half_axes": [0.40, 0.34, 0.46],
       "plane": 0, "position": [3.8, 1.2], "yaw_deg": 180}],
    "trajectory": {
      "frame_interval": 0.1,
      "waypoints": [{"position": [0.3, -0.7, 1.15], "look_at": [3.2, 0.0, 0.4]},
                    {"position": [0.4, 0.0, 1.12], "look_at": [3.2, 0.0, 0.4]},
                    {"position": [0.3, 0.7, 1.15], "look_at": [3.2, 0.0, 0.4]}]}})");
  scene["trajectory"]["frames"] = frames;
  return scene;
}

// A stage's executable.
inline std::string StageProgram(const std::string& stage) {
  return std::string(SOSLAM_BINARY_DIR) + "/soslam-" + stage;
}

// The words that call make, without what a make that runs the tests would hand down to it.
inline std::vector<std::string> MakeWords(const std::vector<std::string>& arguments) {
  std::vector<std::string> words = {"env",    "-u", "MAKEFLAGS", "-u",
                                    "MFLAGS", "-u", "MAKELEVEL", "make"};
  words.insert(words.end(), arguments.begin(), arguments.end());
  return words;
}

inline CommandResult RunMake(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), {"-j2", "--output-sync"});
  return RunCommand(MakeWords(arguments));
}

// The paths that only one of two has, or whose content differs.
template <typename Content>
std::set<std::string> Differing(const std::map<std::string, Content>& one,
                                const std::map<std::string, Content>& other) {
  std::set<std::string> paths;
  for (const auto* side : {&one, &other}) {
    for (const auto& [path, content] : *side) {
      const bool is_in_both = one.contains(path) && other.contains(path);
      if (!is_in_both || one.at(path) != other.at(path)) paths.insert(path);
    }
  }
  return paths;
}

// The small scene's dataset, a copy of the project's pipelines, and a results folder, all in a
// folder of the test's own.
class SmallPipeline {
 public:
  static constexpr int kFrames = 4;

  explicit SmallPipeline(int frames = kFrames, int threads = 2)
      : threads_(std::to_string(threads)) {
    WriteBytes(folder_ / "scene.json", SmallScene(frames).dump());
    ExpectSuccess(
        RunCommand({StageProgram("synthesise"), "--scene", (folder_ / "scene.json").string(),
                    "--output", Dataset().string(), "--threads", threads_}));
    WriteBytes(Dataset() / "planes.json",
               R"([{"id": 0, "normal": [0, 0, 1], "d": 0, "scene_axis": [1, 0, 0]}])");
    std::filesystem::copy(SOSLAM_SOURCE_DIR "/pipelines", Pipelines(),
                          std::filesystem::copy_options::recursive);
    std::filesystem::create_directory(Pipelines() / "datasets");
    WriteSettings(TrueRatios());
  }

  std::filesystem::path Dataset() const { return folder_ / "data/small"; }
  std::filesystem::path Pipelines() const { return folder_ / "pipelines"; }
  std::filesystem::path Results() const { return folder_ / "results/small"; }
  std::filesystem::path SemanticTable() const { return Pipelines() / "priors/semantic_table.json"; }
  const std::filesystem::path& Folder() const { return folder_.path(); }

  // The settings of the dataset with which every object's size ratio is its own.
  static nlohmann::json TrueRatios() {
    const nlohmann::json true_ratio = {{"ratio_prior", "groundtruth"}};
    return {{"initialise", true_ratio}, {"refine", true_ratio}, {"optimise", true_ratio}};
  }
  void WriteSettings(const nlohmann::json& settings) const {
    WriteBytes(Pipelines() / "datasets/small.json", settings.dump());
  }

  // Plans variants (empty: all) and makes them, as `make run` of the project does after building.
  CommandResult Run(const std::string& variants, const std::vector<std::string>& flags = {}) const {
    const CommandResult planned =
        RunCommand({StageProgram("plan"), "--dataset", Dataset().string(), "--name", "small",
                    "--pipelines", Pipelines().string(), "--results",
                    (folder_ / "results").string(), "--variants", variants});
    if (planned.exit_code != 0) return planned;
    std::vector<std::string> words = {"-f", (Results() / "plan.mk").string(),
                                      "BIN=" SOSLAM_BINARY_DIR, "THREADS=" + threads_, "all"};
    words.insert(words.end(), flags.begin(), flags.end());
    return RunMake(words);
  }

  // The words that call the project's own Makefile for this dataset.
  std::vector<std::string> WordsOfProject(const std::vector<std::string>& arguments) const {
    std::vector<std::string> words = {
        "-j2",
        "-C",
        SOSLAM_SOURCE_DIR,
        "DATASET=small",
        "BUILD=" + std::filesystem::path(SOSLAM_BINARY_DIR).parent_path().string(),
        "DATA_ROOT=" + Dataset().parent_path().string(),
        "RESULTS=" + Results().parent_path().string(),
        "PIPELINES=" + Pipelines().string()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return MakeWords(words);
  }

  // The words that call ./soslam of the project for this dataset, and with these options.
  std::vector<std::string> WordsOfCommand(const std::string& command,
                                          const std::vector<std::string>& options) const {
    std::vector<std::string> words = {SOSLAM_SOURCE_DIR "/soslam",
                                      command,
                                      "small",
                                      "--build",
                                      std::filesystem::path(SOSLAM_BINARY_DIR).parent_path(),
                                      "--data_root",
                                      Dataset().parent_path(),
                                      "--results",
                                      Results().parent_path(),
                                      "--pipelines",
                                      Pipelines()};
    words.insert(words.end(), options.begin(), options.end());
    return words;
  }

  // A folder with all programs, where that of a stage crashes.
  std::string ProgramsWithACrashIn(const std::string& stage) const {
    const std::filesystem::path programs = folder_ / "programs";
    std::filesystem::create_directory(programs);
    for (const auto& program : std::filesystem::directory_iterator(SOSLAM_BINARY_DIR)) {
      std::filesystem::create_symlink(program.path(), programs / program.path().filename());
    }
    const std::filesystem::path crashing = programs / ("soslam-" + stage);
    std::filesystem::remove(crashing);
    WriteBytes(crashing, "#!/bin/sh\nkill -SEGV $$\n");
    std::filesystem::permissions(crashing, std::filesystem::perms::owner_all);
    return programs.string();
  }

  // The bytes of all artefacts (JSON, HDF5) below a folder, by path, links as well; without the
  // records of runs, which hold times.
  static std::map<std::string, std::string> Artefacts(const std::filesystem::path& folder) {
    std::map<std::string, std::string> artefacts;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      const std::filesystem::path& path = entry.path();
      const bool is_artefact = path.extension() == ".json" || path.extension() == ".h5";
      const bool is_record = path.filename() == "timing.json" || path.filename() == "run.json";
      if (!is_artefact || is_record) continue;
      artefacts[path.lexically_relative(folder).string()] = FileBytes(path);
    }
    return artefacts;
  }

 private:
  TemporaryFolder folder_;
  std::string threads_;
};

}  // namespace soslam
