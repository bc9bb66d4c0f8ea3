// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/association/labels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace soslam {
namespace {

const std::set<std::string> kLabels = {"bowl", "cup", "tv", "mouse"};

AssociateOptions Confusing(double any, const std::string& interchangeable, double similar = 0.0,
                           const std::string& similar_labels = "") {
  AssociateOptions options;
  options.label_confusion = any;
  options.interchangeable_labels = interchangeable;
  options.similar_label_confusion = similar;
  options.similar_labels = similar_labels;
  return options;
}

double Sum(const LabelConfusion& confusion, const std::string& of_object) {
  double sum = 0.0;
  for (const std::string& label : kLabels) sum += confusion.Probability(label, of_object);
  return sum;
}

TEST(LabelConfusionTest, ProbabilitiesSumToOne) {
  const LabelConfusion confusion(kLabels, Confusing(0.06, "", 0.1, "cup, bowl, mug; tv, laptop"));
  for (const std::string label : {"cup", "mouse"}) {
    EXPECT_NEAR(Sum(confusion, label), 1.0, 1e-12) << label;
  }
  EXPECT_NEAR(confusion.Probability("cup", "cup"), 0.84, 1e-12);
  EXPECT_NEAR(confusion.Probability("bowl", "cup"), 0.1, 1e-12);
  EXPECT_NEAR(confusion.Probability("mouse", "cup"), 0.03, 1e-12);
  EXPECT_NEAR(std::exp(-0.5 * confusion.CostOfAnyLabel()), 0.25, 1e-12);
}

TEST(LabelConfusionTest, WithoutConfusionLabelsKeepApart) {
  const LabelConfusion confusion(kLabels, Confusing(0.0, ""));
  EXPECT_EQ(confusion.Probability("cup", "cup"), 1.0);
  EXPECT_EQ(confusion.Probability("bowl", "cup"), 0.0);
  EXPECT_EQ(confusion.Candidates({{"cup", 1.0}}), std::vector<std::string>({"cup"}));
}

TEST(LabelConfusionTest, InterchangeableLabelsCountAsOne) {
  const LabelConfusion confusion(kLabels, Confusing(0.0, "cup, bowl;  tv,monitor "));
  EXPECT_EQ(confusion.Probability("bowl", "cup"), 1.0);
  EXPECT_EQ(confusion.Probability("tv", "monitor"), 1.0);
  EXPECT_EQ(confusion.Probability("tv", "cup"), 0.0);
  EXPECT_NEAR(confusion.CostOfAnyLabel(), 2.0 * std::log(3.0), 1e-12);
}

TEST(LabelConfusionTest, SimilarLabelsAreCandidatesAndCostMoreThanTheVotes) {
  const LabelConfusion confusion(kLabels, Confusing(0.05, "", 0.1, "cup, mug, bowl; tv, laptop"));
  const LabelVotes votes = {{"cup", 3.0}, {"mouse", 0.5}};
  EXPECT_EQ(confusion.Candidates(votes), std::vector<std::string>({"bowl", "cup", "mouse", "mug"}));
  EXPECT_LT(confusion.CostOfVotes(votes, "cup"), confusion.CostOfVotes(votes, "mug"));
  EXPECT_LT(confusion.CostOfVotes(votes, "mug"), confusion.CostOfVotes(votes, "tv"));
}

TEST(LabelConfusionTest, AnUncertainObjectHasTheMeanProbability) {
  const LabelConfusion confusion(kLabels, Confusing(0.06, ""));
  EXPECT_NEAR(confusion.Probability("cup", {{"cup", 0.5}, {"tv", 0.5}}), 0.5 * (0.94 + 0.02),
              1e-12);
}

}  // namespace
}  // namespace soslam
