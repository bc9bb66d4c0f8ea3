// SPDX-License-Identifier: BSD-3-Clause
// The command line of soslam-inspect: exit codes and what goes to standard output.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/artefact/files.h"
#include "support/random_estimates.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

using testing::HasSubstr;

class InspectProgramTest : public testing::Test {
 protected:
  InspectProgramTest() {
    WriteMap(one_, map_, sequence_, {});
    map_.solver.iterations += 1;
    WriteMap(two_, map_, sequence_, {});
  }
  static CommandResult Run(std::vector<std::string> words) {
    words.insert(words.begin(), StageProgram("inspect"));
    return RunCommand(words);
  }

  TemporaryFolder folder_;
  Sequence sequence_ = RandomSequence();
  MapEstimate map_ = RandomMap();
  std::string one_ = (folder_ / "one.json").string();
  std::string two_ = (folder_ / "two.json").string();
};

TEST_F(InspectProgramTest, DiffTellsByItsExitCode) {
  ExpectSuccess(Run({"diff", one_, one_}));
  EXPECT_THAT(ExpectExit(1, Run({"diff", one_, two_})).output, HasSubstr("/solver/iterations"));
  ExpectSuccess(Run({"diff", one_, two_, "--tolerance", "0.5"}));
}

TEST_F(InspectProgramTest, ErrorsHaveTheirExitCodesAndOneLine) {
  const std::string readme = SOSLAM_SOURCE_DIR "/README.md";
  const std::vector<std::pair<std::vector<std::string>, int>> calls = {
      {{}, 2},
      {{one_, "--frame", "x"}, 2},
      {{one_, "--layer", "x"}, 2},
      {{"diff", one_}, 2},
      {{"diff", one_, two_, "--tolerance", "-1"}, 2},
      {{one_, "--csv", (folder_ / "missing/table.csv").string()}, 2},
      {{readme}, 3},
      {{"diff", one_, readme}, 3}};
  for (const auto& [words, exit_code] : calls) {
    const CommandResult result = ExpectExit(exit_code, Run(words));
    EXPECT_THAT(result.errors, testing::StartsWith("soslam-inspect: error: "));
    EXPECT_EQ(std::ranges::count(result.errors, '\n'), 1);
    EXPECT_EQ(result.output, "");
  }
}

}  // namespace
}  // namespace soslam
