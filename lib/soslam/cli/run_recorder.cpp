// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/run_recorder.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>

#include "soslam/artefact/atomic_file.h"
#include "soslam/artefact/json_file.h"
#include "soslam/base/paths.h"
#include "soslam/dataset/image_path.h"
#include "soslam/system/process.h"

namespace soslam::internal {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Folder of the first given output.
std::optional<fs::path> RecordFolder(const StageInfo& info, const StageFiles& files) {
  if (!info.is_recorded) return std::nullopt;
  for (const FileArgument& output : info.outputs) {
    const auto file = files.find(output.name);
    if (file == files.end()) continue;
    if (output.is_folder) return file->second;
    return file->second.has_parent_path() ? file->second.parent_path() : fs::path(".");
  }
  return std::nullopt;
}

// The files of a record, with a field that each has.
constexpr std::pair<const char*, const char*> kRecordFiles[] = {{"run.json", "called_in"},
                                                                {"timing.json", "wall_s"}};

// Argument name of a file: "sequence" also for the second file of --sequence, see RepeatedName.
std::string ArgumentOf(const std::string& name) { return name.substr(0, name.find('#')); }

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

RunRecorder::RunRecorder(const StageInfo& info, const StageFiles& files,
                         const fs::path& settings_file, int threads)
    : folder_(RecordFolder(info, files)), files_(files), threads_(threads) {
  if (!folder_) return;
  for (const auto& [name, field] : kRecordFiles) {
    const fs::path file = *folder_ / name;
    if (!IsFile(file) || fs::is_empty(file)) continue;
    try {
      if (ParseJsonFile(file).contains(field)) continue;
    } catch (const InputError&) {
    }
    throw SettingsError(fmt::format(
        "{}: is no record of soslam, and one of this run would replace it; expected an output in "
        "another folder, or that file under another name; a damaged record is to be removed",
        file.string()));
  }
  if (!settings_file.empty()) files_["settings"] = settings_file;
  record_.stage = info.name;
  record_.software = ThisSoftware();
  record_.allow_outside_paths = OutsidePathsAreAllowed();
  record_.called_in = fs::current_path();
  log_.emplace();
  for (const auto& [name, path] : files_) {
    const std::string argument = ArgumentOf(name);
    const auto output = std::ranges::find(info.outputs, argument, &FileArgument::name);
    const bool is_output = output != info.outputs.end();
    if (IsFolder(path) || (is_output && output->is_folder)) {
      record_.folders[argument] = path;
    } else if (!is_output) {
      RecordInput(path);
    }
  }
}

void RunRecorder::SetSettings(const json& resolved, const std::vector<SettingsLayer>& layers) {
  record_.settings.emplace();
  for (const auto& [name, value] : resolved.items()) {
    (*record_.settings)[name] = {value, "default"};
  }
  for (const SettingsLayer& layer : layers) {
    for (const auto& item : layer.values.items()) {
      record_.settings->at(item.key()).origin = layer.origin;
    }
  }
}

void RunRecorder::RecordSuccess() {
  if (!folder_) return;
  Finish();
  json timing = record_.timing;
  timing["stage"] = record_.stage;
  WriteTextFile(*folder_ / "timing.json", timing.dump(2) + "\n");
  WriteRun(*folder_ / "run.json", record_);
}

void RunRecorder::RecordFailure(const Error& error) {
  if (!folder_) return;
  record_.exit_code = static_cast<int>(error.exit_code());
  record_.error = error.what();
  try {
    Finish();
    WriteRun(*folder_ / "run.json", record_);
  } catch (const std::exception&) {
    return;  // the failure itself is more important
  }
}

void RunRecorder::Finish() {
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start_;
  if (log_) {  // false when called again because the first record could not be written
    for (const FileDigest& input : log_->Inputs()) record_.inputs.push_back(Place(input));
    for (const FileDigest& output : log_->Outputs()) record_.outputs.push_back(Place(output));
    record_.seed = log_->Seed();
    log_.reset();  // the record is no result
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const Machine machine = ThisMachine();
  record_.timing = {
      {"wall_s", wall.count()},
      {"cpu_s", Seconds(usage.ru_utime) + Seconds(usage.ru_stime)},
      {"peak_memory_mb", static_cast<double>(usage.ru_maxrss) / 1024.0},  // ru_maxrss is in KiB
      {"threads", threads_},
      {"machine", {{"cpu", machine.cpu}, {"cores", machine.cores}}}};
}

RunFile RunRecorder::Place(const FileDigest& file) const {
  const fs::path path = PlainPath(file.path);
  const auto named = std::ranges::find_if(
      files_, [&](const auto& given) { return PlainPath(given.second) == path; });
  if (named == files_.end()) {
    for (const auto& [argument, folder] : record_.folders) {
      if (!IsWithin(path, folder)) continue;
      return {argument, argument, path.lexically_relative(PlainPath(folder)), file.sha256};
    }
  }
  const auto argument =
      named == files_.end() ? std::nullopt : std::optional(ArgumentOf(named->first));
  // Files in the run's folder, or beside it, move together with it.
  const fs::path run = PlainPath(*folder_);
  if (IsWithin(path, run.parent_path())) {
    return {argument, kRelativeToRun, path.lexically_relative(run), file.sha256};
  }
  return {argument, kRelativeToCall, file.path, file.sha256};
}

}  // namespace soslam::internal
