// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "soslam/priors/learn_priors.h"
#include "support/shape_exponents.h"
#include "support/views_of_bodies.h"

namespace soslam {
namespace {

Sequence ViewsOfABody(const ShapeExponents& shape_exponents, int views, double disturbance) {
  Sequence sequence;
  const auto box_of = [&](const Box& outline) { return Disturbed(outline, disturbance); };
  AddViewsOfBody("thing", {0.5, 0.3, 0.4}, shape_exponents, views, box_of, &sequence);
  return sequence;
}

TEST(LearnShapeExponents, OfExactBoxesIsThatOfTheBody) {
  for (const ShapeExponents& exponents :
       {ShapeExponents(1.0), ShapeExponents(1.3), ShapeExponents(2.0), ShapeExponents(2.0, 1.1)}) {
    const auto learned = LearnShapeExponents(ViewsOfABody(exponents, 20, 0.0), 10);
    ASSERT_EQ(learned.size(), 1u);
    EXPECT_NEAR(learned.at(0).horizontal, exponents.horizontal, 0.051);  // the step of the search
    EXPECT_NEAR(learned.at(0).vertical, exponents.vertical, 0.051);
  }
}

TEST(LearnShapeExponents, OfDisturbedBoxesIsNear) {
  const ShapeExponents learned = LearnShapeExponents(ViewsOfABody({1.8, 1.2}, 60, 0.02), 10).at(0);
  EXPECT_NEAR(learned.horizontal, 1.8, 0.15);
  EXPECT_NEAR(learned.vertical, 1.2, 0.15);
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
