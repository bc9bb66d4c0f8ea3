// SPDX-License-Identifier: BSD-3-Clause
// soslam-bench-table BENCH.JSON PUBLISHED.JSON: what soslam-bench measured, as Markdown on stdout.
// Times are the medians of its repetitions, of one thread's CPU time, which other load on the
// machine hardly changes. Fails when a benchmark did.
#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <exception>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "soslam/artefact/json_file.h"
#include "soslam/base/table.h"
#include "soslam/report/tables.h"

namespace soslam {
namespace {

using Medians = std::map<std::string, nlohmann::json>;  // by name

// One column of the paper's Table V.
struct PaperColumn {
  const char* title;
  const char* ours;
  const char* baseline;
  const char* published = "";  // the variant's name in Table V
};
const PaperColumn kTableV[] = {
    {"one frame", "single_frame/ours", "single_frame/paper_baseline", "InitP"},
    {"one frame, baseline from 12 yaws", "single_frame/ours",
     "single_frame/paper_baseline_12_yaws"},
    {"one frame, texture", "single_frame_texture/ours", "single_frame_texture/paper_baseline",
     "InitPT"},
    {"12 frames", "12_frames/ours", "12_frames/paper_baseline", "OursP"},
    {"12 frames, texture of the first", "12_frames_texture/ours",
     "12_frames_texture/paper_baseline", "OursPT"},
    {"12 frames, texture of all", "12_frames_12_textures/ours",
     "12_frames_12_textures/paper_baseline"},
};

Medians ReadMedians(const nlohmann::json& document) {
  Medians medians;
  for (const nlohmann::json& benchmark : document.at("benchmarks")) {
    if (benchmark.value("error_occurred", false)) {
      throw InputError(fmt::format("{}: {}", benchmark.at("name").get<std::string>(),
                                   benchmark.at("error_message").get<std::string>()));
    }
    if (benchmark.value("aggregate_name", "") == "median") {
      medians[benchmark.at("run_name")] = benchmark;
    }
  }
  if (medians.empty()) throw InputError("no medians; expected --benchmark_repetitions=3 or more");
  return medians;
}

// Time of one thread; wall time for benchmarks that run programs.
double Seconds(const nlohmann::json& median) {
  static const std::map<std::string, double> units = {
      {"ns", 1e-9}, {"us", 1e-6}, {"ms", 1e-3}, {"s", 1.0}};
  const bool is_on_the_clock =
      median.at("run_name").get_ref<const std::string&>().ends_with("/real_time");
  return median.at(is_on_the_clock ? "real_time" : "cpu_time").get<double>() *
         units.at(median.at("time_unit"));
}

std::string Duration(double seconds) {
  for (const auto& [unit, size] : {std::pair("s", 1.0), {"ms", 1e-3}, {"us", 1e-6}}) {
    if (seconds >= size) return fmt::format("{:.3g} {}", seconds / size, unit);
  }
  return fmt::format("{:.3g} ns", seconds / 1e-9);
}

// None where one of both was not measured, as with a filter.
std::optional<std::pair<double, double>> TimesPerObject(const Medians& medians,
                                                        const PaperColumn& column) {
  const auto ours = medians.find(std::string("table_v/") + column.ours);
  const auto baseline = medians.find(std::string("table_v/") + column.baseline);
  if (ours == medians.end() || baseline == medians.end()) return std::nullopt;
  return std::pair(ours->second.at("seconds_per_object").get<double>(),
                   baseline->second.at("seconds_per_object").get<double>());
}

std::optional<double> PublishedSeconds(const PublishedTimes& times, const std::string& variant) {
  for (const PublishedTime& time : times.values) {
    if (time.variant == variant) return 1e-3 * time.ms_mean;
  }
  return std::nullopt;
}

Table TableV(const Medians& medians, const PublishedTimes& published_times) {
  Table table{"table_v",
              "One object, beside the paper's method and its Table V",
              {"", "ours", "paper's method here", "ratio", "published", "ratio"},
              {},
              1,
              {"The paper's method: numeric derivatives, dense Levenberg-Marquardt; measured in "
               "the same run on the same boxes and images. Published: " +
               published_times.source + ", on an " + published_times.machine + "."}};
  for (const PaperColumn& column : kTableV) {
    const auto times = TimesPerObject(medians, column);
    if (!times) continue;
    const auto& [ours, baseline] = *times;
    const auto published = PublishedSeconds(published_times, column.published);
    table.rows.push_back({column.title, Duration(ours), Duration(baseline),
                          fmt::format("{:.3g}", baseline / ours),
                          published ? Duration(*published) : kNoValue,
                          published ? fmt::format("{:.3g}", *published / ours) : kNoValue});
  }
  return table;
}

Table ScaleTable(const Medians& medians) {
  constexpr const char* kName = "scale/back_end/frames_and_objects:";
  Table table{"scale",
              "The back end on growing worlds, 20 observations per object",
              {"frames and objects", "observations", "time", "of half the size", "iterations",
               "of one", "peak memory"},
              {},
              1,
              {"Memory is that of the whole program."}};
  std::map<int, nlohmann::json> by_size;
  for (const auto& [name, median] : medians) {
    if (name.rfind(kName, 0) == 0) by_size[std::stoi(name.substr(std::strlen(kName)))] = median;
  }
  for (const auto& [size, median] : by_size) {
    const double seconds = Seconds(median);
    const auto iterations = median.at("solver_iterations").get<double>();
    const auto half = by_size.find(size / 2);
    table.rows.push_back(
        {std::to_string(size), fmt::format("{}", median.at("observations").get<double>()),
         Duration(seconds),
         half == by_size.end() ? kNoValue
                               : fmt::format("{:.2f} x", seconds / Seconds(half->second)),
         fmt::format("{}", iterations), Duration(seconds / iterations),
         fmt::format("{:.0f} MB", median.at("peak_mb").get<double>())});
  }
  return table;
}

// What each stage takes of a whole run, and the run on the clock.
Table PipelineTable(const Medians& medians) {
  constexpr std::string_view kSuffix = "_cpu_s";
  Table table{"pipeline",
              "All variants of data/room_a (60 frames), from images, on two threads",
              {"stage", "time"},
              {},
              1,
              {"Of stages CPU time, all of their runs together."}};
  for (const auto& [name, median] : medians) {
    if (name.rfind("pipeline/", 0) != 0) continue;
    for (const auto& [counter, seconds] : median.items()) {
      if (!counter.ends_with(kSuffix)) continue;
      table.rows.push_back({counter.substr(0, counter.size() - kSuffix.size()),
                            Duration(seconds.template get<double>())});
    }
    table.rows.push_back({"the run, on the clock", Duration(Seconds(median))});
  }
  return table;
}

Table SlamTable(const Medians& medians) {
  Table table{"slam_synthetic", "SLAM problems", {"", "time"}, {}, 1, {}};
  for (const auto& [name, median] : medians) {
    if (!name.starts_with("slam_synthetic/")) continue;
    table.rows.push_back({name, Duration(Seconds(median))});
  }
  return table;
}

void Print(const std::string& path, const std::string& published_path) {
  const nlohmann::json document = ParseJsonFile(path);
  const PublishedTimes published_times = ReadPublished(published_path).times;
  const Medians medians = ReadMedians(document);
  const nlohmann::json& context = document.at("context");
  fmt::print("# Benchmarks\n\n{}, {} cores, load {:.2g}; one thread, CPU time, medians.\n\n",
             context.value("cpu", "unknown"), context.at("num_cpus").get<int>(),
             context.at("load_avg").empty() ? 0.0 : context.at("load_avg").at(0).get<double>());
  for (const Table& table : {TableV(medians, published_times), ScaleTable(medians),
                             PipelineTable(medians), SlamTable(medians)}) {
    if (!table.rows.empty()) fmt::print("{}\n", ToMarkdown(table));
  }
}

}  // namespace
}  // namespace soslam

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: soslam-bench-table BENCH.JSON PUBLISHED.JSON\n");
    return 2;
  }
  try {
    soslam::Print(argv[1], argv[2]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "soslam-bench-table: {}\n", error.what());
    return 3;
  }
  return 0;
}
