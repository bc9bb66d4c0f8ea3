// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <sstream>

#include "artefact/json_file.h"
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

// One argument as --help shows it.
struct HelpEntry {
  std::string group;
  std::string value;  // "number", "PATH (required)"
  std::string text;   // with single spaces
};

// Adds the words of a line to a text.
void Append(const std::string& line, std::string* text) {
  std::istringstream words(line);
  for (std::string word; words >> word;) *text += (text->empty() ? "" : " ") + word;
}

// The arguments, by name, that --help lists.
std::map<std::string, HelpEntry> EntriesOf(const std::string& help) {
  constexpr size_t kTextColumn = 34;
  static const std::regex kHead(
      R"(^  --(\w+)(?: (number|integer|boolean|string|PATH(?: \.\.\.)?(?: \(required\))?))?)");
  std::map<std::string, HelpEntry> entries;
  std::string group;
  HelpEntry* entry = nullptr;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_search(line, match, kHead)) {
      entry = &entries[match[1]];
      entry->group = group;
      entry->value = match[2];
      Append(match.suffix(), &entry->text);
    } else if (line.rfind(std::string(kTextColumn, ' '), 0) == 0 && entry != nullptr) {
      Append(line, &entry->text);
    } else {
      entry = nullptr;
      if (!line.empty() && line.back() == ':') group = line.substr(0, line.size() - 1);
    }
  }
  return entries;
}

// What --help has to say of an option, from its schema.
std::string ExpectedText(const json& property) {
  std::string domain;
  if (property.contains("minimum")) {
    domain = fmt::format("; {} to {}", property["minimum"].get<double>(),
                         property["maximum"].get<double>());
    if (property.contains("unit")) domain += " " + property["unit"].get<std::string>();
  } else if (property.contains("enum")) {
    domain =
        fmt::format("; {}", fmt::join(property["enum"].get<std::vector<std::string>>(), " | "));
  } else if (property["type"] == "boolean") {
    domain = "; true | false";
  }
  const json& value = property["default"];
  return fmt::format("{} [default {}{}]", property["description"].get<std::string>(),
                     property.contains("enum") ? value.get<std::string>() : value.dump(), domain);
}

class HelpTest : public testing::TestWithParam<std::string> {
 protected:
  HelpTest() {
    const CommandResult help = RunCommand({StageProgram(GetParam()), "--help"});
    EXPECT_EQ(help.exit_code, 0) << help.errors;
    help_ = help.output;
    entries_ = EntriesOf(help_);
    const CommandResult schema = RunCommand({StageProgram(GetParam()), "--settings_schema"});
    EXPECT_EQ(schema.exit_code, 0) << schema.errors;
    schema_ = json::parse(schema.output);
  }

  // Runs the stage with these settings on files that do not exist.
  CommandResult RunWith(const json& settings) const {
    WriteBytes(folder_ / "settings.json", settings.dump());
    std::vector<std::string> words = {StageProgram(GetParam()), "--settings",
                                      (folder_ / "settings.json").string()};
    for (const auto& [name, entry] : entries_) {
      if (entry.group != "Inputs" && entry.group != "Outputs") continue;
      words.insert(words.end(), {"--" + name, (folder_ / "nowhere" / name).string()});
    }
    return RunCommand(words);
  }

  TemporaryFolder folder_;
  std::string help_;
  std::map<std::string, HelpEntry> entries_;
  json schema_;
};

TEST_P(HelpTest, SaysWhatTheStageIsForAndHowItEnds) {
  EXPECT_THAT(help_, testing::ContainsRegex("\n(Inputs|Outputs):\n  --"));
  EXPECT_THAT(help_, HasSubstr("\nCommon:\n"));
  EXPECT_THAT(help_, HasSubstr("\nExample:\n  soslam-" + GetParam() + " "));
  EXPECT_THAT(help_, HasSubstr("\nExit codes: 0 done; 2 "));
  for (const auto& [name, entry] : entries_) EXPECT_NE(entry.text, "") << name;
}

TEST_P(HelpTest, HasTheOptionsOfTheSchemaAndNoOthers) {
  std::map<std::string, HelpEntry> options = entries_;
  std::erase_if(options, [](const auto& entry) {
    const std::string& group = entry.second.group;
    return group == "Inputs" || group == "Outputs" || group == "Common";
  });
  EXPECT_EQ(options.size(), schema_["properties"].size());
  for (const auto& [name, property] : schema_["properties"].items()) {
    ASSERT_EQ(options.count(name), 1) << name;
    const HelpEntry& entry = options.at(name);
    EXPECT_EQ(entry.value, property["type"].get<std::string>()) << name;
    EXPECT_EQ(entry.group, property["group"].get<std::string>()) << name;
    EXPECT_EQ(entry.text, ExpectedText(property)) << name;
    EXPECT_FALSE(property["description"].get<std::string>().empty()) << name;
  }
}

TEST_P(HelpTest, SettingsThatTheSchemaTakesAreAccepted) {
  json defaults = json::object();
  for (const auto& [name, property] : schema_["properties"].items()) {
    defaults[name] = property["default"];
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
