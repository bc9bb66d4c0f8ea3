// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/model/semantic_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/random.h"

namespace soslam {
namespace {

// A cup of 0.2 x 0.1 x 0.4 m with ground truth, the same without, and a whisk, with ground truth.
Sequence CupCupWhisk() {
  GroundTruth truth;
  truth.landmark_in_world.half_axes = {0.1, 0.05, 0.2};
  Sequence sequence;
  sequence.objects = {{0, "cup", 0, truth}, {1, "cup", 0, {}}, {2, "whisk", 0, truth}};
  return sequence;
}

const Eigen::Vector2d kTrueRatio(0.5, 0.25);
const ShapePrior kCup{{1.2, 0.9}, {0.1, 0.2}, 1.4};
const ShapePrior kDefault{{1.0, 2.0}, {0.5, 0.6}, 1.1};
const SemanticTable kCupsOnly{{{"cup", kCup}}, {}};
const SemanticTable kCupsAndDefault{{{"cup", kCup}}, kDefault};

MATCHER_P3(IsPrior, ratio, log_sigma, shape_exponents, "") {
  return arg && arg->ratio == ratio && arg->log_sigma == log_sigma &&
         arg->shape_exponents == shape_exponents;
}
testing::Matcher<const std::optional<ShapePrior>&> Is(const ShapePrior& prior) {
  return IsPrior(prior.ratio, prior.log_sigma, prior.shape_exponents);
}

using testing::ElementsAre;
using testing::Eq;

TEST(ObjectPriors, TableGivesTheLabelsEntryOrTheDefault) {
  EXPECT_THAT(ObjectPriors(CupCupWhisk(), kCupsOnly, RatioPrior::kTable),
              ElementsAre(Is(kCup), Is(kCup), Eq(std::nullopt)));
  EXPECT_THAT(ObjectPriors(CupCupWhisk(), kCupsAndDefault, RatioPrior::kTable),
              ElementsAre(Is(kCup), Is(kCup), Is(kDefault)));
}

TEST(ObjectPriors, KnowTheSizeOfTheirObject) {
  Sequence sequence = CupCupWhisk();
  sequence.objects[1].known_size.height_m = 0.7;
  const auto priors = ObjectPriors(sequence, kCupsAndDefault, RatioPrior::kTable);
  EXPECT_FALSE(priors[0]->known_length);
  EXPECT_EQ(priors[1]->Length()->length_m.median, 0.7);
}

// An object has a front if things of its most probable label have one.
TEST(SemanticTableTest, TheFrontOfAnUncertainLabelIsThatOfTheMostProbable) {
  ShapePrior chair = kCup;
  chair.has_front = true;
  const SemanticTable table{{{"cup", kCup}, {"chair", chair}}, {}};
  Object object;
  object.labels = {{"chair", 0.6}, {"cup", 0.4}};
  EXPECT_TRUE(table.Find(object)->has_front);
  object.labels = {{"cup", 0.6}, {"chair", 0.4}};
  EXPECT_FALSE(table.Find(object)->has_front);
}

// A picture, 0.03 m deep, 0.5 m wide and 0.4 m high, on a wall: its x is up, its z out of the wall.
TEST(TurnedToSupport, WhatIsOnAWallHasItsDepthAlongZ) {
  ShapePrior picture{{0.03 / 0.4, 0.5 / 0.4}, {0.3, 0.2}};
  picture.height_m = LogNormal{0.4, 0.4};
  picture.mount = Mount::kOnWall;
  const ShapePrior turned = TurnedToSupport(picture);
  EXPECT_NEAR(turned.ratio.x(), 0.4 / 0.03, 1e-12);
  EXPECT_NEAR(turned.ratio.y(), 0.5 / 0.03, 1e-12);
  EXPECT_NEAR(turned.height_m->median, 0.03, 1e-15);
  EXPECT_NEAR(turned.height_m->log_sigma, 0.5, 1e-15);
  picture.mount = Mount::kHanging;
  EXPECT_EQ(TurnedToSupport(picture).ratio, picture.ratio);
}

// Squared distance of a body's ratios from the prior's medians, in its spreads.
double NormalisedSquared(const ShapePrior& prior, const Eigen::Vector3d& half_axes) {
  const Eigen::Vector2d off =
      (half_axes.head<2>() / half_axes.z()).cwiseQuotient(prior.ratio).array().log();
  const Eigen::Vector2d sigmas = off.cwiseQuotient(prior.log_sigma);
  const double r = prior.log_correlation;
  return (sigmas.squaredNorm() - 2.0 * r * sigmas.prod()) / (1.0 - r * r);
}

// A cylinder that lies has no vertical axis to have other exponents about.
TEST(OnFace, ABodyThatLiesHasOneExponent) {
  ShapePrior can = kCup;
  can.shape_exponents = {2.0, 1.0};
  EXPECT_EQ(OnFace(can, RestingFace::kBottom).shape_exponents, can.shape_exponents);
  EXPECT_EQ(OnFace(can, RestingFace::kBack).shape_exponents, 1.5);
}

TEST(OnFace, ABodyIsAsLikelyHoweverItIsLaid) {
  for (int i = 0; i < 100; ++i) {
    ShapePrior prior{RandomVector(0.1, 3.0).head<2>(), RandomVector(0.05, 0.5).head<2>()};
    prior.log_correlation = RandomUniform(-0.9, 0.9);
    prior.mount = Mount::kOnWall;
    const Eigen::Vector3d upright = RandomVector(0.1, 3.0);
    const double expected = NormalisedSquared(prior, upright);
    EXPECT_NEAR(NormalisedSquared(TurnedToSupport(prior), upright.reverse()), expected, 1e-9);
    for (const RestingFace face : kRestingFaces) {
      const ShapePrior laid = OnFace(prior, face);
      EXPECT_NEAR(NormalisedSquared(laid, HalfAxesOnFace(upright, face)), expected, 1e-9);
      EXPECT_EQ(laid.rests_on, face);
    }
  }
}

TEST(OnPossibleFaces, AreThoseOfTheAttitude) {
  EXPECT_FALSE(OnPossibleFaces(std::nullopt).at(0).has_value());
  ShapePrior prior;
  prior.height_m = LogNormal{0.4, 0.3};
  prior.ratio = {0.5, 0.75};
  EXPECT_EQ(OnPossibleFaces(prior).size(), 1u);
  for (const Attitude attitude : {Attitude::kAnyFace, Attitude::kFree}) {
    prior.attitude = attitude;
    const auto laid = OnPossibleFaces(prior);
    ASSERT_EQ(laid.size(), 3u);
    for (size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(laid[i]->rests_on, kRestingFaces[i]);
      EXPECT_EQ(laid[i]->height_m->median, 0.4);
    }
  }
}

TEST(ObjectPriors, AreOfTheObjectsFrame) {
  SemanticTable table = kCupsOnly;
  table.priors["cup"].mount = Mount::kOnWall;
  const Eigen::Vector2d expected = TurnedToSupport(table.priors["cup"]).ratio;
  EXPECT_EQ(ObjectPriors(CupCupWhisk(), table, RatioPrior::kTable)[0]->ratio, expected);
  EXPECT_EQ(ObjectPriors(CupCupWhisk(), table, RatioPrior::kGroundTruth)[0]->ratio, kTrueRatio);
}

TEST(ObjectPriors, UnitKeepsSpreadAndShapeOfTheLabel) {
  const Eigen::Vector2d unit = Eigen::Vector2d::Ones();
  const ShapePrior cup{unit, kCup.log_sigma, kCup.shape_exponents};
  EXPECT_THAT(ObjectPriors(CupCupWhisk(), kCupsOnly, RatioPrior::kUnit),
              ElementsAre(Is(cup), Is(cup), Is(ShapePrior())));
  EXPECT_THAT(ObjectPriors(CupCupWhisk(), kCupsAndDefault, RatioPrior::kUnit),
              ElementsAre(Is(cup), Is(cup), Is({unit, kDefault.log_sigma, 1.1})));
}

TEST(ObjectPriors, GroundTruthIsSharpAndKeepsTheShapeOfTheLabel) {
  const Eigen::Vector2d sharp = Eigen::Vector2d::Constant(kTrueRatioLogSigma);
  const ShapePrior cup{kTrueRatio, sharp, 1.4};
  EXPECT_THAT(ObjectPriors(CupCupWhisk(), kCupsOnly, RatioPrior::kGroundTruth),
              ElementsAre(Is(cup), Eq(std::nullopt),
                          Is({kTrueRatio, sharp, ShapePrior().shape_exponents})));
  EXPECT_THAT(ObjectPriors(CupCupWhisk(), kCupsAndDefault, RatioPrior::kGroundTruth),
              ElementsAre(Is(cup), Eq(std::nullopt), Is({kTrueRatio, sharp, 1.1})));
}

TEST(ObjectPriors, ShapesCanBeTheSameForAll) {
  for (const auto& [shape, exponent] : {std::pair(ShapeSource::kCuboid, kCuboidExponent),
                                        std::pair(ShapeSource::kEllipsoid, kEllipsoidExponent)}) {
    const auto priors = ObjectPriors(CupCupWhisk(), kCupsAndDefault, RatioPrior::kTable, shape);
    const auto of_table = ObjectPriors(CupCupWhisk(), kCupsAndDefault, RatioPrior::kTable);
    for (size_t i = 0; i < priors.size(); ++i) {
      EXPECT_EQ(priors[i]->shape_exponents, exponent);
      EXPECT_EQ(priors[i]->ratio, of_table[i]->ratio);
      EXPECT_EQ(priors[i]->log_sigma, of_table[i]->log_sigma);
    }
    EXPECT_FALSE(ObjectPriors(CupCupWhisk(), kCupsOnly, RatioPrior::kTable, shape).back());
  }
}

TEST(MomentsOfMixture, HasTheHeightOfPriorsThatAgree) {
  ShapePrior fixed = kCup;
  fixed.height_m = LogNormal{0.8, 1e-9};
  const std::vector<WeightedPrior> thirds(3, {1.0 / 3.0, fixed});
  const auto height = MomentsOfMixture(thirds).height_m;
  ASSERT_TRUE(height);
  EXPECT_NEAR(height->median, 0.8, 1e-12);
  EXPECT_NEAR(height->log_sigma, 1e-9, 1e-12);
}

TEST(LabelsWithoutEntry, NamesThemWhateverTheDefault) {
  Sequence sequence = CupCupWhisk();
  EXPECT_TRUE(LabelsWithoutEntry(sequence, kCupsAndDefault).empty());  // nothing is detected
  sequence.frames.resize(1);
  for (int i = 0; i < 3; ++i) sequence.detections.push_back({0, i, 1.0, {}, {}, {}});
  EXPECT_THAT(LabelsWithoutEntry(sequence, kCupsAndDefault), ElementsAre("whisk"));
}

// Samples of the two labels, half and half, have these moments.
TEST(MixtureTest, HasTheMomentsOfItsLabels) {
  SemanticTable table;
  table.priors["cup"] = {{1.0, 2.0}, {0.1, 0.2}, 1.4, 0.5, LogNormal{0.1, 0.3}};
  table.priors["vase"] = {{4.0, 2.0}, {0.3, 0.2}, 1.6, -0.5, LogNormal{0.4, 0.1}};
  table.priors["cup"].edge_bias = {-0.02, 0.0, 0.04, -0.2};
  const double half_apart = 0.5 * std::log(4.0);
  Object object;
  object.label = "cup";
  object.labels = {{"cup", 0.5}, {"vase", 0.5}};
  const ShapePrior prior = table.Find(object).value();
  EXPECT_NEAR(prior.ratio.x(), 2.0, 1e-12);
  EXPECT_NEAR(prior.ratio.y(), 2.0, 1e-12);
  EXPECT_NEAR(prior.log_sigma.x(), std::sqrt(0.5 * (0.01 + 0.09) + half_apart * half_apart), 1e-12);
  EXPECT_NEAR(prior.log_sigma.y(), 0.2, 1e-12);
  const double covariance = 0.5 * (0.5 * 0.1 * 0.2 - 0.5 * 0.3 * 0.2);
  EXPECT_NEAR(prior.log_correlation * prior.log_sigma.prod(), covariance, 1e-12);
  EXPECT_EQ(prior.shape_exponents, 1.5);
  EXPECT_NEAR(prior.height_m->median, 0.2, 1e-12);
  EXPECT_NEAR(prior.height_m->log_sigma, std::sqrt(0.05 + half_apart * half_apart), 1e-12);
  EXPECT_EQ(prior.edge_bias, (EdgeBias{-0.01, 0.0, 0.02, -0.1}));
}

TEST(MixtureTest, OfOneLabelIsItsPrior) {
  SemanticTable table;
  table.priors["cup"] = {{1.0, 2.0}, {0.1, 0.2}, 1.4};
  table.priors["picture"] = {{0.1, 2.0}, {0.1, 0.2}, 1.0};
  table.priors["picture"].mount = Mount::kOnWall;
  Object object;
  object.label = "cup";
  object.labels = {{"cup", 0.6}, {"picture", 0.4}};  // of another mount
  EXPECT_EQ(table.Find(object)->ratio, table.Find("cup")->ratio);
  EXPECT_EQ(table.Find(object)->log_sigma, table.Find("cup")->log_sigma);
}

}  // namespace
}  // namespace soslam
