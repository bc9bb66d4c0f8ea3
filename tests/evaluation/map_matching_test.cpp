// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "evaluation/map_quality.h"
#include "support/random.h"

namespace soslam {
namespace {

// The best sum over all ways to match the rows from `row` on.
double BestSum(const Eigen::MatrixXd& ious, double min_iou, Eigen::Index row,
               std::vector<bool> taken) {
  if (row == ious.rows()) return 0.0;
  double best = BestSum(ious, min_iou, row + 1, taken);
  for (Eigen::Index column = 0; column < ious.cols(); ++column) {
    const auto place = static_cast<size_t>(column);
    if (taken[place] || ious(row, column) < min_iou) continue;
    taken[place] = true;
    best = std::max(best, ious(row, column) + BestSum(ious, min_iou, row + 1, taken));
    taken[place] = false;
  }
  return best;
}

TEST(MatchByIou, IsTheBestOfAllWays) {
  for (int trial = 0; trial < 100; ++trial) {
    Eigen::MatrixXd ious(trial % 6, (trial / 6) % 6);
    for (Eigen::Index i = 0; i < ious.size(); ++i) ious.data()[i] = RandomUniform(0.0, 1.0);
    const std::vector<int> matched = MatchByIou(ious, 0.25);
    double sum = 0.0;
    for (size_t row = 0; row < matched.size(); ++row) {
      if (matched[row] < 0) continue;
      const double iou = ious(static_cast<Eigen::Index>(row), matched[row]);
      EXPECT_GE(iou, 0.25);
      sum += iou;
    }
    const std::vector<bool> none(static_cast<size_t>(ious.cols()), false);
    EXPECT_NEAR(sum, BestSum(ious, 0.25, 0, none), 1e-12) << trial;
  }
}

TEST(IsIgnored, ByLabelOrVolumeOrBoth) {
  const Landmark volume{{}, {1.0, 1.0, 1.0}};
  const AlignedLandmark inside{
      0, 0, {{Eigen::Quaterniond::Identity(), {0.9, 0, 0}}, {0.4, 0.4, 0.4}}};
  const AlignedLandmark outside{
      0, 0, {{Eigen::Quaterniond::Identity(), {1.1, 0, 0}}, {0.4, 0.4, 0.4}}};
  const AlignedLandmark larger{0, 0, {{}, {1.5, 1.5, 1.5}}};       // IoU 8 / 27
  const AlignedLandmark much_larger{0, 0, {{}, {1.6, 1.6, 1.6}}};  // IoU 0.244
  const auto is_ignored = [](const std::vector<IgnoredThings>& ignored, const std::string& label,
                             const AlignedLandmark& landmark) {
    Sequence sequence;
    sequence.ignored = ignored;
    return IsIgnored(sequence, label, landmark);
  };
  EXPECT_TRUE(is_ignored({{std::nullopt, volume}}, "book", larger));
  EXPECT_FALSE(is_ignored({{std::nullopt, volume}}, "book", much_larger));
  EXPECT_TRUE(is_ignored({{"cup", std::nullopt}}, "cup", outside));
  EXPECT_TRUE(is_ignored({{"Teddy_Bear", std::nullopt}}, "teddy bear", outside));
  EXPECT_FALSE(is_ignored({{"cup", std::nullopt}}, "book", inside));
  EXPECT_TRUE(is_ignored({{std::nullopt, volume}}, "book", inside));
  EXPECT_FALSE(is_ignored({{std::nullopt, volume}}, "book", outside));
  EXPECT_FALSE(is_ignored({{"cup", volume}}, "book", inside));
  EXPECT_TRUE(is_ignored({{"cup", volume}, {"book", volume}}, "book", inside));
  EXPECT_FALSE(is_ignored({}, "book", inside));
}

TEST(IsIgnored, ByATrueObjectOfItsSegmentThatIs) {
  Sequence sequence;
  sequence.true_objects = {{1, "van", {Landmark{{}, {1.0, 1.0, 1.0}}}, 0, true, true}};
  AlignedLandmark landmark{0, 0, {{Eigen::Quaterniond::Identity(), {0.9, 0, 0}}, {0.4, 0.4, 0.4}}};
  EXPECT_TRUE(IsIgnored(sequence, "car", landmark));
  landmark.segment = 1;
  EXPECT_FALSE(IsIgnored(sequence, "car", landmark));
  landmark.segment = 0;
  sequence.true_objects[0].is_ignored = false;
  EXPECT_FALSE(IsIgnored(sequence, "car", landmark));
}

}  // namespace
}  // namespace soslam
