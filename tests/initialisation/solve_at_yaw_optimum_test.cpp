// SPDX-License-Identifier: BSD-3-Clause
// The closed form against an optimiser of the same cost.
#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "initialisation/closed_form.h"
#include "initialisation/yaw_sweep.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

// The body of the prior's ratio at a yaw, by foot and half height.
Landmark BodyAt(const UprightObservation& observation, double yaw, const double* foot_and_c) {
  const ShapePrior& prior = observation.prior;
  const double c = foot_and_c[2];
  UprightVector parameters;
  parameters << yaw, foot_and_c[0], foot_and_c[1], std::log(prior.ratio.x() * c),
      std::log(prior.ratio.y() * c), std::log(c);
  return UprightGround(observation.plane_in_camera).LandmarkAt(parameters, prior.shape_exponent);
}

// Its tangencies, with tangent points at the depths of a given landmark.
class TangencyCost final : public ceres::SizedCostFunction<4, 3> {
 public:
  TangencyCost(const UprightObservation& observation, double yaw, const Landmark& depths_of)
      : observation_(observation), yaw_(yaw), term_(observation.edges, depths_of) {}

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const double* foot_and_c = blocks[0];
    const Landmark landmark = BodyAt(observation_, yaw_, foot_and_c);
    LandmarkTerm::Jacobian d_landmark(4, kLandmarkDof);
    term_.Evaluate(landmark, Eigen::Map<Eigen::VectorXd>(residuals, 4), &d_landmark);
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    const Eigen::Matrix<double, 4, 6> d_parameters =
        d_landmark * UprightGround(observation_.plane_in_camera).ParameterJacobian(landmark);
    Eigen::Map<Eigen::Matrix<double, 4, 3, Eigen::RowMajor>> jacobian(jacobians[0]);
    jacobian.leftCols<2>() = d_parameters.middleCols<2>(1);
    jacobian.col(2) = d_parameters.rightCols<3>().rowwise().sum() / foot_and_c[2];
    return true;
  }

 private:
  const UprightObservation& observation_;
  double yaw_;
  BoxTerm term_;
};

// Minimises by Levenberg-Marquardt, which stops where the cost is flat within its precision: the
// distance to the optimum is about the square root of the precision.
void Minimise(const TangencyCost& cost, Eigen::Vector3d* foot_and_c) {
  ceres::Problem::Options borrow;
  borrow.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(borrow);
  problem.AddResidualBlock(const_cast<TangencyCost*>(&cost), nullptr, foot_and_c->data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 500;
  options.function_tolerance = 0.0;
  options.gradient_tolerance = 0.0;
  options.parameter_tolerance = 1e-15;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);
}

// Gauss-Newton steps, which look at the gradient and not at the cost, until they are of the size of
// rounding errors. They may not leave the optimum that they started from.
void Polish(const TangencyCost& cost, Eigen::Vector3d* foot_and_c) {
  const Eigen::Vector3d start = *foot_and_c;
  const double* block = foot_and_c->data();
  Eigen::Vector3d step = Eigen::Vector3d::Constant(1.0);
  for (int i = 0; i < 20 && step.norm() > 1e-12; ++i) {
    Eigen::Vector4d residuals;
    Eigen::Matrix<double, 4, 3, Eigen::RowMajor> jacobian;
    double* jacobians[] = {jacobian.data()};
    ASSERT_TRUE(cost.Evaluate(&block, residuals.data(), jacobians));
    step = -jacobian.colPivHouseholderQr().solve(residuals);
    *foot_and_c += step;
  }
  EXPECT_LT(step.norm(), 1e-12);
  EXPECT_LT((*foot_and_c - start).norm(), 1e-6);
}

// The optimum of the tangencies from a disturbed start.
Landmark Optimum(const UprightObservation& observation, double yaw, const Landmark& landmark) {
  const UprightVector parameters =
      UprightGround(observation.plane_in_camera).ParametersOf(landmark);
  Eigen::Vector3d foot_and_c(parameters(1), parameters(2), landmark.half_axes.z());
  foot_and_c.head<2>() += RandomVector(-0.2, 0.2).head<2>();
  foot_and_c.z() *= RandomUniform(0.8, 1.2);
  const TangencyCost cost(observation, yaw, landmark);
  Minimise(cost, &foot_and_c);
  Polish(cost, &foot_and_c);
  return BodyAt(observation, yaw, foot_and_c.data());
}

TEST(SolveAtYaw, IsTheOptimumThatLevenbergMarquardtFinds) {
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 30; ++i) {
      const StandingBody body(p);
      const UprightObservation observation = body.Observe(Disturbed(body.box, 0.05));
      const double yaw = RandomYaw();
      const auto landmark = SolveAtYaw(observation, yaw);
      ASSERT_TRUE(landmark);
      EXPECT_TRUE(IsSameBody(*landmark, Optimum(observation, yaw, *landmark), 1e-8)) << p;
    }
  }
}

TEST(SolveAtYaw, IsTheOptimumWhereOneEdgeIsABound) {
  int reached = 0;
  constexpr int kBodies = 100;
  for (int i = 0; i < kBodies; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    std::array<bool, 4> is_bound{};
    const auto bound = static_cast<size_t>(i % 4);
    is_bound[bound] = true;
    const UprightObservation observation = body.Observe(Disturbed(body.box, 0.1), is_bound);
    const double yaw = body.Yaw() + RandomUniform(-0.3, 0.3);
    const auto landmark = SolveAtYaw(observation, yaw);
    ASSERT_TRUE(landmark);
    EXPECT_TRUE(IsSameBody(*landmark, Optimum(observation, yaw, *landmark), 1e-8)) << bound;
    reached += Tangency(observation.edges[bound], *landmark, {1.0}, 0.0, nullptr) == 0.0 ? 1 : 0;
  }
  EXPECT_GT(reached, kBodies / 5);
  EXPECT_LT(reached, kBodies * 4 / 5);
}

}  // namespace
}  // namespace soslam
