// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "artefact/model_json.h"

namespace soslam {
namespace {

TEST(FindingsJsonTest, FindingsComeBackAsTheyWere) {
  const std::vector<Finding> findings = {
      {"a", Severity::kWarning, "found \u00fc", "expected", "cause", "remedy"},
      {"b", Severity::kError, "2 of 3", "all", "", "none"}};
  EXPECT_EQ(FindingsFromJson({{"findings", FindingsToJson(findings)}}), findings);
}

TEST(FindingsJsonTest, OlderArtefactsHaveNone) {
  EXPECT_THAT(FindingsFromJson(nlohmann::json::object()), testing::IsEmpty());
}

}  // namespace
}  // namespace soslam
