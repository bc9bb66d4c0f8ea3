// SPDX-License-Identifier: BSD-3-Clause
#include "inspection/provenance.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "association/options.h"
#include "base/options.h"
#include "dataset/import_options.h"
#include "evaluation/alignment.h"
#include "image/edge_maps.h"
#include "initialisation/options.h"
#include "mapping/options.h"
#include "orientation/options.h"
#include "planes/options.h"
#include "priors/options.h"

namespace soslam {
namespace {

using nlohmann::json;

// A stage that writes artefacts of a kind.
struct Maker {
  const char* kind;
  const char* stage;
  json defaults;
};

const std::vector<Maker>& Makers() {
  static const std::vector<Maker> makers = {
      {"associations", "associate", OptionsToJson(AssociateOptions())},
      {"edges", "edges", OptionsToJson(EdgesOptions())},
      {"landmarks", "initialise", OptionsToJson(InitialiseOptions())},
      {"landmarks", "refine", OptionsToJson(OrientationOptions())},
      {"map", "optimise", OptionsToJson(OptimiseOptions())},
      {"metrics", "evaluate", OptionsToJson(EvaluateOptions())},
      {"planes", "planes", OptionsToJson(PlanesOptions())},
      {"semantic_table", "learn-priors", OptionsToJson(LearnPriorsOptions())},
      {"sequence", "import", OptionsToJson(ImportOptions())},
      {"sequence", "associate", OptionsToJson(AssociateOptions())},
      {"sequence", "planes", OptionsToJson(PlanesOptions())},
      {"symmetry", "refine", OptionsToJson(OrientationOptions())}};
  return makers;
}

// Headers do not name the stage. It is the one whose options share most names with the settings
// (older versions may have fewer).
const Maker* MakerOf(const std::string& kind, const json& settings) {
  const Maker* best = nullptr;
  size_t most = 0;
  for (const Maker& maker : Makers()) {
    if (maker.kind != kind) continue;
    size_t shared = 0;
    for (const auto& item : settings.items()) shared += maker.defaults.count(item.key());
    if (best == nullptr || shared > most) {
      best = &maker;
      most = shared;
    }
  }
  return best;
}

std::string SettingsInWords(const json& settings, const json& defaults) {
  std::vector<std::string> words;
  for (const auto& [name, value] : settings.items()) {
    const json standard = defaults.value(name, json());
    if (value == standard) continue;
    words.push_back(fmt::format("{} {}", name, value.dump()));
  }
  return words.empty() ? "all as by default" : fmt::format("{}", fmt::join(words, ", "));
}

// Lists inputs by name; if many have the same extension, such as images, by their number.
std::string InputsInWords(const json& inputs) {
  constexpr size_t kMaxNames = 6;
  std::map<std::string, std::vector<std::string>> by_extension;
  for (const json& input : inputs) {
    const std::string file = input.at("file");
    by_extension[std::filesystem::path(file).extension().string()].push_back(file);
  }
  std::vector<std::string> words;
  for (auto& [extension, files] : by_extension) {
    const size_t count = files.size();
    if (count > kMaxNames) {
      words.push_back(fmt::format("{} {} files", count, extension));
    } else {
      words.insert(words.end(), files.begin(), files.end());
    }
  }
  return words.empty() ? "none" : fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace

std::vector<Fact> Provenance(const json& header) {
  const json settings = header.value("settings", json::object());
  const std::string version =
      fmt::format("{}, schema version [{}]", header.value("software", "unknown software"),
                  fmt::join(header.at("schema_version").get<std::vector<int>>(), ", "));
  const Maker* maker = MakerOf(header.at("kind"), settings);
  if (maker == nullptr) return {{"made by", version}};
  return {{"made by", fmt::format("soslam-{} of {}", maker->stage, version)},
          {"from", InputsInWords(header.value("inputs", json::array()))},
          {"settings", SettingsInWords(settings, maker->defaults)}};
}

}  // namespace soslam
