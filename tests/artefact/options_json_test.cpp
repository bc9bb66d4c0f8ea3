// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/artefact/options_json.h"

#include <gtest/gtest.h>

#include <array>

#include "soslam/artefact/json_file.h"
#include "soslam/base/error.h"
#include "support/schema_violation.h"

namespace soslam {
namespace {

enum class Colour { kRed, kBlue };
constexpr std::array kColours = {"red", "blue"};

struct TestOptions {
  double size_m = 0.1;
  int count = 3;
  bool on = false;
  std::string name = "x";
  Colour colour = Colour::kRed;

  void Describe(OptionVisitor& visit) {
    visit.Real("size_m", &size_m, {0, 10}, "a size");
    visit.Integer("count", &count, {1, 5}, "a count");
    visit.Group("Others");
    visit.Flag("on", &on, "a flag");
    visit.Text("name", &name, "a name");
    visit.Choice("colour", &colour, kColours, "a colour");
  }
};

TEST(Options, ComeBackFromJson) {
  TestOptions options{0.25, 5, true, "y", Colour::kBlue};
  TestOptions read;
  OptionsFromJson(OptionsToJson(options), "test", &read);
  EXPECT_EQ(OptionsToJson(read), OptionsToJson(options));
  EXPECT_EQ(read.colour, Colour::kBlue);
}

TEST(Options, TakeAnIntegerWrittenAsANumber) {
  TestOptions options;
  OptionsFromJson({{"count", 5.0}}, "test", &options);
  EXPECT_EQ(options.count, 5);
}

// Both sides of every border, and every type in place of every other.
TEST(Options, TheSchemaTakesWhatTheyTake) {
  const nlohmann::json schema = SettingsSchema(OptionRows<TestOptions>(), "Settings");
  const nlohmann::json values = nlohmann::json::parse(
      R"([0, 1, 5, 6, 10, 10.5, -0.001, 2.5, 1e300, true, null, "", "red", "green", [], {}])");
  int taken = 0;
  for (const char* name : {"size_m", "count", "on", "name", "colour", "unheard_of"}) {
    for (const nlohmann::json& value : values) {
      const nlohmann::json settings = {{name, value}};
      bool is_taken = true;
      try {
        TestOptions options;
        OptionsFromJson(settings, "test", &options);
      } catch (const SettingsError& error) {
        is_taken = false;
        EXPECT_EQ(std::string(error.what()).find("test: "), 0u) << error.what();
      }
      taken += is_taken ? 1 : 0;
      EXPECT_EQ(!ViolationOf(settings, schema), is_taken) << settings;
    }
  }
  EXPECT_EQ(taken, 13);  // size_m 6, count 2, on 1, name 3, colour 1
  EXPECT_EQ(schema["properties"]["size_m"].value("unit", ""), "m");
  EXPECT_EQ(schema["properties"]["on"].value("group", ""), "Others");
}

// Options of two methods; `range` is used only with `search`, which is used only with method b.
struct MethodOptions {
  std::string method = "a";
  bool search = false;
  int range = 1;
  int steps = 2;

  void Describe(OptionVisitor& visit) {
    visit.Text("method", &method, "the method");
    visit.OnlyWhere({{"method", {"b", "c"}}}, [&] { visit.Flag("search", &search, "a flag"); });
    visit.OnlyWhere({{"search", {"true"}}}, [&] {
      visit.Integer("range", &range, {0, 9}, "a number");
      visit.OnlyWhere({{"method", {"a"}}, {"range", {"1"}}}, [&] {
        visit.Integer("steps", &steps, {0, 9}, "a number");
      });
    });
  }
};

TEST(Options, HaveAnEffectUnderTheirConditionsOnly) {
  const std::vector<OptionRow> rows = OptionRows<MethodOptions>();
  const auto unmet = [&](const MethodOptions& options, const char* name) {
    return InWords(UnmetConditions(rows, OptionsToJson(options), name));
  };
  EXPECT_EQ(unmet({}, "method"), "");
  EXPECT_EQ(unmet({}, "unheard_of"), "");
  EXPECT_EQ(unmet({}, "search"), "method = b or c");
  EXPECT_EQ(unmet({"c"}, "search"), "");
  EXPECT_EQ(unmet({"a", true}, "range"), "search = true");  // as search has no effect itself
  EXPECT_EQ(unmet({"c", true}, "range"), "");
  EXPECT_EQ(unmet({"c", true, 1}, "steps"), "");
  EXPECT_EQ(unmet({"c", true, 2}, "steps"), "method = a or range = 1");
  const nlohmann::json schema = SettingsSchema(rows, "Settings");
  EXPECT_EQ(schema["properties"]["steps"]["only_where"],
            nlohmann::json({"search = true", "method = a or range = 1"}));
  EXPECT_FALSE(schema["properties"]["method"].contains("only_where"));
}

TEST(Options, ChangesOfSettingsAreNamed) {
  EXPECT_EQ(SettingChanges({{"a", 1}, {"b", "x"}, {"c", 3}}, {{"a", 2}, {"b", "x"}, {"d", true}}),
            (std::vector<std::string>{"a: 1 -> 2", "c: 3 -> absent", "d: absent -> true"}));
}

}  // namespace
}  // namespace soslam
