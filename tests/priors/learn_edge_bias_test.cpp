// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "soslam/priors/learn_priors.h"
#include "support/views_of_bodies.h"

namespace soslam {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr double kShapeExponent = 1.3;
constexpr EdgeBias kTrueBias = {0.1, 0.02, -0.05, -0.2};
constexpr double kRounding = 1e-4;  // of learned values, and more

// The box whose edges are outside this outline by the bias.
Box WithBias(const Box& outline, const EdgeBias& bias) {
  const double width = outline.Width() / (1.0 - bias[0] - bias[2]);
  const double height = outline.Height() / (1.0 - bias[1] - bias[3]);
  return {outline.x_min - bias[0] * width, outline.y_min - bias[1] * height,
          outline.x_max + bias[2] * width, outline.y_max + bias[3] * height};
}

// Objects with biased boxes.
Sequence BiasedObjects(const std::string& label, int objects, int views, const EdgeBias& bias) {
  Sequence sequence;
  sequence.name = "views";
  const auto box_of = [&](const Box& outline) { return WithBias(outline, bias); };
  for (int object = 0; object < objects; ++object) {
    AddViewsOfBody(label, RandomVector(0.2, 0.5), kShapeExponent, views, box_of, &sequence);
  }
  return sequence;
}

SemanticRows Things() {
  ShapePrior prior;
  prior.shape_exponents = kShapeExponent;
  return {"", {}, {{"cup", {}, prior, 0, "guess"}, {"thing", {"object"}, prior, 0, "guess"}}};
}

SemanticRows Learned(const std::vector<Sequence>& sequences, double no_bias_weight) {
  SemanticRows rows = Things();
  LearnEdgeBias(sequences, no_bias_weight, &rows);
  return rows;
}

TEST(LearnEdgeBias, RecoversTheBiasOfTheBoxesOfALabel) {
  const SemanticRows rows = Learned({BiasedObjects("object", 2, 6, kTrueBias)}, 0.0);
  for (size_t side = 0; side < 4; ++side) {
    EXPECT_NEAR(rows.rows[1].prior.edge_bias[side], kTrueBias[side], kRounding) << side;
  }
  EXPECT_THAT(rows.rows[1].source, HasSubstr("edge bias: 2 of views"));
  EXPECT_EQ(rows.rows[0].prior.edge_bias, EdgeBias());
  EXPECT_THAT(rows.rows[0].source, Not(HasSubstr("edge bias")));
}

TEST(LearnEdgeBias, ObjectsCountOnceHoweverOftenTheyAreSeen) {
  const Sequence often = BiasedObjects("thing", 1, 40, kTrueBias);
  const Sequence seldom = BiasedObjects("thing", 1, 4, EdgeBias());
  const EdgeBias bias = Learned({often, seldom}, 2.0).rows[1].prior.edge_bias;
  for (size_t side = 0; side < 4; ++side) {
    EXPECT_NEAR(bias[side], kTrueBias[side] / 4.0, kRounding) << side;
  }
}

TEST(LearnEdgeBias, IgnoresBoundsAndAFewWrongBoxes) {
  Sequence sequence = BiasedObjects("thing", 1, 9, kTrueBias);
  for (Detection& detection : sequence.detections) {
    detection.is_one_sided[3] = true;
    detection.box.y_max -= 0.3 * detection.box.Height();
  }
  for (size_t i = 0; i < 3; ++i) sequence.detections[i].box.x_min -= 50.0;
  // The height of the boxes, of which biases are fractions, is less by 0.3.
  const EdgeBias expected = {kTrueBias[0], kTrueBias[1] / 0.7, kTrueBias[2], 0.0};
  const EdgeBias bias = Learned({sequence}, 0.0).rows[1].prior.edge_bias;
  EXPECT_NEAR(bias[0], expected[0], kRounding);
  EXPECT_NEAR(bias[1], expected[1], kRounding);
  EXPECT_NEAR(bias[3], expected[3], kRounding);
}

TEST(LearnEdgeBias, NeedsGroundTruthAndSomeBoxes) {
  EXPECT_EQ(Learned({BiasedObjects("thing", 1, 2, kTrueBias)}, 0.0).rows[1].prior.edge_bias,
            EdgeBias());
  Sequence sequence = BiasedObjects("thing", 1, 9, kTrueBias);
  sequence.objects[0].ground_truth.reset();
  EXPECT_EQ(Learned({sequence}, 0.0).rows[1].prior.edge_bias, EdgeBias());
}

}  // namespace
}  // namespace soslam
