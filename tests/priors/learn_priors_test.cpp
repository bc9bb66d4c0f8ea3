// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/priors/learn_priors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "soslam/base/error.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

using testing::HasSubstr;

// Things 2 m high whose ratios are exp(x) and exp(y).
PriorSource Things(const std::string& label, const std::vector<Eigen::Vector2d>& log_ratios) {
  PriorSource source{"the test", {}};
  for (const Eigen::Vector2d& log_ratio : log_ratios) {
    source.facts[label].half_axes.push_back(
        {std::exp(log_ratio.x()), std::exp(log_ratio.y()), 1.0});
  }
  return source;
}

SemanticRows OneCup() {
  ShapePrior cup{{1.0, 1.0}, {0.3, 0.3}, 1.4};
  return {"cups",
          SemanticRow{"default", {}, {{1, 1}, {0.5, 0.5}, 1.2}, 0, "guess"},
          {{"cup", {"mug"}, cup, 0, "guess"}}};
}

LearnPriorsOptions Keep() {
  LearnPriorsOptions options;
  options.base_rows = BaseRows::kKeep;
  return options;
}

TEST(LearnPriors, KeptRowsGainSizeAndNothingElse) {
  const SemanticRows learned = LearnPriors(OneCup(), {Things("cup", {{1.0, 1.0}})}, Keep());
  ASSERT_EQ(learned.rows.size(), 1u);
  const SemanticRow& cup = learned.rows[0];
  EXPECT_EQ(cup.prior.ratio, Eigen::Vector2d(1.0, 1.0));
  EXPECT_EQ(cup.prior.log_sigma, Eigen::Vector2d(0.3, 0.3));
  EXPECT_EQ(cup.prior.shape_exponents, 1.4);
  EXPECT_EQ(cup.samples, 0);
  EXPECT_NEAR(cup.prior.height_m.value().median, 2.0, 1e-4);
  // One object: the typical spread 0.3, and what the median may be off by.
  EXPECT_NEAR(cup.prior.height_m->log_sigma, 0.3 * std::sqrt(2.0), 1e-4);
  EXPECT_THAT(cup.source, HasSubstr("1 of the test"));
}

TEST(LearnPriors, KeptRowsKeepAStatedSize) {
  SemanticRows base = OneCup();
  base.rows[0].prior.height_m = {0.1, 0.2};
  const SemanticRows learned = LearnPriors(base, {Things("cup", {{1.0, 1.0}})}, Keep());
  EXPECT_EQ(learned.rows[0].prior.height_m->median, 0.1);
}

TEST(LearnPriors, UpdatedRowsMeetTheDataByTheirNumber) {
  // The row counts as one object: a third of the way is left after two, by an alias too.
  const SemanticRows learned =
      LearnPriors(OneCup(), {Things("Mug", {{0.6, 0.3}, {0.6, 0.3}})}, LearnPriorsOptions());
  ASSERT_EQ(learned.rows.size(), 1u);
  const SemanticRow& cup = learned.rows[0];
  EXPECT_NEAR(std::log(cup.prior.ratio.x()), 0.4, 1e-4);
  EXPECT_NEAR(std::log(cup.prior.ratio.y()), 0.2, 1e-4);
  // Squares 4 * 0.09 of the row, 0.01 of the floor, 1 * 2 / 3 * 0.36 of the shift, of 6 objects;
  // one more third for the median.
  EXPECT_NEAR(cup.prior.log_sigma.x(), std::sqrt((0.36 + 0.01 + 0.24) / 6.0 * 4.0 / 3.0), 1e-4);
  EXPECT_EQ(cup.samples, 2);
}

TEST(LearnPriors, ARowOfManyObjectsHardlyMoves) {
  SemanticRows base = OneCup();
  base.rows[0].samples = 99;
  const SemanticRows learned =
      LearnPriors(base, {Things("cup", {{1.0, 1.0}})}, LearnPriorsOptions());
  EXPECT_NEAR(std::log(learned.rows[0].prior.ratio.x()), 0.01, 1e-4);
}

TEST(LearnPriors, LabelsThatTheBaseLacksBecomeRows) {
  for (const LearnPriorsOptions& options : {Keep(), LearnPriorsOptions()}) {
    const SemanticRows learned =
        LearnPriors(OneCup(), {Things("bowl", {{0.5, 0.4}, {0.7, 0.6}})}, options);
    ASSERT_EQ(learned.rows.size(), 2u);
    EXPECT_EQ(learned.rows[0].label, "bowl");
    EXPECT_NEAR(std::log(learned.rows[0].prior.ratio.x()), 0.6, 1e-4);
    EXPECT_EQ(learned.rows[0].prior.shape_exponents, 1.2);  // the default's
    EXPECT_EQ(learned.rows[0].samples, 2);
    EXPECT_THAT(learned.rows[0].source, HasSubstr("2 of the test"));
  }
}

TEST(LearnPriors, ShapeExponentsAreTheirMean) {
  PriorSource source = Things("cup", {{0.0, 0.0}, {0.0, 0.0}});
  source.facts["cup"].shape_exponents = {{1.5, 1.0}, {1.8, 1.2}};
  const ShapeExponents learned =
      LearnPriors(OneCup(), {source}, LearnPriorsOptions()).rows[0].prior.shape_exponents;
  EXPECT_NEAR(learned.horizontal, 1.65, 1e-9);
  EXPECT_NEAR(learned.vertical, 1.1, 1e-9);
  EXPECT_EQ(LearnPriors(OneCup(), {source}, Keep()).rows[0].prior.shape_exponents, 1.4);
}

TEST(LearnPriors, CorrelationOfAllLabelsIsEverybodysUntilTheyShowTheirOwn) {
  std::vector<Eigen::Vector2d> on_a_line;
  for (int i = 0; i < 8; ++i) on_a_line.push_back({0.1 * i, 0.2 * i});
  SemanticRows base = OneCup();
  const SemanticRows learned = LearnPriors(base, {Things("bowl", on_a_line)}, Keep());
  EXPECT_EQ(learned.rows[0].prior.log_correlation, 0.95);  // at most
  EXPECT_EQ(learned.rows[1].prior.log_correlation, 0.95);
  EXPECT_EQ(learned.default_row->prior.log_correlation, 0.95);
  base.rows[0].prior.log_correlation = 0.5;  // stated: stays
  EXPECT_EQ(LearnPriors(base, {Things("bowl", on_a_line)}, Keep()).rows[1].prior.log_correlation,
            0.5);
}

TEST(LearnPriors, AmbiguousNamesAreRefused) {
  SemanticRows base = OneCup();
  base.rows[0].aliases.push_back("C_up");
  ExpectError<InputError>([&] { LearnPriors(base, {}, Keep()); }, {"C_up", "cup", "once"});
}

// A sequence with one cup of 0.2 x 0.1 x 0.4 m.
Sequence OneTrueCup() {
  GroundTruth truth;
  truth.landmark_in_world.half_axes = {0.1, 0.05, 0.2};
  Sequence sequence;
  sequence.name = "cups";
  sequence.objects = {{0, "cup", 0, truth}, {1, "cup", 0, {}}};
  return sequence;
}

// Their z is out of the wall.
TEST(SourceOfSequence, TakesThingsWithGroundTruthOffTheWall) {
  const ShapePrior cup{.mount = Mount::kOnWall};
  const PriorSource source = SourceOfSequence(OneTrueCup(), {{{"cup", cup}}, {}}, 1);
  EXPECT_EQ(source.name, "cups");
  EXPECT_THAT(source.facts.at("cup").half_axes,
              testing::ElementsAre(Eigen::Vector3d(0.2, 0.05, 0.1)));
  EXPECT_TRUE(source.facts.at("cup").shape_exponents.empty());  // no boxes
}

TEST(ExcludeObjects, DropsTheModelsThatAreInTheScene) {
  const std::vector<CatalogueModel> models = {{"a", "", {0.1, 0.05, 0.2}},
                                              {"rounded", "", {0.1003, 0.0498, 0.2}},
                                              {"other", "", {0.102, 0.05, 0.2}}};
  const auto left = ExcludeObjects(OneTrueCup(), {}, models);
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].name, "other");
}

TEST(ExcludeObjects, DropsTheModelsThatLieInTheScene) {
  Sequence sequence = OneTrueCup();
  sequence.objects[0].ground_truth->landmark_in_world.rests_on = RestingFace::kBack;
  const Landmark own = InOwnAxes(sequence.objects[0].ground_truth->landmark_in_world);
  EXPECT_TRUE(ExcludeObjects(sequence, {}, {{"lying", "", own.half_axes}}).empty());
}

TEST(ExcludeObjects, DropsTheModelsThatHangInTheScene) {
  const SemanticTable table{{{"cup", {.mount = Mount::kOnWall}}}, {}};
  EXPECT_TRUE(ExcludeObjects(OneTrueCup(), table, {{"on wall", "", {0.2, 0.05, 0.1}}}).empty());
}

TEST(PriorErrors, CountLogarithmsAndSigmas) {
  SemanticTable table;
  table.priors["cup"] = {{1.0, 0.25}, {0.5, 0.5}, 1.0};
  const auto errors = PriorErrors(OneTrueCup(), table);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NEAR(errors[0].log_error.x(), -std::log(2.0), 1e-12);
  EXPECT_NEAR(errors[0].normalised.x(), -2.0 * std::log(2.0), 1e-12);
  EXPECT_NEAR(errors[0].log_error.y(), 0.0, 1e-12);
}

}  // namespace
}  // namespace soslam
