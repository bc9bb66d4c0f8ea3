// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/ground/scale_posterior.h"

#include <gtest/gtest.h>

#include <cmath>

#include "soslam/model/sequence.h"

namespace soslam {
namespace {

ScaleEvidence Object(double log_scale, double log_sigma, const std::string& label = "chair") {
  ScaleEvidence object;
  object.hypotheses = {{label, kNoPlane, log_scale, log_sigma, 1.0}};
  return object;
}

// An object that is hardly ever wrong.
ScaleEvidence SureObject(double log_scale, double log_sigma) {
  ScaleEvidence object = Object(log_scale, log_sigma);
  object.wrong_probability = 1e-9;
  return object;
}

ScalePosterior Posterior(const std::vector<ScaleEvidence>& objects,
                         const std::vector<KnownScale>& known = {}) {
  return EstimateScale(objects, known).value();
}

TEST(ScalePosteriorTest, HasTheSpreadOfOneObject) {
  const ScalePosterior posterior = Posterior({SureObject(0.7, 0.2)});
  EXPECT_NEAR(posterior.log_scale, 0.7, 0.003);
  EXPECT_NEAR(posterior.log_sigma, 0.2, 0.003);
  EXPECT_NEAR(posterior.low, 0.7 - 1.96 * 0.2, 0.01);
  EXPECT_NEAR(posterior.high, 0.7 + 1.96 * 0.2, 0.01);
  EXPECT_NEAR(posterior.trusted, std::erf(std::log(kTrustedScale) / 0.2 / std::sqrt(2.0)), 0.005);
}

TEST(ScalePosteriorTest, IndependentObjectsAddInformation) {
  std::vector<ScaleEvidence> objects;
  for (const double log_scale : {-0.1, 0.0, 0.0, 0.1}) {
    objects.push_back(SureObject(log_scale, 0.2));
  }
  const ScalePosterior posterior = Posterior(objects);
  EXPECT_NEAR(posterior.log_scale, 0.0, 0.003);
  EXPECT_NEAR(posterior.log_sigma, 0.1, 0.002);
  EXPECT_EQ(posterior.misfit, 1.0);
}

TEST(ScalePosteriorTest, AWrongHeightHasNoInfluence) {
  std::vector<ScaleEvidence> objects(5, Object(0.0, 0.1));
  objects.push_back(Object(1.5, 0.1));
  const ScalePosterior posterior = Posterior(objects);
  EXPECT_NEAR(posterior.log_scale, 0.0, 0.01);
  EXPECT_LT(posterior.agreement.back(), 0.01);
  EXPECT_GT(posterior.agreement.front(), 0.9);
}

TEST(ScalePosteriorTest, OtherObjectsDecideBetweenLabels) {
  ScaleEvidence chair_or_stool;
  chair_or_stool.hypotheses = {{"chair", kNoPlane, 0.0, 0.1, 0.5},
                               {"stool", kNoPlane, -1.0, 0.1, 0.5}};
  const ScalePosterior alone = Posterior({chair_or_stool});
  EXPECT_GT(alone.log_sigma, 0.45);
  EXPECT_GT(alone.second_mode_share, 0.4);
  const ScalePosterior together = Posterior({chair_or_stool, Object(0.1, 0.2), Object(-0.1, 0.2)});
  EXPECT_NEAR(together.log_scale, 0.0, 0.02);
  EXPECT_LT(together.log_sigma, 0.12);
  EXPECT_LT(together.second_mode_share, 0.05);
  EXPECT_GT(HypothesisProbabilities(chair_or_stool, together.log_scale)[0], 0.95);
}

TEST(ScalePosteriorTest, AKnownScaleIsCombinedAsANormalDistribution) {
  const ScalePosterior posterior = Posterior({SureObject(0.2, 0.2)}, {{0.0, 0.1}});
  EXPECT_NEAR(posterior.log_scale, 0.04, 0.003);
  EXPECT_NEAR(posterior.log_sigma, 0.2 * 0.1 / std::hypot(0.2, 0.1), 0.002);
}

TEST(ScalePosteriorTest, ContradictionsWidenIt) {
  std::vector<ScaleEvidence> objects;
  for (int i = 0; i < 10; ++i) objects.push_back(Object(i % 2 == 0 ? -0.2 : 0.2, 0.1));
  const ScalePosterior posterior = Posterior(objects);
  EXPECT_GT(posterior.misfit, 1.5);
  EXPECT_GT(posterior.log_sigma, 1.2 * 0.1 / std::sqrt(10.0));
}

TEST(ScalePosteriorTest, ObjectsOfOneLabelCountForLess) {
  std::vector<ScaleEvidence> objects(3, Object(0.0, 0.1, "chair"));
  objects.push_back(Object(0.0, 0.1, "sofa"));
  WeightSameLabels(0.5, &objects);
  EXPECT_NEAR(objects[0].weight, 0.5, 1e-12);
  EXPECT_NEAR(objects[3].weight, 1.0, 1e-12);
}

TEST(ScalePosteriorTest, IsNoneWithoutEvidence) {
  EXPECT_FALSE(EstimateScale({}, {}));
  EXPECT_FALSE(EstimateScale({ScaleEvidence()}, {}));
}

TEST(ScalePosteriorTest, PullsAreWhatTheScaleLosesWithoutAnObject) {
  ScaleEvidence low, high;
  low.hypotheses = {{"chair", kNoPlane, 0.0, 0.2}};
  high.hypotheses = {{"sofa", kNoPlane, 0.1, 0.1}};
  const auto both = EstimateScale({low, high}, {});
  EXPECT_NEAR(*both->pull[0], both->log_scale - EstimateScale({high}, {})->log_scale, 0.01);
  EXPECT_NEAR(*both->pull[1], both->log_scale - EstimateScale({low}, {})->log_scale, 0.01);
  EXPECT_EQ(EstimateScale({low}, {})->pull[0], std::nullopt);
}

}  // namespace
}  // namespace soslam
