// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/page.h"
#include "report/page_html.h"

namespace soslam {
namespace {

using nlohmann::json;

constexpr size_t kPart = 10'000;  // bytes

json Variant(const char* name, const char* kind) {
  return {{"name", name},
          {"kind", kind},
          {"numbers_only", false},
          {"metrics", {{"summary", 1}, {"objects", json::array({1, 2})}}},
          {"outlines", std::string(kPart, 'x')}};
}

json Data() {
  json data = {{"notes", json::array()}, {"sequences", json::array()}};
  data["sequences"].push_back({{"frames", std::string(kPart, 'x')}, {"counts", 3}});
  data["symmetries"].push_back({{"curves", std::string(kPart, 'x')}, {"descriptors", 5}});
  for (const char* name : {"SVD", "OursP", "InitP"}) {
    const std::string kind = name[0] == 'S' ? "views" : name[0] == 'O' ? "map" : "frames";
    data["variants"].push_back(Variant(name, kind.c_str()));
  }
  return data;
}

json Fitted(size_t max_bytes) {
  json data = Data();
  FitPageData(
      max_bytes, [](const json& all) { return PageText(all).size(); }, &data);
  EXPECT_LE(PageText(data).size(), max_bytes + 200);  // the notes
  return data;
}

TEST(FitPageData, ChangesNothingThatFits) { EXPECT_EQ(Fitted(6 * kPart), Data()); }

TEST(FitPageData, LeavesOutCurvesFirst) {
  json expected = Data();
  expected["symmetries"][0]["curves"] = json::array();
  expected["notes"].push_back(
      "For lack of room the cost over yaw of single observations is left out.");
  EXPECT_EQ(Fitted(5 * kPart), expected);
}

TEST(FitPageData, ThenKeepsTheNumbersOfSingleFramesOnly) {
  const json data = Fitted(7 * kPart / 2);
  EXPECT_EQ(data["variants"][0], Variant("SVD", "views"));
  EXPECT_EQ(data["variants"][1], Variant("OursP", "map"));
  EXPECT_EQ(data["variants"][2]["numbers_only"], true);
  EXPECT_EQ(data["variants"][2]["metrics"]["summary"], 1);
  EXPECT_FALSE(data["variants"][2].contains("outlines"));
  EXPECT_EQ(data["notes"].back(), "For lack of room only the numbers of InitP are shown.");
  EXPECT_FALSE(data["sequences"][0]["frames"].empty());
}

TEST(FitPageData, KeepsNumbersWhateverHappens) {
  const json data = Fitted(1000);
  for (const json& variant : data["variants"]) EXPECT_EQ(variant["metrics"]["summary"], 1);
  EXPECT_EQ(data["symmetries"][0]["descriptors"], 5);
  EXPECT_EQ(data["sequences"][0]["counts"], 3);
  EXPECT_TRUE(data["sequences"][0]["frames"].empty());
}

}  // namespace
}  // namespace soslam
