// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "priors/learn_priors.h"
#include "support/views_of_bodies.h"

namespace soslam {
namespace {

Sequence ViewsOfABody(double shape_exponent, int views, double disturbance) {
  Sequence sequence;
  const auto box_of = [&](const Box& outline) { return Disturbed(outline, disturbance); };
  AddViewsOfBody("thing", {0.5, 0.3, 0.4}, shape_exponent, views, box_of, &sequence);
  return sequence;
}

TEST(LearnShapeExponents, OfExactBoxesIsThatOfTheBody) {
  for (const double exponent : {1.0, 1.3, 1.6, 2.0}) {
    const auto learned = LearnShapeExponents(ViewsOfABody(exponent, 20, 0.0), 10);
    ASSERT_EQ(learned.size(), 1u);
    EXPECT_NEAR(learned.at(0), exponent, 0.011);  // the step of the search
  }
}

TEST(LearnShapeExponents, OfDisturbedBoxesIsNear) {
  EXPECT_NEAR(LearnShapeExponents(ViewsOfABody(1.5, 60, 0.02), 10).at(0), 1.5, 0.08);
}

TEST(LearnShapeExponents, NeedGroundTruthAndEnoughViews) {
  Sequence sequence = ViewsOfABody(1.5, 9, 0.0);
  EXPECT_TRUE(LearnShapeExponents(sequence, 10).empty());
  EXPECT_EQ(LearnShapeExponents(sequence, 1).size(), 1u);
  sequence.objects[0].ground_truth.reset();
  EXPECT_TRUE(LearnShapeExponents(sequence, 1).empty());
}

}  // namespace
}  // namespace soslam
