// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/residual_term.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <vector>

#include "constraints/odometry.h"
#include "constraints/upright_on_plane.h"
#include "mapping/ratio_cost_term.h"
#include "support/cost_function_term.h"
#include "support/landmark_term_residual.h"
#include "support/random.h"
#include "support/standing_landmarks.h"

namespace soslam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kHessians = {Hessian::kInformation, Hessian::kFar, Hessian::kNear};
constexpr size_t kNone = TermPlaces::kMaxVariables;

// Derivatives by the variables of a term, of these sizes; `held` is the fixed one of them, or none.
struct Derivatives {
  double cost;
  std::array<Eigen::VectorXd, TermPlaces::kMaxVariables> gradient;
  std::array<std::array<Eigen::MatrixXd, TermPlaces::kMaxVariables>, TermPlaces::kMaxVariables>
      hessian;

  Derivatives(const Term& term, const std::vector<int>& sizes, Hessian kind, size_t held = kNone) {
    TermPlaces places;
    for (size_t i = 0; i < sizes.size(); ++i) {
      if (i == held) continue;
      gradient[i].setZero(sizes[i]);
      places.gradient[i] = gradient[i].data();
      for (size_t j = 0; j <= i; ++j) {
        if (j == held) continue;
        hessian[i][j].setZero(sizes[i], sizes[j]);
        places.hessian[i][j] = hessian[i][j].data();
      }
    }
    cost = term.Linearise(kind, places);
  }

  bool AreZero() const {
    for (size_t i = 0; i < gradient.size(); ++i) {
      if (!gradient[i].isZero(0.0)) return false;
      for (size_t j = 0; j <= i; ++j) {
        if (!hessian[i][j].isZero(0.0)) return false;
      }
    }
    return true;
  }
};

void ExpectSame(const Term& term, const Term& reference, const std::vector<int>& sizes) {
  for (const Hessian kind : kHessians) {
    for (size_t held = 0; held <= sizes.size(); ++held) {
      const Derivatives found(term, sizes, kind, held);
      const Derivatives expected(reference, sizes, kind, held);
      const double tolerance = 1e-12 * (1.0 + expected.cost);
      EXPECT_NEAR(found.cost, expected.cost, tolerance);
      EXPECT_NEAR(term.Cost(), expected.cost, tolerance);
      for (size_t i = 0; i < sizes.size(); ++i) {
        EXPECT_TRUE(found.gradient[i].isApprox(expected.gradient[i], 1e-12));
        for (size_t j = 0; j <= i; ++j) {
          const Eigen::MatrixXd difference = found.hessian[i][j] - expected.hessian[i][j];
          EXPECT_LE(difference.norm(), 1e-12 * (1.0 + expected.hessian[i][j].norm()));
        }
      }
    }
  }
}

// A landmark and its support plane, three blocks.
struct Standing {
  using ByTerm = ResidualTerm<UprightOnPlaneResidual, VariableKind::kLandmark,
                              VariableKind::kNormal, VariableKind::kOffset>;
  static constexpr std::array kKinds = {VariableKind::kLandmark, VariableKind::kNormal,
                                        VariableKind::kOffset};
  static constexpr double kAngleSigma = 0.2, kHeightSigma = 0.5;

  Standing(const Landmark& landmark_in_world, const Plane& plane_in_world, double huber_delta)
      : landmark(ToParameterBlock(landmark_in_world)),
        plane(plane_in_world),
        term({{{0, landmark.data()}, {1, plane.normal.data()}, {2, &plane.offset}}}, huber_delta,
             kAngleSigma, kHeightSigma) {}

  std::vector<double*> Values() { return {landmark.data(), plane.normal.data(), &plane.offset}; }
  // Cost after a step of all blocks; `step` is the concatenation of their steps.
  double CostAfter(const Eigen::VectorXd& step) {
    const LandmarkBlock landmark_before = landmark;
    const Plane plane_before = plane;
    const double* of_block = step.data();
    for (size_t i = 0; i < kKinds.size(); ++i) {
      Move(kKinds[i], of_block, Values()[i]);
      of_block += NumTangents(kKinds[i]);
    }
    const double cost = term.Cost();
    landmark = landmark_before;
    plane = plane_before;
    return cost;
  }
  double Slope(const Eigen::VectorXd& step) {
    return (8.0 * (CostAfter(step) - CostAfter(-step)) -
            (CostAfter(2.0 * step) - CostAfter(-2.0 * step))) /
           12.0;
  }
  double Curvature(const Eigen::VectorXd& step, const Eigen::VectorXd& other) {
    return 0.25 * (CostAfter(step + other) - CostAfter(step - other) - CostAfter(other - step) +
                   CostAfter(-step - other));
  }

  LandmarkBlock landmark;
  Plane plane;
  ByTerm term;
};
const std::vector<int> kSizesOfStanding = {kLandmarkDof, kNormalDof, 1};
const int kStandingDof = std::reduce(kSizesOfStanding.begin(), kSizesOfStanding.end());

Landmark AnyLandmark() { return {RandomRigid(), RandomVector(0.1, 1.0)}; }

// Within the loss's width and beyond.
TEST(ResidualTerm, SaysWhatItsResidualsSay) {
  for (const double huber_delta : {0.1, 1e9, kInfinity}) {
    const PoseBlock first = ToParameterBlock(RandomRigid()),
                    second = ToParameterBlock(RandomRigid());
    const Rigid3d step = RandomRigid();
    const CostFunctionTerm reference(
        std::make_unique<OdometryResidual>(step, 0.3, 0.2),
        {{0, VariableKind::kPose, first.data()}, {1, VariableKind::kPose, second.data()}},
        huber_delta);
    const ResidualTerm<OdometryResidual, VariableKind::kPose, VariableKind::kPose> term(
        {{{0, first.data()}, {1, second.data()}}}, huber_delta, step, 0.3, 0.2);
    ExpectSame(term, reference, {kPoseDof, kPoseDof});
  }
}

TEST(ResidualTerm, SaysWhatResidualsOfThreeBlocksSay) {
  for (const double huber_delta : {0.1, 1e9, kInfinity}) {
    Standing standing(AnyLandmark(), RandomPlane(), huber_delta);
    std::vector<CostFunctionTerm::Block> blocks;
    for (size_t i = 0; i < 3; ++i) {
      blocks.push_back({static_cast<int>(i), Standing::kKinds[i], standing.Values()[i]});
    }
    const CostFunctionTerm reference(
        std::make_unique<UprightOnPlaneResidual>(Standing::kAngleSigma, Standing::kHeightSigma),
        blocks, huber_delta);
    EXPECT_EQ(standing.term.variables(), reference.variables());
    ExpectSame(standing.term, reference, kSizesOfStanding);
  }
}

// To the last bit.
TEST(ResidualTerm, SaysTheSameOfTheOthersWhenOneIsHeld) {
  for (const double huber_delta : {0.1, kInfinity}) {
    const Standing standing(AnyLandmark(), RandomPlane(), huber_delta);
    for (const Hessian kind : kHessians) {
      const Derivatives of_all(standing.term, kSizesOfStanding, kind);
      for (size_t held = 0; held < 3; ++held) {
        const Derivatives of_others(standing.term, kSizesOfStanding, kind, held);
        EXPECT_EQ(of_others.cost, of_all.cost);
        for (size_t i = 0; i < 3; ++i) {
          if (i == held) continue;
          EXPECT_EQ(of_others.gradient[i], of_all.gradient[i]);
          for (size_t j = 0; j <= i; ++j) {
            if (j == held) continue;
            EXPECT_EQ(of_others.hessian[i][j], of_all.hessian[i][j]);
          }
        }
      }
    }
  }
}

// Within the loss's width and beyond.
TEST(ResidualTerm, GradientAgreesWithNumbers) {
  constexpr double kStep = 1e-4;
  for (const double huber_delta : {0.1, kInfinity}) {
    Standing standing(AnyLandmark(), RandomPlane(), huber_delta);
    const Derivatives found(standing.term, kSizesOfStanding, Hessian::kNear);
    Eigen::VectorXd gradient(kStandingDof);
    gradient << found.gradient[0], found.gradient[1], found.gradient[2];
    for (int i = 0; i < kStandingDof; ++i) {
      const double slope = standing.Slope(kStep * Eigen::VectorXd::Unit(kStandingDof, i)) / kStep;
      EXPECT_NEAR(gradient[i], slope, 1e-8 * (1.0 + gradient.norm())) << i;
    }
  }
}

// Where residuals are zero, J^T J is all of the Hessian, also beside a loss.
void ExpectHessianOfNumbers(Standing* standing) {
  constexpr double kStep = 1e-4;
  for (const Hessian kind : kHessians) {
    const Derivatives found(standing->term, kSizesOfStanding, kind);
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(kStandingDof, kStandingDof);
    int row = 0;
    for (size_t i = 0; i < 3; row += kSizesOfStanding[i++]) {
      int column = 0;
      for (size_t j = 0; j <= i; column += kSizesOfStanding[j++]) {
        hessian.block(row, column, kSizesOfStanding[i], kSizesOfStanding[j]) = found.hessian[i][j];
      }
    }
    for (int i = 0; i < kStandingDof; ++i) {
      for (int j = 0; j <= i; ++j) {
        const double curvature =
            standing->Curvature(kStep * Eigen::VectorXd::Unit(kStandingDof, i),
                                kStep * Eigen::VectorXd::Unit(kStandingDof, j)) /
            (kStep * kStep);
        EXPECT_NEAR(hessian(i, j), curvature, 1e-6 * (1.0 + hessian.norm())) << i << " " << j;
      }
    }
  }
}

TEST(ResidualTerm, HessianAgreesWithNumbersWhereResidualsAreZero) {
  const Plane plane = RandomPlane();
  Standing but_for_rounding(RandomStanding(plane), plane, 0.1);
  ExpectHessianOfNumbers(&but_for_rounding);

  Standing exactly({{Eigen::Quaterniond::Identity(), {2.0, 3.0, 1.0}}, {1.0, 1.0, 1.0}}, Plane(),
                   0.1);
  ASSERT_EQ(exactly.term.Cost(), 0.0);
  ExpectHessianOfNumbers(&exactly);
}

// Beyond the loss's width, by what a residual is linear in. But for what HuberLoss rounds up.
TEST(ResidualTerm, CurvesLessAlongItsResiduals) {
  constexpr double kStep = 1e-3;
  Standing standing(AnyLandmark(), RandomPlane(), 0.1);
  const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(kStandingDof, kStandingDof - 1);
  const double curvature = standing.Curvature(0.5 * step, 0.5 * step) / (0.25 * kStep * kStep);
  const double near = Derivatives(standing.term, kSizesOfStanding, Hessian::kNear).hessian[2][2](0);
  const double far = Derivatives(standing.term, kSizesOfStanding, Hessian::kFar).hessian[2][2](0);
  EXPECT_NEAR(near, curvature, 2.0 * HuberLoss::kLeastCurvature * far);
  EXPECT_GT(far, near);
}

TEST(ResidualTerm, IsInfiniteAndAddsNothingWhereItIsNotDefined) {
  const auto expect_infinite = [](const Standing& standing) {
    EXPECT_EQ(standing.term.Cost(), kInfinity);
    for (const Hessian kind : kHessians) {
      const Derivatives found(standing.term, kSizesOfStanding, kind);
      EXPECT_EQ(found.cost, kInfinity);
      EXPECT_TRUE(found.AreZero());
    }
  };
  for (const double huber_delta : {0.1, kInfinity}) {
    Standing with_long_axis(AnyLandmark(), RandomPlane(), huber_delta);
    with_long_axis.landmark.back() = 1e3;  // which the residual refuses
    expect_infinite(with_long_axis);
    Standing of_no_plane(AnyLandmark(), RandomPlane(), huber_delta);
    of_no_plane.plane.offset = std::numeric_limits<double>::quiet_NaN();
    expect_infinite(of_no_plane);
  }
}

ShapePrior AnyPrior() {
  ShapePrior prior;
  prior.ratio = {1.3, 0.7};
  prior.log_sigma = {0.1, 0.2};
  prior.log_correlation = 0.4;
  return prior;
}

TEST(RatioCostTerm, SaysWhatItsResidualsSay) {
  const LandmarkBlock landmark = ToParameterBlock(RandomLandmarkInCamera());
  const CostFunctionTerm reference(
      std::make_unique<LandmarkTermResidual>(std::make_unique<RatioTerm>(AnyPrior())),
      {{0, VariableKind::kLandmark, landmark.data()}});
  ExpectSame(RatioCostTerm(0, landmark.data(), AnyPrior()), reference, {kLandmarkDof});
}

// Half axes whose logarithms are not finite, or whose ratios overflow.
TEST(RatioCostTerm, IsInfiniteAndAddsNothingWhereItIsNotDefined) {
  for (const double log_half_axis : {kInfinity, -kInfinity, 1e200, std::nan("")}) {
    for (const size_t axis : {7, 8, 9}) {
      LandmarkBlock landmark = ToParameterBlock(RandomLandmarkInCamera());
      landmark[axis] = log_half_axis;
      const RatioCostTerm term(0, landmark.data(), AnyPrior());
      EXPECT_EQ(term.Cost(), kInfinity);
      for (const Hessian kind : kHessians) {
        const Derivatives found(term, {kLandmarkDof}, kind);
        EXPECT_EQ(found.cost, kInfinity);
        EXPECT_TRUE(found.AreZero());
      }
    }
  }
}

}  // namespace
}  // namespace soslam
