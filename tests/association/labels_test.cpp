// SPDX-License-Identifier: BSD-3-Clause
#include "association/labels.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/error.h"
#include "support/expect_error.h"

namespace soslam {
namespace {

const std::set<std::string> kLabels = {"bowl", "cup", "tv", "mouse"};

TEST(WinningLabelTest, HasTheLargestSumOfScores) {
  EXPECT_EQ(WinningLabel({{"bowl", 1.2}, {"cup", 1.5}, {"tv", 0.3}}), "cup");
  EXPECT_EQ(WinningLabel({{"cup", 1.0}, {"bowl", 1.0}}), "bowl");
}

TEST(LabelConfusionTest, CostsAreThoseOfProbabilitiesThatSumToOne) {
  const LabelConfusion confusion(kLabels, 0.06, "");
  double sum = 0.0;
  for (const std::string& label : kLabels) {
    sum += std::exp(-0.5 * confusion.Cost("cup", label));
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
  EXPECT_NEAR(std::exp(-0.5 * confusion.Cost("cup", "cup")), 0.94, 1e-12);
  EXPECT_NEAR(std::exp(-0.5 * confusion.CostOfAnyLabel()), 0.25, 1e-12);
}

TEST(LabelConfusionTest, WithoutConfusionLabelsKeepApart) {
  const LabelConfusion confusion(kLabels, 0.0, "");
  EXPECT_EQ(confusion.Cost("cup", "cup"), 0.0);
  EXPECT_TRUE(std::isinf(confusion.Cost("cup", "bowl")));
}

TEST(LabelConfusionTest, InterchangeableLabelsCountAsOne) {
  const LabelConfusion confusion(kLabels, 0.0, "cup, bowl;  tv,monitor ");
  EXPECT_EQ(confusion.Cost("cup", "bowl"), 0.0);
  EXPECT_EQ(confusion.Cost("monitor", "tv"), 0.0);
  EXPECT_TRUE(std::isinf(confusion.Cost("cup", "tv")));
  EXPECT_NEAR(confusion.CostOfAnyLabel(), 2.0 * std::log(3.0), 1e-12);
}

TEST(LabelConfusionTest, ASingleLabelCostsNothing) {
  const LabelConfusion confusion({"cup"}, 0.0, "");
  EXPECT_EQ(confusion.Cost("cup", "cup"), 0.0);
  EXPECT_EQ(confusion.CostOfAnyLabel(), 0.0);
}

TEST(LabelConfusionTest, MalformedGroupsAreRefused) {
  for (const std::string groups : {"cup,", ";", "cup,bowl;cup,tv", "cup,,tv", " "}) {
    ExpectError<SettingsError>([&] { LabelConfusion(kLabels, 0.1, groups); },
                               {"interchangeable_labels", groups});
  }
}

}  // namespace
}  // namespace soslam
