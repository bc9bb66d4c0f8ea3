// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <string>

#include "soslam/base/error.h"
#include "soslam/cli/command_line.h"
#include "soslam/inspection/difference.h"
#include "soslam/stage/stages.h"

namespace {

constexpr const char* kExamples =
    "Examples:\n"
    "  soslam-inspect map.json --sequence sequence.json\n"
    "  soslam-inspect map.json --sequence sequence.json --dataset data/room_a --frame 10 --image "
    "frame.png\n"
    "  soslam-inspect map.json --headline\n"
    "  soslam-inspect sequence.json --table detections\n"
    "  soslam-inspect associations.json --object 3\n"
    "  soslam-inspect metrics.json --csv -\n"
    "  soslam-inspect diff one/map.json two/map.json --tolerance 1e-6";

struct Arguments {
  soslam::InspectRequest request;
  std::string layer = soslam::kEdgeLayerNames.front();
  std::string one, two;
  double tolerance = 1e-9;
};

std::string HelpFooter(const std::string& examples) {
  return fmt::format("{}\n\n{}", examples,
                     soslam::internal::ExitCodesHelp("the two artefacts of diff differ"));
}

bool IsColoured() {
  const char* no_color = std::getenv("NO_COLOR");
  return isatty(STDOUT_FILENO) != 0 && (no_color == nullptr || *no_color == '\0');
}

void AddArguments(CLI::App* app, Arguments* arguments) {
  soslam::InspectRequest* request = &arguments->request;
  app->add_option("FILE", request->file, "an artefact of any kind, JSON or HDF5")
      ->option_text("PATH")
      ->group("Files");
  const auto add_file = [&](const char* name, auto* path, const char* doc) {
    return app->add_option(name, *path, doc)->option_text("PATH")->group("Files");
  };
  add_file(
      "--sequence", &request->sequence,
      "sequence.json that the artefact was made from:\nfor labels of objects, and for pictures");
  CLI::Option* dataset =
      add_file("--dataset", &request->dataset, "dataset folder with the images, for pictures");
  CLI::Option* table =
      app->add_option("--table", request->table,
                      "this table alone, with all rows and what its columns are\n[default all "
                      "tables, shortened; with --csv the first one]");
  table->option_text("string")->group("Files");
  CLI::Option* csv = add_file("--csv", &request->csv,
                              "table to write as CSV, in full precision; - for standard output");
  CLI::Option* headline = app->add_flag(
      "--headline", request->headline,
      "one line instead, of map.json, for scripts: how many objects\nit has, how "
      "well its scale is known, and whether up is in\ndoubt; and one more where the map "
      "should not be trusted; reads\nsequence.json, "
      "associations.json and world.json beside it");
  headline->option_text(" ")->group("Files");
  CLI::Option* image = add_file(
      "--image", &request->image,
      "picture to write (.png): of sequence, landmarks and map\nthe boxes, landmarks and "
      "ground truth of a frame; of edges\nits maps; of symmetry the pairs of an observation");
  for (CLI::Option* option : {dataset, table, csv, image}) headline->excludes(option);
  const auto add_option = [&](const char* name, auto* value, const char* type, const char* doc) {
    CLI::Option* option = app->add_option(name, *value, doc);
    option->option_text(type)->excludes(headline)->group("Options");
    return option;
  };
  add_option("--frame", &request->frame_id, "integer", "id of the frame of the picture");
  add_option("--object", &request->object_id, "integer",
             "id of an object: its rows alone; of a picture of symmetry its object");
  add_option(
      "--layer", &arguments->layer, "string",
      "what of edges is in the picture\n[default all; one of all, grey, edges, distance, nearest]")
      ->check(CLI::IsMember(std::vector<std::string>(soslam::kEdgeLayerNames.begin(),
                                                     soslam::kEdgeLayerNames.end())));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Shows an artefact of the pipeline to a person: in words, as a table, as a picture.",
               "soslam-inspect");
  return soslam::internal::RunForExitCode(&app, [&] {
    Arguments arguments;
    app.get_formatter()->column_width(34);
    soslam::internal::AddOutsidePaths(&app);
    soslam::internal::AddHelpAndVersion(&app);
    AddArguments(&app, &arguments);
    CLI::App* diff = app.add_subcommand("diff", "Lists where two artefacts of one kind differ.");
    const auto add_file = [&](const char* name, std::string* path, const char* doc) {
      diff->add_option(name, *path, doc)
          ->option_text("PATH (required)")
          ->required()
          ->group("Files");
    };
    add_file("ONE", &arguments.one, "an artefact");
    add_file("TWO", &arguments.two, "another one of its kind");
    diff->add_option("--tolerance", arguments.tolerance,
                     "numbers are equal that differ by no more,\ntimes the larger of the two and "
                     "1\n[default 1e-9; 0 or more]")
        ->check(CLI::NonNegativeNumber)
        ->option_text("number")
        ->group("Options");
    diff->footer(HelpFooter("Example:\n  soslam-inspect diff one/map.json two/map.json"));
    app.footer(HelpFooter(kExamples));
    app.parse(argc, argv);
    if (diff->parsed()) {
      const soslam::Differences differences =
          soslam::CompareArtefacts(arguments.one, arguments.two, arguments.tolerance);
      fmt::print("{}", FormatDifferences(differences, arguments.tolerance, IsColoured()));
      return differences.content.empty() ? static_cast<int>(soslam::ExitCode::kDone)
                                         : soslam::kFindings;
    }
    if (arguments.request.file.empty()) throw CLI::RequiredError("FILE");
    const auto layer = std::ranges::find(soslam::kEdgeLayerNames, arguments.layer);
    arguments.request.layer =
        static_cast<soslam::EdgeLayer>(layer - soslam::kEdgeLayerNames.begin());
    fmt::print("{}", RunInspect(arguments.request, IsColoured()));
    return static_cast<int>(soslam::ExitCode::kDone);
  });
}
