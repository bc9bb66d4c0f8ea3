// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/cli/command_line.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <new>

#include "soslam/artefact/json_file.h"
#include "soslam/artefact/options_json.h"
#include "soslam/base/error.h"
#include "support/folder_test.h"
#include "support/printed.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::StartsWith;

enum class Flavour { kPlain, kSpiced };
constexpr std::array kFlavourNames = {"plain", "spiced"};

struct TestOptions {
  double offset_m = 1.5;
  int count = 3;
  bool support = true;
  std::string note = "none";
  Flavour flavour = Flavour::kPlain;
  bool salt = false;

  void Describe(OptionVisitor& visit) {
    visit.Real("offset_m", &offset_m, {-10, 10}, "An offset");
    visit.Integer("count", &count, {0, 10}, "A count");
    visit.Flag("support", &support, "Use support");
    visit.Group("Taste (what it is like)");
    visit.Text("note", &note, "A note");
    visit.Choice("flavour", &flavour, kFlavourNames, "A flavour");
    visit.OnlyWhere({{"flavour", {"spiced"}}}, [&] { visit.Flag("salt", &salt, "Use salt"); });
  }
};

// What the stage under test was called with, and what it then does.
struct Recorded {
  TestOptions options;
  StageFiles files;
  int threads = 0;
  int calls = 0;
  std::function<void()> behaviour = [] {};
};
Recorded recorded;

void RunTest(const TestOptions& options, const StageFiles& files, int threads) {
  recorded.options = options;
  recorded.files = files;
  recorded.threads = threads;
  ++recorded.calls;
  recorded.behaviour();
}

class CommandLineTest : public FolderTest {
 protected:
  void SetUp() override { recorded = Recorded(); }

  // Runs the stage with its required files and these arguments; the exit code.
  int Run(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(),
                     {"--input", "in.json", "--output", (folder_ / "out.json").string()});
    return RunBare(arguments);
  }
  int RunBare(const std::vector<std::string>& arguments) {
    std::vector<const char*> argv = {"soslam-test"};
    for (const std::string& argument : arguments) argv.push_back(argument.c_str());
    const StageInfo info = {.name = "soslam-test",
                            .purpose = "Tests the command line.",
                            .inputs = {{"input", "The input"},
                                       {"extra", "More input", false},
                                       {"many", "As many inputs as you like", false, true}},
                            .outputs = {{"output", "The output", true, false, output_is_folder_}},
                            .example = "soslam-test --input a --output b"};
    int exit_code = -1;
    printed_ = PrintedBy([&] {
      exit_code =
          StageMain<TestOptions>(static_cast<int>(argv.size()), argv.data(), info, &RunTest);
    });
    return exit_code;
  }
  std::string WriteSettings(const std::string& text) const {
    return Write("settings.json", text).string();
  }
  void ExpectOneLineOfError(const std::string& part) {
    EXPECT_THAT(printed_.errors, StartsWith("soslam-test: error: "));
    EXPECT_THAT(printed_.errors, HasSubstr(part));
    EXPECT_EQ(std::ranges::count(printed_.errors, '\n'), 1) << printed_.errors;
  }

  bool output_is_folder_ = false;
  Printed printed_;
};

TEST_F(CommandLineTest, DefaultsFilesAndThreads) {
  EXPECT_EQ(Run({}), 0);
  EXPECT_EQ(OptionsToJson(recorded.options), OptionsToJson(TestOptions()));
  EXPECT_EQ(recorded.files.at("input"), "in.json");
  EXPECT_EQ(recorded.files.count("extra"), 0u);
  EXPECT_GE(recorded.threads, 1);
  EXPECT_EQ(Run({"--extra", "more.json", "--threads", "7"}), 0);
  EXPECT_EQ(recorded.files.at("extra"), "more.json");
  EXPECT_EQ(recorded.threads, 7);
}

TEST_F(CommandLineTest, SettingsWithoutEffectAreWarnedOf) {
  EXPECT_EQ(Run({"--salt", "true"}), 0);
  EXPECT_THAT(printed_.errors,
              testing::AllOf(StartsWith("soslam-test: warning: command line: salt = true has no "
                                        "effect; expected flavour = spiced; "),
                             testing::EndsWith("\n")));
  EXPECT_EQ(Run({"--salt", "true", "--flavour", "spiced"}), 0);
  EXPECT_EQ(printed_.errors, "");
  EXPECT_EQ(Run({"--settings", WriteSettings(R"({"salt": true})")}), 0);
  EXPECT_THAT(printed_.errors, HasSubstr("settings.json: salt = true has no effect"));
  // The pipeline writes all options, which nobody chose.
  EXPECT_EQ(Run({"--settings", WriteSettings(OptionsToJson(TestOptions()).dump())}), 0);
  EXPECT_EQ(printed_.errors, "");
  EXPECT_EQ(Run({"--settings", WriteSettings(R"({"salt": true, "offset_m": 1, "count": 1,
                                                 "support": true, "note": "five of six"})")}),
            0);
  EXPECT_THAT(printed_.errors, HasSubstr("settings.json: salt = true has no effect"));
  EXPECT_EQ(Run({"--help"}), 0);
  EXPECT_THAT(printed_.output, HasSubstr("[default false; true | false; only where flavour ="));
}

TEST_F(CommandLineTest, RepeatableFilesKeepTheirOrder) {
  EXPECT_EQ(Run({}), 0);
  EXPECT_TRUE(FilesOf(recorded.files, "many").empty());
  EXPECT_EQ(Run({"--many", "b.json", "a.json", "--count", "1", "--many", "c.json"}), 0);
  EXPECT_EQ(FilesOf(recorded.files, "many"), (std::vector<fs::path>{"b.json", "a.json", "c.json"}));
}

TEST_F(CommandLineTest, CommandLineWinsOverSettingsFileOverDefault) {
  const std::string settings = WriteSettings(R"({"count": 5, "offset_m": 2})");
  EXPECT_EQ(Run({"--settings", settings, "--count", "7"}), 0);
  EXPECT_EQ(recorded.options.count, 7);
  EXPECT_EQ(recorded.options.offset_m, 2.0);
  EXPECT_EQ(recorded.options.note, "none");
}

TEST_F(CommandLineTest, ReadsEveryType) {
  EXPECT_EQ(Run({"--offset_m", "-2.5", "--count=4", "--support", "false", "--note", "12",
                 "--flavour", "spiced"}),
            0);
  EXPECT_EQ(recorded.options.offset_m, -2.5);
  EXPECT_EQ(recorded.options.count, 4);
  EXPECT_FALSE(recorded.options.support);
  EXPECT_EQ(recorded.options.note, "12");
  EXPECT_EQ(recorded.options.flavour, Flavour::kSpiced);
}

TEST_F(CommandLineTest, FlagAloneMeansTrue) {
  const std::string settings = WriteSettings(R"({"support": false})");
  EXPECT_EQ(Run({"--settings", settings, "--support", "--count", "1"}), 0);
  EXPECT_TRUE(recorded.options.support);
  EXPECT_EQ(recorded.options.count, 1);
}

TEST_F(CommandLineTest, RefusesBadValuesByName) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"offset_m", "far"}, {"offset_m", "nan"}, {"offset_m", "11"},    {"offset_m", ""},
      {"count", "2.5"},    {"count", "-1"},     {"count", "4x"},       {"support", "maybe"},
      {"flavour", "mild"}, {"threads", "-1"},   {"threads", "twelve"}, {"unheard_of", "1"}};
  for (const auto& [name, value] : cases) {
    EXPECT_EQ(Run({"--" + name, value}), 2) << name << " " << value;
    ExpectOneLineOfError(name);
  }
  EXPECT_EQ(recorded.calls, 0);
}

TEST_F(CommandLineTest, RefusesBadSettingsFilesByName) {
  for (const char* text : {"", "{", "[1]", "3", R"({"count": "many"})", R"({"unheard_of": 1})",
                           R"({"count": 1, "count": 2})"}) {
    EXPECT_EQ(Run({"--settings", WriteSettings(text)}), 2) << text;
    ExpectOneLineOfError("settings.json");
  }
  EXPECT_EQ(Run({"--settings", (folder_ / "missing.json").string()}), 2);
  ExpectOneLineOfError("missing.json");
  EXPECT_EQ(recorded.calls, 0);
}

TEST_F(CommandLineTest, FilesThatAreMissingOrGivenTwiceAreWrongUsage) {
  EXPECT_EQ(Run({"--extra", "a.json", "--extra", "b.json"}), 2);
  ExpectOneLineOfError("extra");
  EXPECT_EQ(RunBare({"--input", "in.json"}), 2);
  ExpectOneLineOfError("--output");
  EXPECT_EQ(RunBare({}), 2);
  EXPECT_EQ(recorded.calls, 0);
}

TEST_F(CommandLineTest, MisspeltOptionIsNamedBeforeWhatIsMissing) {
  EXPECT_EQ(RunBare({"--input", "in.json", "--ouput", "out.json"}), 2);
  ExpectOneLineOfError("unknown option --ouput; did you mean --output?");
  EXPECT_EQ(RunBare({"--inptu=in.json", "--output", "out.json"}), 2);
  ExpectOneLineOfError("unknown option --inptu; did you mean --input?");
  EXPECT_EQ(Run({"--offset-m", "1"}), 2);
  ExpectOneLineOfError("unknown option --offset-m; did you mean --offset_m?");
  EXPECT_EQ(Run({"--unheard_of"}), 2);
  ExpectOneLineOfError("unknown option --unheard_of (see --help)");
  EXPECT_EQ(RunBare({"--ouput", "--help"}), 0);
  EXPECT_EQ(recorded.calls, 0);
}

TEST_F(CommandLineTest, HelpNamesEveryOptionUnderItsHeading) {
  EXPECT_EQ(RunBare({"--help"}), 0);
  for (const OptionRow& row : OptionRows<TestOptions>()) {
    EXPECT_THAT(printed_.output, HasSubstr("--" + row.name + " " + row.type));
    EXPECT_THAT(printed_.output, HasSubstr(row.doc));
  }
  for (const char* part :
       {"[default 1.5; -10 to 10 m]", "[default 3; 0 to 10]", "[default true; true | false]",
        "[default \"none\"]", "[default plain; plain | spiced]", "\nOptions:\n  --offset_m",
        "\nTaste (what it is like):\n  --note", "Tests the command line.", "--settings",
        "--threads", "\nExample:\n  soslam-test --input a --output b\n", "\nExit codes: 0"}) {
    EXPECT_THAT(printed_.output, HasSubstr(part));
  }
  for (const char* files : {"\nInputs:\n  --input.*\n  --extra.*\n  --many",
                            "\nOutputs:\n  --output PATH \\(required\\)"}) {
    EXPECT_THAT(printed_.output, testing::ContainsRegex(files));
  }
  EXPECT_EQ(printed_.errors, "");
  EXPECT_EQ(recorded.calls, 0);
}

TEST_F(CommandLineTest, FailureIsRecordedWhereItIsAskedFor) {
  const fs::path record = folder_ / "failed";
  EXPECT_EQ(Run({"--failure_record", record.string()}), 0);
  EXPECT_FALSE(fs::exists(record));
  recorded.behaviour = [] { throw InputError("a.json: this and\nthat"); };
  EXPECT_EQ(Run({"--failure_record", record.string()}), 3);
  EXPECT_EQ(FileBytes(record), "exit code 3: a.json: this and that\n");
}

TEST_F(CommandLineTest, Version) {
  EXPECT_EQ(RunBare({"--version"}), 0);
  EXPECT_THAT(printed_.output, testing::MatchesRegex("soslam-test [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(CommandLineTest, ErrorsBecomeExitCodesAndOneLine) {
  const std::vector<std::pair<int, std::function<void()>>> cases = {
      {2, [] { throw SettingsError("this and\nthat"); }},
      {3, [] { throw InputError("this"); }},
      {4, [] { throw NothingUsableError("this"); }},
      {5, [] { throw NumericalError("this"); }},
      {70, [] { throw std::logic_error("this"); }},
      {70, [] { throw std::bad_alloc(); }},
      {70, [] { throw 3; }}};
  for (const auto& [exit_code, behaviour] : cases) {
    recorded.behaviour = behaviour;
    EXPECT_EQ(Run({}), exit_code);
    ExpectOneLineOfError(exit_code == 70 ? "internal error: " : "this");
    EXPECT_FALSE(fs::exists(folder_ / "timing.json"));
  }
}

TEST_F(CommandLineTest, WritesTimingBesideTheOutput) {
  EXPECT_EQ(Run({"--threads", "3"}), 0);
  const nlohmann::json timing = ParseJsonFile(folder_ / "timing.json");
  EXPECT_EQ(timing["stage"], "soslam-test");
  EXPECT_EQ(timing["threads"], 3);
  EXPECT_GT(timing["cpu_s"].get<double>(), 0.0);
  EXPECT_GT(timing["peak_memory_mb"].get<double>(), 1.0);
  EXPECT_GE(timing["machine"]["cores"], 1);
}

TEST_F(CommandLineTest, TimingOfAnOutputFolderLiesInIt) {
  fs::create_directories(folder_ / "dataset");
  output_is_folder_ = true;
  EXPECT_EQ(RunBare({"--input", "in.json", "--output", (folder_ / "dataset").string()}), 0);
  EXPECT_TRUE(fs::exists(folder_.path() / "dataset" / "timing.json"));
}

}  // namespace
}  // namespace soslam
