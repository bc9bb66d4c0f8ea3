// SPDX-License-Identifier: BSD-3-Clause
#include "stage/command_line.h"

#include <fmt/format.h>
#include <glog/logging.h>
#include <sys/resource.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <fstream>
#include <iostream>
#include <optional>
#include <thread>

#include "artefact/atomic_file.h"
#include "base/error.h"
#include "base/machine.h"
#include "base/progress.h"
#include "dataset/image_path.h"
#include "stage/help.h"
#include "stage/settings_file.h"

namespace soslam::internal {

const char* const kExitCodes =
    "Exit codes: 0 done; 2 wrong usage or setting; 3 input missing or not valid; 4 nothing usable\n"
    "came out; 5 numerical failure; 70 a bug in this program";

namespace {

namespace fs = std::filesystem;

constexpr const char* kFailureRecord = "--failure_record";

// What CLI11 stores while it parses.
struct ParsedArguments {
  StageFiles files;
  std::string settings_file;
  int threads = 0;
  bool quiet = false;
  std::map<std::string, std::string> option_texts;  // by option name
};

void AddFiles(const std::vector<FileArgument>& files, const std::string& group, CLI::App* app,
              ParsedArguments* parsed) {
  for (const FileArgument& file : files) {
    const std::string paths = file.repeatable ? "PATH ..." : "PATH";
    CLI::Option* option = app->add_option_function<std::vector<std::string>>(
        "--" + file.name,
        [parsed, name = file.name](const std::vector<std::string>& paths) {
          for (size_t i = 0; i < paths.size(); ++i) parsed->files[RepeatedName(name, i)] = paths[i];
        },
        file.doc);
    option->group(group)
        ->required(file.required)
        ->option_text(file.required ? paths + " (required)" : paths);
    if (!file.repeatable) option->expected(1);
  }
}

void AddOptions(const std::vector<OptionRow>& options, CLI::App* app, ParsedArguments* parsed) {
  for (const OptionRow& row : options) {
    CLI::Option* option = app->add_option_function<std::string>(
        "--" + row.name,
        [parsed, name = row.name](const std::string& text) { parsed->option_texts[name] = text; },
        OptionHelp(row));
    option->group(row.group.empty() ? "Options" : row.group)->option_text(row.type);
    if (row.type == "boolean") option->expected(0, 1);
  }
}

void AddCommon(const std::vector<OptionRow>& options, CLI::App* app, ParsedArguments* parsed) {
  app->add_option("--settings", parsed->settings_file,
                  "JSON object of options; those on the command line win")
      ->group("Common")
      ->option_text("PATH");
  app->add_option("--threads", parsed->threads,
                  "threads; 0 = all cores. Results do not depend on it\n[default 0]")
      ->check(CLI::Range(0, 1024))
      ->group("Common")
      ->option_text("integer");
  app->add_option(kFailureRecord, "file to write when the stage fails: exit code and error")
      ->group("Common")
      ->option_text("PATH");
  app->add_flag("--quiet", parsed->quiet, "show no progress on stderr")->group("Common");
  AddOutsidePaths(app);
  app->add_flag_callback(
         "--settings_schema",
         [&options, app] {
           std::cout << SettingsSchema(options, "Settings of " + app->get_name()).dump(2) << "\n";
           throw CLI::Success();
         },
         "print the JSON schema of the settings and exit")
      ->group("Common");
  AddHelpAndVersion(app);
}

// The value of an option's text. What does not look like the type stays a string, which
// OptionsFromJson then refuses by name.
nlohmann::json ValueFromText(const std::string& text, const std::string& type) {
  const char* const end = text.data() + text.size();
  if (type == "integer") {
    int64_t value = 0;
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec == std::errc() && result.ptr == end) return value;
  }
  if (type == "number") {
    double value = 0.0;
    const auto result = std::from_chars(text.data(), end, value);
    if (result.ec == std::errc() && result.ptr == end && std::isfinite(value)) return value;
  }
  if (type == "boolean") {
    if (text.empty() || text == "true") return true;
    if (text == "false") return false;
  }
  return text;
}

StageCall MakeCall(const ParsedArguments& parsed, const std::vector<OptionRow>& options) {
  StageCall call;
  call.files = parsed.files;
  call.threads = parsed.threads > 0
                     ? parsed.threads
                     : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  if (!parsed.settings_file.empty()) {
    call.settings.push_back({parsed.settings_file, ReadSettingsFile(parsed.settings_file)});
  }
  nlohmann::json values = nlohmann::json::object();
  for (const OptionRow& row : options) {
    const auto text = parsed.option_texts.find(row.name);
    if (text != parsed.option_texts.end()) values[row.name] = ValueFromText(text->second, row.type);
  }
  call.settings.push_back({"command line", values});
  return call;
}

double Seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

void WriteTiming(const fs::path& output, const std::string& stage, double wall_s, int threads) {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const Machine machine = ThisMachine();
  const nlohmann::ordered_json timing = {
      {"stage", stage},
      {"wall_s", wall_s},
      {"cpu_s", Seconds(usage.ru_utime) + Seconds(usage.ru_stime)},
      {"peak_memory_mb", static_cast<double>(usage.ru_maxrss) / 1024.0},  // ru_maxrss is in KiB
      {"threads", threads},
      {"machine", {{"cpu", machine.cpu}, {"cores", machine.cores}}}};
  const fs::path folder = fs::is_directory(output) ? output : output.parent_path();
  WriteTextFile(folder / "timing.json", timing.dump(2) + "\n");
}

// Begin and end of a text in UTF-8, which have its place and what was expected.
std::string WithoutMiddle(const std::string& text) {
  constexpr size_t kMaxHalf = 1000;
  if (text.size() <= 2 * kMaxHalf) return text;
  const auto is_inside_character = [&](size_t i) { return (text[i] & 0xC0) == 0x80; };
  size_t begin = kMaxHalf;
  size_t end = text.size() - kMaxHalf;
  while (begin > 0 && is_inside_character(begin)) --begin;
  while (end < text.size() && is_inside_character(end)) ++end;
  return text.substr(0, begin) + " ... " + text.substr(end);
}

// As one line that a terminal takes for text: messages quote files, which may hold anything.
std::string OneLine(std::string text) {
  text.erase(text.find_last_not_of('\n') + 1);
  std::string line;
  for (const char character : text) {
    const bool is_control = static_cast<unsigned char>(character) < 0x20 || character == 0x7F;
    if (character == '\n') {
      line += ' ';
    } else if (is_control) {
      line += fmt::format("\\x{:02x}", static_cast<unsigned char>(character));
    } else {
      line += character;
    }
  }
  return WithoutMiddle(line);
}

int Fail(const CLI::App& app, ExitCode exit_code, const std::string& message) {
  const std::string line = OneLine(message);
  std::cerr << app.get_name() << ": error: " << line << std::endl;
  const CLI::Option* record = app.get_option_no_throw(kFailureRecord);
  if (record != nullptr && record->count() > 0) {
    // Where the record cannot be written, stderr has to do.
    std::ofstream(record->as<std::string>())
        << fmt::format("exit code {}: {}\n", static_cast<int>(exit_code), line);
  }
  return static_cast<int>(exit_code);
}

void ParseAndRun(int argc, const char* const* argv, const StageInfo& info, CLI::App* app,
                 const std::vector<OptionRow>& options,
                 const std::function<void(const StageCall&)>& run) {
  ParsedArguments parsed;
  app->formatter(std::make_shared<HelpFormatter>());
  app->footer(fmt::format("Example:\n  {}\n\n{}", ExampleHelp(info.example), kExitCodes));
  AddFiles(info.inputs, "Inputs", app, &parsed);
  AddFiles(info.outputs, "Outputs", app, &parsed);
  AddOptions(options, app, &parsed);
  AddCommon(options, app, &parsed);
  app->parse(argc, argv);
  std::optional<ProgressOnStderr> progress;
  if (!parsed.quiet) progress.emplace(info.name);

  const auto start = std::chrono::steady_clock::now();
  const StageCall call = MakeCall(parsed, options);
  run(call);
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
  const auto output = call.files.find("output");
  if (output != call.files.end()) {
    WriteTiming(output->second, info.name, wall.count(), call.threads);
  }
}

}  // namespace

void AddHelpAndVersion(CLI::App* app) {
  app->set_help_flag("--help", "print this and exit")->group("Common");
  app->set_version_flag("--version", app->get_name() + " " + SOSLAM_VERSION,
                        "print the version and exit")
      ->group("Common");
}

void AddOutsidePaths(CLI::App* app) {
  app->add_flag_callback(
         "--allow_outside_paths", [] { AllowOutsidePaths(true); },
         "read images of a dataset also where its lists or symbolic links\nlead out of its folder")
      ->group("Common");
}

int ExitCodeOf(CLI::App* app, const std::function<int()>& run) {
  try {
    return run();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app->exit(error);  // --help and its like
    return Fail(*app, ExitCode::kSettings, fmt::format("{} (see --help)", error.what()));
  } catch (const Error& error) {
    return Fail(*app, error.exit_code(), error.what());
  } catch (const std::exception& error) {  // among them std::bad_alloc and cv::Exception
    return Fail(*app, ExitCode::kInternal, fmt::format("internal error: {}", error.what()));
  } catch (...) {
    return Fail(*app, ExitCode::kInternal, "internal error: unknown exception");
  }
}

int RunStageMain(int argc, const char* const* argv, const StageInfo& info,
                 const std::vector<OptionRow>& options,
                 const std::function<void(const StageCall&)>& run) {
  // Ceres warns through glog of what its results say as well, and what the stages report in their
  // words.
  FLAGS_minloglevel = google::GLOG_FATAL;
  CLI::App app(info.purpose, info.name);
  return ExitCodeOf(&app, [&] {
    ParseAndRun(argc, argv, info, &app, options, run);
    return static_cast<int>(ExitCode::kDone);
  });
}

}  // namespace soslam::internal
