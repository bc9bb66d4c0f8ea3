// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <locale>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "soslam/dataset/import_options.h"
#include "soslam/evaluation/alignment.h"
#include "soslam/image/edge_maps.h"
#include "soslam/initialisation/options.h"
#include "soslam/mapping/options.h"
#include "soslam/orientation/options.h"
#include "soslam/stage/stages.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

// Runs all stages in this process; what they write, without headers, which have the inputs' hashes.
class IndependenceTest : public testing::Test {
 protected:
  json Run() const {
    const fs::path folder = pipeline_.Folder();
    StageFiles files = {
        {"dataset", pipeline_.Dataset()},     {"sequence", folder / "sequence.json"},
        {"table", pipeline_.SemanticTable()}, {"edges", folder / "edges.h5"},
        {"initial", folder / "initial.json"}, {"curves", folder / "symmetry.h5"}};
    const auto to = [&](const std::string& name) {
      files["output"] = folder / name;
      return files;
    };
    RunImport({}, to("sequence.json"), 2);
    RunEdges({}, to("edges.h5"), 2);
    InitialiseOptions initialise;
    initialise.ratio_prior = RatioPrior::kGroundTruth;
    RunInitialise(initialise, to("initial.json"), 2);
    OrientationOptions refine;
    RunRefine(refine, to("refined.json"), 2);
    files["landmarks"] = folder / "refined.json";
    OptimiseOptions optimise;
    optimise.symmetry = true;
    RunOptimise(optimise, to("map.json"), 2);
    files["landmarks"] = folder / "map.json";
    RunEvaluate({}, to("metrics.json"), 2);

    json all;
    for (const char* name :
         {"sequence.json", "initial.json", "refined.json", "map.json", "metrics.json"}) {
      all[name] = json::parse(FileBytes(folder / name));
      all[name].erase("artefact");
    }
    return all;
  }

  // Deals the lines of a file out anew, those after its head.
  void ShuffleLines(const std::string& name) {
    std::istringstream stream(FileBytes(pipeline_.Dataset() / name));
    std::string head;
    std::getline(stream, head);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    const std::vector<std::string> before = lines;
    while (lines == before) std::ranges::shuffle(lines, random_);
    std::string text = head + "\n";
    for (const std::string& line : lines) text += line + "\n";
    WriteBytes(pipeline_.Dataset() / name, text);
  }

  SmallPipeline pipeline_{4};
  std::mt19937 random_{1};
};

TEST_F(IndependenceTest, OfTheOrderInWhichTheDatasetNamesThings) {
  const json expected = Run();
  for (const char* name : {"detections.csv", "odometry.txt", "groundtruth.txt"}) ShuffleLines(name);
  const fs::path objects = pipeline_.Dataset() / "objects.json";
  json list = json::parse(FileBytes(objects));
  std::ranges::reverse(list);
  WriteBytes(objects, list.dump());
  EXPECT_EQ(Run(), expected);
}

// 1.234,5 as in German.
class GermanNumbers : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST_F(IndependenceTest, OfTheLocale) {
  const json expected = Run();
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new GermanNumbers));
  std::ostringstream check;
  check << 1234.5;
  EXPECT_EQ(check.str(), "1.234,5");
  const json in_german = Run();
  std::locale::global(before);
  EXPECT_EQ(in_german, expected);
}

}  // namespace
}  // namespace soslam
