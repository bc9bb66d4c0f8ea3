// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/residual_term.h"

#include <gtest/gtest.h>

#include "constraints/odometry.h"
#include "mapping/ratio_cost_term.h"
#include "support/cost_function_term.h"
#include "support/landmark_term_residual.h"
#include "support/random.h"

namespace soslam {
namespace {

// Of two variables at most, of which the first may be held.
struct Derivatives {
  double cost;
  std::array<Eigen::VectorXd, 2> gradient;
  std::array<std::array<Eigen::MatrixXd, 2>, 2> hessian;

  Derivatives(const Term& term, const std::vector<int>& sizes, Hessian kind, bool is_first_held) {
    TermPlaces places;
    for (size_t i = is_first_held ? 1 : 0; i < sizes.size(); ++i) {
      gradient[i].setZero(sizes[i]);
      places.gradient[i] = gradient[i].data();
      for (size_t j = is_first_held ? 1 : 0; j <= i; ++j) {
        hessian[i][j].setZero(sizes[i], sizes[j]);
        places.hessian[i][j] = hessian[i][j].data();
      }
    }
    cost = term.Linearise(kind, places);
  }
};

void ExpectSame(const Term& term, const Term& reference, const std::vector<int>& sizes) {
  for (const Hessian kind : {Hessian::kInformation, Hessian::kFar, Hessian::kNear}) {
    for (const bool is_first_held : {false, true}) {
      const Derivatives found(term, sizes, kind, is_first_held);
      const Derivatives expected(reference, sizes, kind, is_first_held);
      const double tolerance = 1e-12 * (1.0 + expected.cost);
      EXPECT_NEAR(found.cost, expected.cost, tolerance);
      EXPECT_NEAR(term.Cost(), expected.cost, tolerance);
      for (size_t i = 0; i < 2; ++i) {
        EXPECT_TRUE(found.gradient[i].isApprox(expected.gradient[i], 1e-12));
        for (size_t j = 0; j <= i; ++j) {
          const Eigen::MatrixXd difference = found.hessian[i][j] - expected.hessian[i][j];
          EXPECT_LE(difference.norm(), 1e-12 * (1.0 + expected.hessian[i][j].norm()));
        }
      }
    }
  }
}

// Within the loss's width and beyond.
TEST(ResidualTerm, SaysWhatItsResidualsSay) {
  for (const double huber_delta : {0.1, 1e9, std::numeric_limits<double>::infinity()}) {
    const PoseBlock first = Pack(RandomRigid()), second = Pack(RandomRigid());
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

TEST(RatioCostTerm, SaysWhatItsResidualsSay) {
  ShapePrior prior;
  prior.ratio = {1.3, 0.7};
  prior.log_sigma = {0.1, 0.2};
  prior.log_correlation = 0.4;
  const LandmarkBlock landmark = Pack(RandomLandmarkInCamera());
  const CostFunctionTerm reference(
      std::make_unique<LandmarkTermResidual>(std::make_unique<RatioTerm>(prior)),
      {{0, VariableKind::kLandmark, landmark.data()}});
  ExpectSame(RatioCostTerm(0, landmark.data(), prior), reference, {kLandmarkDof});
}

}  // namespace
}  // namespace soslam
