// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/artefact/files.h"
#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/lists.h"
#include "support/temporary_folder.h"

namespace soslam {
namespace {

using nlohmann::json;

// An entry as of before spreads and shapes.
const json kRatioOnly = {{"a_by_c", 2.0}, {"b_by_c", 0.5}, {"source", "the test"}};

class SemanticTableFileTest : public FolderTest {
 protected:
  SemanticTable Read(const json& table) const {
    WriteBytes(file_, table.dump());
    return ReadSemanticTable(file_);
  }
  void ExpectRefused(const json& labels, const std::vector<std::string>& words) const {
    ExpectError<InputError>([&] { Read(json{{"labels", labels}}); }, words);
  }

  std::filesystem::path file_ = folder_ / "table.json";
};

TEST_F(SemanticTableFileTest, EntriesOfARatioOnlyAreNearlyBoxesWithATypicalSpread) {
  const SemanticTable table = Read({{"default", kRatioOnly}, {"labels", json::object()}});
  const ShapePrior any = table.Find("anything").value();
  EXPECT_EQ(any.ratio, Eigen::Vector2d(2.0, 0.5));
  EXPECT_EQ(any.log_sigma, Eigen::Vector2d(0.3, 0.3));
  EXPECT_EQ(any.shape_exponents, 1.1);
}

TEST_F(SemanticTableFileTest, TheVerticalExponentIsThatOfTheSectionsUnlessGiven) {
  json can = kRatioOnly;
  can["shape_exponent"] = 2.0;
  json ball = can;
  can["vertical_exponent"] = 1.0;
  const SemanticTable table = Read({{"labels", {{"can", can}, {"ball", ball}}}});
  EXPECT_EQ(table.Find("can")->shape_exponents, ShapeExponents(2.0, 1.0));
  EXPECT_EQ(table.Find("ball")->shape_exponents, 2.0);
}

TEST_F(SemanticTableFileTest, FindsLabelsByAliasHoweverTheyAreWritten) {
  json entry = kRatioOnly;
  entry["aliases"] = {"television set", "TV"};
  const SemanticTable table = Read({{"labels", {{"tv monitor", entry}}}});
  for (const char* label : {"tv monitor", "tvmonitor", "TV_Monitor", "Tv-Monitor", "tv",
                            "Television Set", " television_set"}) {
    EXPECT_TRUE(table.Contains(label)) << label;
    EXPECT_TRUE(table.Find(label)) << label;
  }
  EXPECT_FALSE(table.Contains("television"));
}

TEST_F(SemanticTableFileTest, TheSameNameTwiceIsRefused) {
  json entry = kRatioOnly;
  entry["aliases"] = {"Coffee_Cup"};
  ExpectRefused({{"mug", entry}, {"coffee cup", kRatioOnly}},
                {"table.json: /labels/mug", "Coffee_Cup", "'coffee cup'", "each name once"});
  ExpectRefused({{"mug", kRatioOnly}, {"Mug", kRatioOnly}}, {"table.json", "ug'"});
}

TEST_F(SemanticTableFileTest, ImpossibleNumbersAreRefused) {
  for (const auto& [field, value] :
       std::vector<std::pair<const char*, json>>{{"a_by_c_log_sigma", -0.1},
                                                 {"b_by_c_log_sigma", 0},
                                                 {"shape_exponent", 3},
                                                 {"shape_exponent", 0.9},
                                                 {"vertical_exponent", 2.1},
                                                 {"height_m", 0},
                                                 {"height_log_sigma", 0},
                                                 {"log_correlation", 1},
                                                 {"samples", -1},
                                                 {"edge_bias", 0.1},
                                                 {"attitude", "upside_down"},
                                                 {"edge_bias", {0.1, 0.1, 0.1}}}) {
    json entry = kRatioOnly;
    entry[field] = value;
    ExpectRefused({{"cup", entry}},
                  {"table.json: /labels/cup/" + std::string(field) + " is " + value.dump()});
  }
  json entry = kRatioOnly;
  entry["edge_bias"] = {0.0, 0.0, 0.0, 0.5};  // two of these would leave no box
  ExpectRefused({{"cup", entry}}, {"table.json: /labels/cup/edge_bias/3 is 0.5"});
}

TEST_F(SemanticTableFileTest, WhatIsMountedCannotLie) {
  json entry = kRatioOnly;
  entry["attitude"] = "any_face";
  EXPECT_EQ(Read({{"labels", {{"cup", entry}}}}).Find("cup")->attitude, Attitude::kAnyFace);
  entry["mount"] = "on_wall";
  ExpectError<InputError>(
      [&] {
        Read({{"labels", {{"cup", entry}}}});
      },
      {"table.json: /labels/cup: attitude is any_face and mount on_wall"});
}

TEST_F(SemanticTableFileTest, TheFrontOfWhatIsOnAWallIsNotAlongX) {
  json entry = kRatioOnly;
  EXPECT_FALSE(Read({{"labels", {{"tv", entry}}}}).Find("tv")->has_front);
  entry["has_front"] = true;
  EXPECT_TRUE(Read({{"labels", {{"tv", entry}}}}).Find("tv")->has_front);
  entry["mount"] = "on_wall";
  ExpectRefused({{"tv", entry}}, {"table.json: /labels/tv: has_front is true and mount on_wall"});
}

TEST_F(SemanticTableFileTest, WhatIsNoTableIsRefusedByName) {
  for (const json& document : {json(), json::array({kRatioOnly}), json("chair"), json(3)}) {
    ExpectError<InputError>([&] { Read(document); }, {"table.json: the document is "});
  }
  ExpectError<InputError>(
      [&] {
        Read({{"artefact", json::array()}, {"labels", {{"cup", kRatioOnly}}}});
      },
      {"table.json: has no artefact header"});
  ExpectError<InputError>(
      [&] {
        Read({{"labels", {{"", {{"a_by_c", 1.0}}}}}});
      },
      {"/labels/ has no field"});
}

TEST_F(SemanticTableFileTest, WrittenRowsAreReadAsTheyWere) {
  SemanticRow cup = {
      "cup", {"mug"}, {{1.2, 0.9}, {0.1, 0.2}, 1.4, 0.5, LogNormal{0.1, 0.3}}, 7, "the test"};
  cup.prior.attitude = Attitude::kFree;
  cup.prior.has_front = true;
  cup.prior.edge_bias = {-0.02, 0.0, 0.01, -0.15};
  const SemanticRow any = {"default", {}, {{1.0, 1.0}, {0.5, 0.5}, 1.1}, 0, "no preference"};
  WriteSemanticRows(file_, {"about cups", any, {cup}}, {});
  const SemanticRows rows = ReadSemanticRows(file_);
  EXPECT_EQ(rows.description, "about cups");
  const SemanticRow row = Only(rows.rows);
  EXPECT_EQ(row.label, "cup");
  EXPECT_EQ(row.aliases, cup.aliases);
  EXPECT_EQ(row.prior.ratio, cup.prior.ratio);
  EXPECT_EQ(row.prior.log_sigma, cup.prior.log_sigma);
  EXPECT_EQ(row.prior.log_correlation, 0.5);
  EXPECT_EQ(row.prior.height_m.value().log_sigma, 0.3);
  EXPECT_EQ(row.prior.attitude, Attitude::kFree);
  EXPECT_TRUE(row.prior.has_front);
  EXPECT_EQ(row.prior.edge_bias, cup.prior.edge_bias);
  EXPECT_EQ(row.samples, 7);
  EXPECT_EQ(row.source, "the test");
  EXPECT_EQ(rows.default_row.value().prior.shape_exponents, 1.1);
  for (const char* field : {"edge_bias", "has_front"}) {
    EXPECT_FALSE(json::parse(FileBytes(file_)).at("default").contains(field)) << field;
  }
}

TEST_F(SemanticTableFileTest, ArtefactsOfAnotherKindAreRefused) {
  WriteBytes(file_, R"({"artefact": {"kind": "map", "schema_version": [1, 0]}, "labels": {}})");
  ExpectError<InputError>([&] { ReadSemanticTable(file_); }, {"table.json", "\"map\""});
}

TEST(SemanticTableTest, TheProjectsTableKnowsWhatIsIndoorsAndOnRoads) {
  const std::filesystem::path file = SOSLAM_SOURCE_DIR "/pipelines/priors/semantic_table.json";
  const SemanticTable table = ReadSemanticTable(file);
  for (const char* label :
       {"backpack", "sports ball", "cup", "banana", "chair", "couch", "diningtable", "tvmonitor",
        "washing_machine", "trash can", "Car", "Van", "Truck", "Pedestrian", "Cyclist", "person"}) {
    EXPECT_TRUE(table.Contains(label)) << label;
  }
  for (const SemanticRow& row : ReadSemanticRows(file).rows) {
    EXPECT_GE(row.source.size(), 10u) << row.label;
    EXPECT_TRUE(row.prior.height_m) << row.label;
  }
}

TEST(SemanticTableTest, TheProjectsTableIsWhatWasStatedAndMore) {
  const std::filesystem::path folder = SOSLAM_SOURCE_DIR "/pipelines/priors";
  const SemanticTable table = ReadSemanticTable(folder / "semantic_table.json");
  for (const SemanticRow& row : ReadSemanticRows(folder / "base_table.json").rows) {
    const ShapePrior prior = table.Find(row.label).value();
    EXPECT_EQ(prior.ratio, row.prior.ratio) << row.label;
    EXPECT_EQ(prior.log_sigma, row.prior.log_sigma) << row.label;
    EXPECT_EQ(prior.shape_exponents, row.prior.shape_exponents) << row.label;
    EXPECT_EQ(prior.has_front, row.prior.has_front) << row.label;
    if (row.prior.height_m) {
      EXPECT_EQ(prior.height_m->median, row.prior.height_m->median) << row.label;
    }
  }
}

TEST(SemanticTableTest, TheProjectsTablesAgreeOnWhatHasAFront) {
  const std::filesystem::path folder = SOSLAM_SOURCE_DIR "/pipelines/priors";
  for (const char* file :
       {"semantic_table.json", "coco_boxes/all.json", "coco_boxes/without_fr1.json",
        "coco_boxes/without_fr2_desk.json", "coco_boxes/without_icl.json"}) {
    const SemanticTable table = ReadSemanticTable(folder / file);
    for (const char* label : {"chair", "couch", "bed", "tv", "laptop", "keyboard", "refrigerator",
                              "oven", "microwave", "toilet", "car", "truck", "bus", "person"}) {
      EXPECT_TRUE(table.Find(label)->has_front) << file << ": " << label;
    }
    for (const char* label : {"dining table", "bottle", "cup", "vase", "sports ball", "book",
                              "potted plant", "picture", "no such label"}) {
      EXPECT_FALSE(table.Find(label)->has_front) << file << ": " << label;
    }
  }
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
