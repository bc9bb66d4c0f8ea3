// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "soslam/artefact/json_file.h"
#include "soslam/base/description.h"

namespace soslam {

// Software that results may depend on besides inputs and settings.
struct Software {
  std::string version;                           // "soslam 0.1.0"
  std::string compiler;                          // "GCC 12.2.0"
  std::map<std::string, std::string> libraries;  // name -> version: "opencv" -> "4.6.0"

  bool operator==(const Software&) const = default;
};

// The software of this program. The version of a library is that of the running one where it can be
// queried, otherwise (Ceres, CLI11, Eigen, fmt, nlohmann-json) that of the headers.
Software ThisSoftware();

// Base folders of RunFile paths, in addition to the folders given as arguments.
inline constexpr const char* kRelativeToRun = "run";    // the folder of run.json
inline constexpr const char* kRelativeToCall = "call";  // RunRecord::called_in

// A file that a run read or wrote. The path is relative to the run for files of a results folder,
// and to the argument for files in a folder given as argument, so that both can be moved.
struct RunFile {
  std::optional<std::string> argument;  // the one that names the file or its folder, if any
  std::string relative_to;              // kRelativeToRun, kRelativeToCall or an argument
  std::filesystem::path path;
  std::string sha256;
};

struct RunSetting {
  nlohmann::json value;
  std::string origin;  // "default", "settings file" or "command line"
};

// One run of a stage: the content of run.json (schemas/run.schema.json).
struct RunRecord {
  std::string stage;  // the executable: "soslam-refine"
  Software software;
  std::optional<std::map<std::string, RunSetting>> settings;  // none: they were not valid
  bool allow_outside_paths = false;
  std::optional<int> seed;
  std::filesystem::path called_in;                       // absolute
  std::map<std::string, std::filesystem::path> folders;  // arguments that are folders, as called
  std::vector<RunFile> inputs;
  std::vector<RunFile> outputs;
  int exit_code = 0;
  std::string error;      // empty after success
  nlohmann::json timing;  // schemas/timing.schema.json without the stage
};

template <typename Visitor>
void Describe(Visitor& visit, RunFile& file) {
  visit.Field("argument", &file.argument, "that names the file, or the folder it is in");
  visit.Field(
      "relative_to", &file.relative_to,
      "where the path begins: \"run\", the folder of run.json; \"call\", the folder that the "
      "program was called in; else one of folders");
  visit.Field("path", &file.path, "relative to that", kNotEmpty);
  visit.Field("sha256", &file.sha256, "SHA-256 of its bytes, 64 hexadecimal digits");
  visit.Check([&] { return DigestViolation(file.sha256); });
}

template <typename Visitor>
void Describe(Visitor& visit, RunSetting& setting) {
  visit.Field("value", &setting.value, "number, text or truth value");
  visit.Field("origin", &setting.origin, "default, settings file or command line");
  visit.Check([&] {
    return NotOneOf("origin", setting.origin, {"default", "settings file", "command line"});
  });
  visit.Check([&] {
    const bool is_plain =
        setting.value.is_boolean() || setting.value.is_number() || setting.value.is_string();
    return is_plain ? std::string()
                    : "value is " + Excerpt(setting.value) +
                          "; expected a number, a text or a truth value";
  });
}

template <typename Visitor>
void Describe(Visitor& visit, RunRecord& record) {
  visit.Field("stage", &record.stage, "name of the executable");
  visit.Check([&] {
    const bool is_name = record.stage.size() > 7 && record.stage.starts_with("soslam-") &&
                         std::ranges::all_of(record.stage, [](char letter) {
                           return letter == '-' || (letter >= 'a' && letter <= 'z');
                         });
    return is_name ? std::string()
                   : fmt::format("/stage is \"{}\"; expected soslam-...", record.stage);
  });
  visit.Field("compiler", &record.software.compiler, "that built it, with its version");
  visit.Field("libraries", &record.software.libraries,
              "versions by name; of those that cannot be asked at run time, of the headers");
  visit.Field("settings", &record.settings, "every option by name; null when they were not valid");
  visit.Field("allow_outside_paths", &record.allow_outside_paths, "it was called with this option");
  visit.Field("seed", &record.seed, "of the random numbers; null where none are drawn");
  visit.Field("called_in", &record.called_in, "folder in which relative paths begin");
  visit.Field("folders", &record.folders, "paths of the arguments that are folders, as called");
  visit.Field("inputs", &record.inputs, "files that were read, as they were then");
  visit.Field("outputs", &record.outputs, "files that were written");
  visit.Field("exit_code", &record.exit_code, "of the program", {0.0, 255.0});
  visit.OrNull("error", &record.error, "why it failed; null after success");
  visit.Field("timing", &record.timing, "as in timing.json");
  visit.Check([&] {
    return record.timing.is_object()
               ? std::string()
               : "timing is " + Excerpt(record.timing) + "; expected an object with fields";
  });
}

// The schema of run.json, with its header.
nlohmann::ordered_json RunSchema();

// Throws SettingsError when the file cannot be written.
void WriteRun(const std::filesystem::path& path, const RunRecord& record);

// Throws InputError, naming file and field, when it is missing or not valid.
RunRecord ReadRun(const std::filesystem::path& path);

}  // namespace soslam
