// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <regex>

#include "soslam/artefact/json_file.h"
#include "support/schema_violation.h"
#include "support/small_pipeline.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

// All but inspect, which has no settings and arguments of its own.
std::vector<std::string> AllStages() {
  std::vector<std::string> stages;
  for (const auto& entry : fs::directory_iterator(SOSLAM_SOURCE_DIR "/stages")) {
    const std::string stage = entry.path().stem().string();
    if (stage != "inspect") stages.push_back(stage);
  }
  std::ranges::sort(stages);
  return stages;
}

class HelpTest : public testing::TestWithParam<std::string> {
 protected:
  static std::string Said(const std::string& argument) {
    return ExpectSuccess(RunCommand({StageProgram(GetParam()), argument}));
  }

  // Runs the stage with these settings on files that do not exist.
  CommandResult RunWith(const json& settings) const {
    WriteBytes(folder_ / "settings.json", settings.dump());
    std::vector<std::string> words = {StageProgram(GetParam()), "--settings",
                                      (folder_ / "settings.json").string()};
    const std::regex file_argument("\n  --(\\w+) PATH");
    const std::string arguments = help_.substr(0, help_.find("\nCommon:\n"));
    for (std::sregex_iterator i(arguments.begin(), arguments.end(), file_argument), end; i != end;
         ++i) {
      const std::string name = (*i)[1];
      words.insert(words.end(), {"--" + name, (folder_ / "nowhere" / name).string()});
    }
    return RunCommand(words);
  }

  TemporaryFolder folder_;
  const std::string help_ = Said("--help");
  const json schema_ = json::parse(Said("--settings_schema"));
};

TEST_P(HelpTest, SettingsThatTheSchemaTakesAreAccepted) {
  EXPECT_THAT(help_, HasSubstr("\nExample:\n  soslam-" + GetParam() + " "));
  json defaults = json::object();
  for (const auto& [name, property] : schema_["properties"].items()) {
    defaults[name] = property["default"];
    EXPECT_NE(property["description"], "") << name;
  }
  EXPECT_EQ(ViolationOf(defaults, schema_), std::nullopt);
  const CommandResult result = RunWith(defaults);
  EXPECT_THAT(result.errors, Not(HasSubstr("settings.json")));
  EXPECT_THAT(result.exit_code, testing::AnyOf(0, 2, 3, 4)) << result.errors;
}

std::string StageName(const testing::TestParamInfo<std::string>& info) {
  std::string name = info.param;
  std::erase(name, '-');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Stages, HelpTest, testing::ValuesIn(AllStages()), StageName);

}  // namespace
}  // namespace soslam
