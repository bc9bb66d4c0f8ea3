// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/view_term.h"

#include <ceres/sized_cost_function.h>
#include <gtest/gtest.h>

#include <limits>

#include "constraints/tangent_space.h"
#include "initialisation/upright.h"
#include "support/cost_function_term.h"
#include "support/random_scene.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

// A term's derivatives by a pose and a landmark.
struct Derivatives {
  Derivatives(const Term& term, bool with_pose, bool with_landmark) {
    TermPlaces places;
    if (with_pose) {
      places.gradient[0] = of_pose.data();
      places.hessian[0][0] = pose_pose.data();
    }
    if (with_landmark) {
      places.gradient[1] = of_landmark.data();
      places.hessian[1][1] = landmark_landmark.data();
    }
    if (with_pose && with_landmark) places.hessian[1][0] = landmark_pose.data();
    cost = term.Linearise(Hessian::kInformation, places);
  }

  double cost;
  Eigen::Matrix<double, kPoseDof, 1> of_pose = decltype(of_pose)::Zero();
  Eigen::Matrix<double, kLandmarkDof, 1> of_landmark = decltype(of_landmark)::Zero();
  Eigen::Matrix<double, kPoseDof, kPoseDof> pose_pose = decltype(pose_pose)::Zero();
  Eigen::Matrix<double, kLandmarkDof, kPoseDof> landmark_pose = decltype(landmark_pose)::Zero();
  Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> landmark_landmark =
      decltype(landmark_landmark)::Zero();
};

template <typename Matrix>
void ExpectNear(const Matrix& one, const Matrix& other) {
  EXPECT_LT((one - other).norm(), 1e-9 * (1.0 + other.norm()));
}

// A box for Ceres. Blocks: world_from_camera, landmark in the world.
class BoxResidual final : public ceres::SizedCostFunction<4, kPoseSize, kLandmarkSize> {
 public:
  explicit BoxResidual(const BoxTerm& box, double shape_exponent)
      : box_(box), shape_exponent_(shape_exponent) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const RelativeObservation observation(blocks, shape_exponent_);
    LandmarkTerm::Jacobian by_landmark(4, kLandmarkDof);
    box_.Evaluate(observation.landmark_in_camera(), Eigen::Map<Eigen::VectorXd>(residuals, 4),
                  &by_landmark);
    observation.WriteJacobians<4>(Eigen::Matrix<double, 4, kLandmarkDof>(by_landmark), blocks,
                                  jacobians);
    return true;
  }

 private:
  BoxTerm box_;
  double shape_exponent_;
};

// The same of one camera as two terms.
struct TwoTerms {
  explicit TwoTerms(double shape_exponent) {
    const Landmark start = WithShape(view.LandmarkInCamera(), shape_exponent);
    Box box = *OutlineBox(TestCamera(), start);
    box.x_min += RandomUniform(-8, 8);
    box.y_max += RandomUniform(-8, 8);
    const BoxTerm tangencies(BoxEdges(TestCamera(), box, {}, 0.05), start);
    const double* pose = view.camera_block.data();
    const double* landmark = view.landmark_block.data();
    residual = std::make_unique<CostFunctionTerm>(
        std::make_unique<BoxResidual>(tangencies, shape_exponent),
        std::vector<CostFunctionTerm::Block>{{0, VariableKind::kPose, pose},
                                             {1, VariableKind::kLandmark, landmark}});
    term = std::make_unique<ViewTerm>(std::array{0, 1}, ViewTerm::Blocks{pose, landmark},
                                      shape_exponent, std::make_unique<BoxTerm>(tangencies));
  }

  RandomView view;
  std::unique_ptr<CostFunctionTerm> residual;
  std::unique_ptr<ViewTerm> term;
};

TEST(ViewTerm, SaysWhatItsResidualsSayInTheWorld) {
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const TwoTerms terms(p);
      for (const auto& [with_pose, with_landmark] :
           {std::pair(true, true), std::pair(true, false), std::pair(false, true)}) {
        const Derivatives expected(*terms.residual, with_pose, with_landmark);
        const Derivatives found(*terms.term, with_pose, with_landmark);
        EXPECT_NEAR(found.cost, expected.cost, 1e-9 * (1.0 + expected.cost));
        EXPECT_NEAR(terms.term->Cost(), expected.cost, 1e-9 * (1.0 + expected.cost));
        ExpectNear(found.of_pose, expected.of_pose);
        ExpectNear(found.of_landmark, expected.of_landmark);
        ExpectNear(found.pose_pose, expected.pose_pose);
        ExpectNear(found.landmark_pose, expected.landmark_pose);
        ExpectNear(found.landmark_landmark, expected.landmark_landmark);
      }
    }
  }
}

class UndefinedCost final : public LandmarkCost {
 public:
  double Value(const Landmark&) const override { return std::numeric_limits<double>::quiet_NaN(); }
  void AddTo(const Landmark& landmark, LandmarkModel* sum) const override {
    sum->cost += Value(landmark);
    sum->gradient.setConstant(sum->cost);
    sum->information.setConstant(sum->cost);
  }
};

TEST(ViewTerm, IsInfiniteAndAddsNothingWhereTheCostIsUndefined) {
  const RandomView view;
  const ViewTerm term({0, 1}, {view.camera_block.data(), view.landmark_block.data()},
                      kEllipsoidExponent, std::make_unique<UndefinedCost>());
  EXPECT_EQ(term.Cost(), std::numeric_limits<double>::infinity());
  const Derivatives derivatives(term, true, true);
  EXPECT_EQ(derivatives.cost, std::numeric_limits<double>::infinity());
  EXPECT_EQ(derivatives.of_pose.norm(), 0.0);
  EXPECT_EQ(derivatives.of_landmark.norm(), 0.0);
  EXPECT_EQ(derivatives.pose_pose.norm(), 0.0);
  EXPECT_EQ(derivatives.landmark_pose.norm(), 0.0);
  EXPECT_EQ(derivatives.landmark_landmark.norm(), 0.0);
}

}  // namespace
}  // namespace soslam
