// SPDX-License-Identifier: BSD-3-Clause
#include "base/options.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>

#include "base/error.h"
#include "support/expect_error.h"

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

TEST(Options, KeepWhatIsNotNamed) {
  TestOptions options;
  OptionsFromJson({{"count", 4}}, "test", &options);
  EXPECT_EQ(options.count, 4);
  EXPECT_EQ(options.size_m, 0.1);
}

TEST(Options, RefuseWhatTheyCannotTake) {
  const nlohmann::json cases = nlohmann::json::parse(R"([
    {"siz_m": 1}, {"size_m": "1"}, {"size_m": 11}, {"size_m": null}, {"count": 2.5}, {"count": 0},
    {"count": 3000000000}, {"on": 1}, {"name": 7}, {"colour": "green"}, {"colour": 1}, [], 3])");
  for (const auto& values : cases) {
    TestOptions options;
    ExpectError<SettingsError>([&] { OptionsFromJson(values, "the file", &options); },
                               {"the file"});
  }
  TestOptions options;
  EXPECT_THROW(
      OptionsFromJson({{"size_m", std::numeric_limits<double>::quiet_NaN()}}, "nan", &options),
      SettingsError);
}

TEST(Options, ListEveryOptionWithItsDomain) {
  const auto rows = OptionRows<TestOptions>();
  ASSERT_EQ(rows.size(), 5u);
  EXPECT_EQ(rows[0].name, "size_m");
  EXPECT_EQ(rows[0].default_value, "0.1");
  EXPECT_EQ(rows[0].domain, "0 to 10");
  EXPECT_EQ(rows[4].domain, "red | blue");
}

}  // namespace
}  // namespace soslam
