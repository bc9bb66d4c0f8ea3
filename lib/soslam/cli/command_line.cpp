// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <glog/logging.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <opencv2/core/utility.hpp>
#include <optional>

#include "soslam/artefact/json_file.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/progress.h"
#include "soslam/base/text.h"
#include "soslam/cli/run_recorder.h"
#include "soslam/dataset/image_path.h"
#include "soslam/system/process.h"

namespace soslam {

Finding SettingWithoutEffect(const std::string& file, const std::string& name,
                             const nlohmann::json& value, const OptionVisitor::Conditions& unmet) {
  return {"setting_without_effect",
          Severity::kWarning,
          fmt::format("{}: {} = {} has no effect", file, name, value.dump()),
          InWords(unmet),
          "a setting of another method or kind of evidence",
          fmt::format("remove {}, or set {}", name, InWords(unmet))};
}

void ReportFindings(const std::string& stage, const std::vector<Finding>& findings) {
  for (const Finding& finding : findings) {
    fmt::print(stderr, "soslam-{}: {}: {}\n", stage,
               kSeverityNames[static_cast<size_t>(finding.severity)], OneLine(InWords(finding)));
  }
}

nlohmann::json ReadSettingsFile(const std::filesystem::path& path) {
  nlohmann::json settings;
  try {
    settings = ParseJsonFile(path);
  } catch (const InputError& error) {
    throw SettingsError(error.what());  // which has another exit code
  }
  if (!settings.is_object()) {
    throw SettingsError(path.string() + ": expected an object of settings, found a JSON " +
                        settings.type_name());
  }
  return settings;
}

}  // namespace soslam

namespace soslam::internal {

namespace {

constexpr size_t kTextColumn = 34;
constexpr size_t kWidth = 100;

std::string ReplaceAll(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size())) {
    text.replace(at, from.size(), to);
  }
  return text;
}

// Layout of --help: names in one column, wrapped texts in another.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(kTextColumn); }

  std::string make_description(const CLI::App* app) const override {
    return Wrapped(app->get_description(), kWidth) + "\n";
  }
  // Replaces CLI11's two empty lines between groups by one.
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override {
    const std::string help = CLI::Formatter::make_help(app, std::move(name), mode);
    return ReplaceAll(help, "\n\n\n", "\n\n");
  }
  std::string make_option_desc(const CLI::Option* option) const override {
    return Wrapped(option->get_description(), kWidth - kTextColumn);
  }
};

constexpr const char* kFailureRecord = "--failure_record";

// Value of an option's text. A text that does not match the type stays a string, which
// OptionsFromJson then refuses with the option's name.
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

// Storage for CLI11 while it parses.
struct ParsedArguments {
  StageFiles files;
  std::string settings_file;
  int threads = 0;
  bool quiet = false;
  nlohmann::json options = nlohmann::json::object();
};

void AddFiles(const std::vector<FileArgument>& files, const std::string& group, CLI::App* app,
              ParsedArguments* parsed) {
  for (const FileArgument& file : files) {
    const std::string paths = file.repeatable ? "PATH ..." : "PATH";
    CLI::Option* option = app->add_option_function<std::vector<std::string>>(
        "--" + file.name,
        [parsed, name = file.name](const std::vector<std::string>& paths) {
          for (size_t i = 0; i < paths.size(); ++i) {
            if (paths[i].empty()) throw CLI::ValidationError("--" + name, "is ''; expected a path");
            parsed->files[RepeatedName(name, i)] = paths[i];
          }
        },
        file.doc);
    option->group(group)
        ->required(file.required)
        ->option_text(file.required ? paths + " (required)" : paths);
    if (!file.repeatable) option->expected(1);
  }
}

// Adds the options of a stage and those that all stages have.
void AddOptions(const std::vector<OptionRow>& options, CLI::App* app, ParsedArguments* parsed) {
  for (const OptionRow& row : options) {
    std::string domain;  // possible values; empty when all of the type
    if (row.range) {
      domain = fmt::format("{} to {}{}{}", row.range->min, row.range->max,
                           row.unit.empty() ? "" : " ", row.unit);
    } else if (row.type == "boolean") {
      domain = "true | false";
    } else {
      domain = fmt::format("{}", fmt::join(row.choices, " | "));
    }
    const std::string value =
        row.choices.empty() ? row.default_value.dump() : row.default_value.get<std::string>();
    std::string only_where;
    for (const OptionVisitor::Conditions& conditions : row.only_where) {
      only_where += (only_where.empty() ? "; only where " : ", ") + InWords(conditions);
    }
    CLI::Option* option = app->add_option_function<std::string>(
        "--" + row.name,
        [parsed, &row](const std::string& text) {
          parsed->options[row.name] = ValueFromText(text, row.type);
        },
        fmt::format("{}\n[default {}{}{}{}]", row.doc, value, domain.empty() ? "" : "; ", domain,
                    only_where));
    option->group(row.group.empty() ? "Options" : row.group)->option_text(row.type);
    if (row.type == "boolean") option->expected(0, 1);
  }
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

// The current exception with an exit code and a message of one line.
Error CurrentError() {
  try {
    throw;
  } catch (const CLI::ParseError& error) {
    return {ExitCode::kSettings, OneLine(fmt::format("{} (see --help)", error.what()))};
  } catch (const Error& error) {
    return {error.exit_code(), OneLine(error.what())};
  } catch (const std::exception& error) {  // among them std::bad_alloc and cv::Exception
    return {ExitCode::kInternal, OneLine(fmt::format("internal error: {}", error.what()))};
  } catch (...) {
    return {ExitCode::kInternal, "internal error: unknown exception"};
  }
}

// Throws SettingsError for the first option that the program does not have, with the name that was
// probably meant, before what is missing or wrong because of it.
void Parse(int argc, const char* const* argv, CLI::App* app) {
  try {
    app->parse(argc, argv);
  } catch (const CLI::Success&) {  // --help and its like
    throw;
  } catch (const CLI::ParseError&) {
    for (const std::string& word : app->remaining()) {
      if (!word.starts_with('-')) continue;
      const std::string option = word.substr(0, word.find('='));
      std::string name = option.substr(std::min(option.find_first_not_of('-'), option.size()));
      std::ranges::replace(name, '-', '_');
      std::vector<std::string> names;
      for (const CLI::Option* known : app->get_options()) {
        names.push_back(known->get_single_name());
      }
      const auto meant = LikelyMeant(name, names);
      throw SettingsError(fmt::format("unknown option {}{} (see --help)", option,
                                      meant ? "; did you mean --" + *meant + "?" : ""));
    }
    throw;
  }
}

int RunRecorded(const ParsedArguments& parsed, const StageInfo& info,
                const std::vector<OptionRow>& options, const StageBody& body) {
  const int threads = parsed.threads > 0 ? parsed.threads : ThisMachine().cores;
  RunRecorder recorder(info, parsed.files, parsed.settings_file, threads);
  try {
    std::vector<SettingsLayer> layers;
    if (!parsed.settings_file.empty()) {
      layers.push_back(
          {parsed.settings_file, "settings file", ReadSettingsFile(parsed.settings_file)});
    }
    layers.push_back({"command line", "command line", parsed.options});
    const nlohmann::json resolved = body.resolve(layers);
    recorder.SetSettings(resolved, layers);
    std::vector<Finding> findings;
    for (const SettingsLayer& layer : layers) {
      // A file that sets all options, as those that the pipeline writes, chooses none.
      if (layer.values.size() == options.size()) continue;
      for (const auto& [name, value] : layer.values.items()) {
        const auto unmet = UnmetConditions(options, resolved, name);
        if (unmet.empty()) continue;
        findings.push_back(SettingWithoutEffect(layer.where, name, value, unmet));
      }
    }
    ReportFindings(info.name.substr(std::string("soslam-").size()), findings);
    const int exit_code = body.run(parsed.files, threads);
    recorder.RecordSuccess();
    return exit_code;
  } catch (...) {
    recorder.RecordFailure(CurrentError());
    throw;
  }
}

}  // namespace

std::string ExitCodesHelp(const std::string& findings) {
  const std::string codes =
      "Exit codes: 0 done; 2 wrong usage or setting; 3 input missing or not valid; 4 nothing "
      "usable\ncame out; 5 numerical failure; 70 a bug in this program";
  return findings.empty() ? codes : fmt::format("{};\n{} {}", codes, kFindings, findings);
}

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

int RunForExitCode(CLI::App* app, const std::function<int()>& run) {
  try {
    return run();
  } catch (const CLI::Success& answered) {  // --help and its like
    return app->exit(answered);
  } catch (...) {
    const Error error = CurrentError();
    const int exit_code = static_cast<int>(error.exit_code());
    std::cerr << app->get_name() << ": error: " << error.what() << std::endl;
    const CLI::Option* record = app->get_option_no_throw(kFailureRecord);
    if (record != nullptr && record->count() > 0) {
      // If the record cannot be written, stderr must suffice.
      std::ofstream(record->as<std::string>())
          << fmt::format("exit code {}: {}\n", exit_code, error.what());
    }
    return exit_code;
  }
}

int RunStageMain(int argc, const char* const* argv, const StageInfo& info,
                 const std::vector<OptionRow>& options, const StageBody& body) {
  // Silences Ceres' warnings through glog, which repeat its results; stages report these in their
  // own words.
  FLAGS_minloglevel = google::GLOG_FATAL;
  cv::setNumThreads(1);  // stages have threads of their own, on top of which OpenCV's would come
  CLI::App app(info.purpose, info.name);
  return RunForExitCode(&app, [&] {
    ParsedArguments parsed;
    app.formatter(std::make_shared<HelpFormatter>());
    // Wrapped such that a shell reads it as one command.
    const std::string example = ReplaceAll(Wrapped(info.example, kWidth - 8), "\n", " \\\n      ");
    app.footer(fmt::format("Example:\n  {}\n\n{}", example, ExitCodesHelp(info.findings)));
    AddFiles(info.inputs, "Inputs", &app, &parsed);
    AddFiles(info.outputs, "Outputs", &app, &parsed);
    AddOptions(options, &app, &parsed);
    Parse(argc, argv, &app);
    std::optional<ProgressOnStderr> progress;
    if (!parsed.quiet) progress.emplace(info.name);
    return RunRecorded(parsed, info, options, body);
  });
}

}  // namespace soslam::internal
