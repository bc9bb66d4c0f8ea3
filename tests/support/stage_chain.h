// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "support/saved_folder.h"
#include "support/small_pipeline.h"

namespace soslam {

// Runs stages one by one, each on what those before it wrote into folder "chain".
class StageChain {
 public:
  inline static const std::vector<std::string> kStages = {"import", "edges", "initialise", "refine",
                                                          "optimise"};

  StageChain() { std::filesystem::create_directory(pipeline_.Folder() / "chain"); }

  const SmallPipeline& pipeline() const { return pipeline_; }
  std::filesystem::path Dataset(const std::string& file) const {
    return pipeline_.Dataset() / file;
  }
  std::filesystem::path Artefact(const std::string& file) const {
    return pipeline_.Folder() / "chain" / file;
  }
  static std::string OutputOf(const std::string& stage) {
    static const std::map<std::string, std::string> outputs = {{"import", "sequence.json"},
                                                               {"edges", "edges.h5"},
                                                               {"initialise", "initial.json"},
                                                               {"refine", "refined.json"},
                                                               {"optimise", "map.json"}};
    return outputs.at(stage);
  }

  CommandResult Run(const std::string& stage) const {
    const auto artefact = [this](const std::string& file) { return Artefact(file).string(); };
    std::vector<std::string> words = {
        StageProgram(stage), "--quiet", "--threads", "2", "--output", artefact(OutputOf(stage))};
    const auto add = [&](const std::string& argument, const std::string& path) {
      words.insert(words.end(), {"--" + argument, path});
    };
    if (stage == "import" || stage == "edges") add("dataset", pipeline_.Dataset().string());
    if (stage != "import") add("sequence", artefact("sequence.json"));
    if (stage == "initialise" || stage == "refine" || stage == "optimise") {
      add("table", pipeline_.SemanticTable().string());
    }
    if (stage == "refine") {
      add("initial", artefact("initial.json"));
      add("edges", artefact("edges.h5"));
      add("curves", artefact("symmetry.h5"));
    }
    if (stage == "optimise") add("landmarks", artefact("refined.json"));
    if (std::filesystem::exists(Artefact("settings.json")))
      add("settings", artefact("settings.json"));
    return RunCommand(words);
  }

  // A chain of which all stages ran, once for all tests that ask for it. Each finds it as they left
  // it.
  static const StageChain& Finished() {
    static const StageChain chain;
    static const SavedFolder saved = [] {
      for (const std::string& stage : kStages) {
        const CommandResult result = chain.Run(stage);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
      }
      return SavedFolder(chain.pipeline().Folder());
    }();
    saved.Restore();
    return chain;
  }

  // Runs all stages before this one; they have to succeed.
  void RunUpTo(const std::string& stage) const {
    for (auto earlier = kStages.begin(); *earlier != stage; ++earlier) {
      const CommandResult result = Run(*earlier);
      ASSERT_EQ(result.exit_code, 0) << result.errors;
    }
  }

 private:
  SmallPipeline pipeline_;
};

}  // namespace soslam
