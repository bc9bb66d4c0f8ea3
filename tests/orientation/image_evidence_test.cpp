// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/image_evidence.h"

#include <gtest/gtest.h>

#include <numbers>

#include "soslam/orientation/texture_asymmetry.h"
#include "support/drawn_cuboids.h"
#include "support/facing_view.h"

namespace soslam {
namespace {

// Half the sum of squares of all residuals, for a camera in the origin of the world.
double CostOfResiduals(const ImageResiduals& residuals, const Landmark& landmark) {
  const auto pose = ToParameterBlock(Rigid3d());
  const auto packed = ToParameterBlock(landmark);
  const double* const blocks[] = {pose.data(), packed.data()};
  double cost = residuals.constant_cost;
  for (const auto& function : residuals.functions) {
    Eigen::VectorXd values(function->num_residuals());
    EXPECT_TRUE(function->Evaluate(blocks, values.data(), nullptr));
    cost += 0.5 * values.squaredNorm();
  }
  return cost;
}

SymmetryOptions Everywhere(Descriptor descriptor) {
  SymmetryOptions options;
  options.descriptor = descriptor;
  options.sampling = Sampling::kUniform;
  options.uniform_columns = 40;
  return options;
}

TEST(ImageEvidence, AsymmetryOfTextureCostsAsMuchInMapsAsWhereLandmarksAreCompared) {
  const auto image = std::make_shared<const SymmetryImage>(SparseImage());
  const SymmetryOptions symmetry = Everywhere(Descriptor::kDistanceTransform);
  const TextureOptions texture;
  const auto evidence = MakeAsymmetryEvidence(image, TestCamera(), texture, symmetry);
  const Landmark start = FacingView().LandmarkInCamera();
  const double compared = evidence->ComparedCost(start);
  EXPECT_EQ(compared, TextureAsymmetry(*image, TestCamera(), texture, symmetry).Cost(start));
  EXPECT_GT(compared, 0.0);
  const ImageResiduals residuals = evidence->ResidualsAt(start, nullptr, 0.25);
  EXPECT_GT(residuals.count, 50);
  EXPECT_NEAR(CostOfResiduals(residuals, start), 0.25 * compared, 1e-9);
  EXPECT_EQ(evidence->CostNear(start), nullptr);
  // From its side no pair is visible: all of the cost is constant.
  const Landmark aside = RotatedAboutZ(start, std::numbers::pi / 2);
  const ImageResiduals none = evidence->ResidualsAt(aside, nullptr, 0.25);
  EXPECT_TRUE(none.functions.empty());
  EXPECT_EQ(none.why_none, "symmetry_with_too_few_visible_pairs");
  EXPECT_EQ(none.constant_cost, 0.25 * texture.asymmetry_cost);
}

TEST(ImageEvidence, PairsOfTextureAreOneResidualEachWhateverTheWeight) {
  const auto image = std::make_shared<const SymmetryImage>(SparseImage());
  const auto evidence =
      MakeSymmetryEvidence(image, TestCamera(), Everywhere(Descriptor::kDistanceTransform), 30.0);
  const Landmark start = FacingView().LandmarkInCamera();
  const ImageResiduals residuals = evidence->ResidualsAt(start, nullptr, 0.25);
  EXPECT_GT(residuals.count, 50);
  EXPECT_EQ(residuals.functions.size(), static_cast<size_t>(residuals.count));
  EXPECT_NEAR(CostOfResiduals(residuals, start),
              CostOfResiduals(evidence->ResidualsAt(start, nullptr, 1.0), start), 1e-12);
  EXPECT_EQ(evidence->ComparedCost(start), 0.0);
}

TEST(ImageEvidence, EdgesWeighAsMuchAsTheyAreSeen) {
  const Plane floor{Eigen::Vector3d(0.05, -1.0, -0.3).normalized(), 1.0};
  const Landmark truth = StandingCuboid(TestCamera(), floor, {310, 320}, 0.3, {0.4, 0.25, 0.3});
  const auto image = std::make_shared<const EdgeImage>(
      EdgeImage{std::make_shared<const FrameEdges>(
                    ComputeEdgeMaps(DrawCuboids(TestCamera(), {truth}), EdgesOptions())),
                *OutlineBox(TestCamera(), truth),
                {}});
  const auto evidence = MakeEdgeEvidence(image, TestCamera(), EdgeOptions());
  const Landmark turned = RotatedAboutZ(truth, 0.4);
  const auto cost = [&](const Landmark* weighed_at, double weight) {
    return CostOfResiduals(evidence->ResidualsAt(turned, weighed_at, weight), turned);
  };
  EXPECT_GT(cost(&truth, 1.0), 0.0);
  EXPECT_NEAR(cost(&truth, 0.25), 0.25 * cost(&truth, 1.0), 1e-9);
  EXPECT_EQ(cost(nullptr, 1.0), cost(&turned, 1.0));
  EXPECT_LT(cost(nullptr, 1.0), 0.5 * cost(&truth, 1.0));
  const auto near = evidence->CostNear(turned);
  const double support = EdgeCost(image, TestCamera(), truth, EdgeOptions()).Support(truth);
  EXPECT_NEAR(cost(&truth, 1.0), support * support * (near->Value(turned) + near->ConstantCost()),
              1e-9);
}

}  // namespace
}  // namespace soslam
