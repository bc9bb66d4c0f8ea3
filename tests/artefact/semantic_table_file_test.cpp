// SPDX-License-Identifier: BSD-3-Clause
#include "artefact/semantic_table_file.h"

#include <gtest/gtest.h>

#include "base/error.h"
#include "support/expect_error.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;

// An entry as of before spreads and shapes.
const json kRatioOnly = {{"a_by_c", 2.0}, {"b_by_c", 0.5}, {"source", "the test"}};

class SemanticTableFileTest : public testing::Test {
 protected:
  SemanticTable Read(const json& table) const {
    WriteBytes(file_, table.dump());
    return ReadSemanticTable(file_);
  }
  // The error of a table whose only entry has one field set to a value.
  void ExpectRefused(const std::string& field, const json& value) const {
    json entry = kRatioOnly;
    entry[field] = value;
    ExpectError<InputError>(
        [&] {
          Read({{"labels", {{"cup", entry}}}});
        },
        {"table.json: /labels/cup/" + field + " is " + value.dump()});
  }

 private:
  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "table.json";
};

TEST_F(SemanticTableFileTest, ReadsRatioSpreadAndShape) {
  json entry = kRatioOnly;
  entry["a_by_c_log_sigma"] = 0.1;
  entry["b_by_c_log_sigma"] = 0.4;
  entry["shape_exponent"] = 2;
  const SemanticTable table = Read({{"labels", {{"cup", entry}}}});
  const ShapePrior cup = table.Find("cup").value();
  EXPECT_EQ(cup.ratio, Eigen::Vector2d(2.0, 0.5));
  EXPECT_EQ(cup.log_sigma, Eigen::Vector2d(0.1, 0.4));
  EXPECT_EQ(cup.shape_exponent, 2.0);
  EXPECT_FALSE(table.Find("bowl"));
}

TEST_F(SemanticTableFileTest, EntriesOfARatioOnlyAreNearlyBoxesWithATypicalSpread) {
  const SemanticTable table = Read({{"default", kRatioOnly}, {"labels", json::object()}});
  const ShapePrior any = table.Find("anything").value();
  EXPECT_EQ(any.ratio, Eigen::Vector2d(2.0, 0.5));
  EXPECT_EQ(any.log_sigma, Eigen::Vector2d(0.3, 0.3));
  EXPECT_EQ(any.shape_exponent, 1.1);
}

TEST_F(SemanticTableFileTest, WhatIsNoSpreadOrShapeIsRefused) {
  ExpectRefused("a_by_c_log_sigma", -0.1);
  ExpectRefused("b_by_c_log_sigma", 0);
  ExpectRefused("shape_exponent", 3);
  ExpectRefused("shape_exponent", 0.9);
}

TEST(SemanticTableTest, TheProjectsTableServesAnyLabel) {
  const SemanticTable table =
      ReadSemanticTable(SOSLAM_SOURCE_DIR "/pipelines/priors/semantic_table.json");
  const ShapePrior chair = table.Find("chair").value();
  EXPECT_LT(chair.ratio.maxCoeff(), 1.0) << "chairs are taller than wide";
  const ShapePrior unknown = table.Find("no such label").value();
  EXPECT_GT(unknown.log_sigma.minCoeff(), chair.log_sigma.maxCoeff());
}

}  // namespace
}  // namespace soslam
