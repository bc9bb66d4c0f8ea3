// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/tangency_term.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "constraints/tangent_space.h"
#include "support/random_scene.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

constexpr double kSigmaFraction = 0.05;
constexpr int kDof = kPoseDof + kLandmarkDof + kBiasSize;

// A view of a landmark whose box is some pixels off, and the term of it.
struct ViewOfBox {
  ViewOfBox(double shape_exponent, const std::array<bool, 4>& is_bound, double huber_delta) {
    start = WithShape(view.LandmarkInCamera(), shape_exponent);
    Box box = *OutlineBox(TestCamera(), start);
    for (double* side : {&box.x_min, &box.y_min, &box.x_max, &box.y_max}) {
      *side += RandomUniform(-8, 8);
    }
    edges = BoxEdges(TestCamera(), box, is_bound, kSigmaFraction);
    term = std::make_unique<TangencyTerm>(
        std::array{0, 1, 2},
        TangencyTerm::Blocks{view.camera_block.data(), view.landmark_block.data(), bias.data()},
        TangentBox(edges, start), huber_delta, kWeight);
  }

  // Where a step of all variables leads.
  void MoveBy(const Eigen::Matrix<double, kDof, 1>& step) {
    Move(VariableKind::kPose, step.data(), view.camera_block.data());
    Move(VariableKind::kLandmark, step.data() + kPoseDof, view.landmark_block.data());
    Move(VariableKind::kBias, step.data() + kPoseDof + kLandmarkDof, bias.data());
  }
  double CostAfter(const Eigen::Matrix<double, kDof, 1>& step) {
    const auto before = std::tuple(view.camera_block, view.landmark_block, bias);
    MoveBy(step);
    const double cost = term->Cost();
    std::tie(view.camera_block, view.landmark_block, bias) = before;
    return cost;
  }

  static constexpr double kWeight = 0.7;
  RandomView view;
  std::array<double, 4> bias = {0.5, -1.0, 0.2, 0.8};
  Landmark start;
  std::array<BoxEdge, 4> edges;
  std::unique_ptr<TangencyTerm> term;
};

struct Derivatives {
  double cost;
  Eigen::Matrix<double, kDof, 1> gradient;
  Eigen::Matrix<double, kDof, kDof> hessian;
};

// By all variables.
Derivatives Linearised(const TangencyTerm& term, Hessian kind) {
  constexpr std::array kSizes = {kPoseDof, kLandmarkDof, kBiasSize};
  constexpr std::array kFirst = {0, kPoseDof, kPoseDof + kLandmarkDof};
  Derivatives derivatives;
  derivatives.gradient.setZero();
  std::array<std::array<Eigen::MatrixXd, 3>, 3> blocks;
  TermPlaces places;
  for (size_t i = 0; i < 3; ++i) {
    places.gradient[i] = &derivatives.gradient[kFirst[i]];
    for (size_t j = 0; j <= i; ++j) {
      blocks[i][j] = Eigen::MatrixXd::Zero(kSizes[i], kSizes[j]);
      places.hessian[i][j] = blocks[i][j].data();
    }
  }
  derivatives.cost = term.Linearise(kind, places);
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j <= i; ++j) {
      derivatives.hessian.block(kFirst[i], kFirst[j], kSizes[i], kSizes[j]) = blocks[i][j];
    }
  }
  derivatives.hessian = derivatives.hessian.selfadjointView<Eigen::Lower>();
  return derivatives;
}

// Whether no edge's plane is near a kink of the body: its scale is that of the steps below.
bool IsOffKinks(const ViewOfBox& view) {
  return std::ranges::all_of(view.edges, [&](const BoxEdge& edge) {
    const Eigen::Vector3d in_object =
        view.start.frame_from_object.rotation.conjugate() * edge.plane.normalized();
    return in_object.cwiseAbs().minCoeff() > 0.1;
  });
}

TEST(TangencyTerm, CostsTheHuberLossOfTheTangencies) {
  for (const double p : kShapeExponents) {
    ViewOfBox view(p, {true, false, false, true}, 0.5);
    Eigen::Matrix<double, kDof, 1> step;
    for (double& value : step) value = RandomUniform(-0.02, 0.02);
    view.MoveBy(step);
    const RelativeObservation observation(
        std::array<const double*, 2>{view.view.camera_block.data(), view.view.landmark_block.data()}
            .data(),
        p);
    double expected = 0.0;
    for (size_t i = 0; i < 4; ++i) {
      const Landmark& landmark = observation.landmark_in_camera();
      const double depth_m =
          TangentDepth(view.edges[i], view.start) * landmark.Centre().z() / view.start.Centre().z();
      const double excess =
          std::abs(Tangency(view.edges[i], landmark, depth_m, view.bias[i], nullptr));
      expected += excess > 0.5 ? 0.5 * (excess - 0.25) : 0.5 * excess * excess;
    }
    EXPECT_NEAR(view.term->Cost(), ViewOfBox::kWeight * expected, 1e-9 * expected);
    for (const Hessian kind : {Hessian::kInformation, Hessian::kFar, Hessian::kNear}) {
      EXPECT_NEAR(Linearised(*view.term, kind).cost, view.term->Cost(), 1e-12 * expected);
    }
  }
}

// Against differences of the cost. Without a loss: its curvature is bounded from below on purpose.
TEST(TangencyTerm, DerivativesAgreeWithNumbers) {
  constexpr double kStep = 1e-4;
  constexpr double kNoLoss = 1e9;
  int checked = 0;
  for (const double p : kShapeExponents) {
    for (int trial = 0; trial < 10; ++trial) {
      ViewOfBox view(p, {trial % 2 == 0, false, false, false}, kNoLoss);
      if (!IsOffKinks(view)) continue;
      ++checked;
      const Derivatives found = Linearised(*view.term, Hessian::kNear);
      const auto second = [&](int i, int j) {
        const auto at = [&](double x, double y) {
          Eigen::Matrix<double, kDof, 1> step = Eigen::Matrix<double, kDof, 1>::Zero();
          step[i] += x;
          step[j] += y;
          return view.CostAfter(step);
        };
        return (at(kStep, kStep) - at(kStep, -kStep) - at(-kStep, kStep) + at(-kStep, -kStep)) /
               (4.0 * kStep * kStep);
      };
      for (int i = 0; i < kDof; ++i) {
        const auto at = [&](double length) {
          return view.CostAfter(length * Eigen::Matrix<double, kDof, 1>::Unit(i));
        };
        const double slope =
            (8.0 * (at(kStep) - at(-kStep)) - (at(2.0 * kStep) - at(-2.0 * kStep))) /
            (12.0 * kStep);
        EXPECT_NEAR(found.gradient[i], slope, 1e-6 * (1.0 + found.gradient.norm()))
            << p << " " << i;
        for (int j = 0; j <= i; ++j) {
          EXPECT_NEAR(found.hessian(i, j), second(i, j), 2e-4 * (1.0 + found.hessian.norm()))
              << p << " " << i << " " << j;
        }
      }
    }
  }
  EXPECT_GT(checked, 5);
}

// What steps are made with far from a minimum: never less than J^T W J, and positive semidefinite.
TEST(TangencyTerm, IsPositiveSemidefiniteWhereAMinimumIsFar) {
  for (const double p : kShapeExponents) {
    for (int trial = 0; trial < 20; ++trial) {
      const ViewOfBox view(p, {}, 1.0);
      const Derivatives information = Linearised(*view.term, Hessian::kInformation);
      const Derivatives far = Linearised(*view.term, Hessian::kFar);
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(information.hessian);
      EXPECT_GT(eigen.eigenvalues()[0], -1e-9 * information.hessian.norm());
      EXPECT_LT(eigen.eigenvalues()[kDof - 5], 1e-9 * information.hessian.norm());  // four rows
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> more(far.hessian - information.hessian);
      EXPECT_GT(more.eigenvalues()[0], -1e-9 * far.hessian.norm());
      EXPECT_EQ(far.gradient, information.gradient);
    }
  }
}

TEST(TangencyTerm, LeavesOutWhatIsHeld) {
  const ViewOfBox view(1.3, {}, 1.0);
  const Derivatives all = Linearised(*view.term, Hessian::kNear);
  Eigen::Matrix<double, kLandmarkDof, 1> gradient = Eigen::Matrix<double, kLandmarkDof, 1>::Zero();
  Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> hessian;
  hessian.setZero();
  TermPlaces places;
  places.gradient[1] = gradient.data();
  places.hessian[1][1] = hessian.data();
  EXPECT_EQ(view.term->Linearise(Hessian::kNear, places), all.cost);
  EXPECT_EQ(gradient, (all.gradient.segment<kLandmarkDof>(kPoseDof)));
  const Eigen::MatrixXd of_all = all.hessian.block<kLandmarkDof, kLandmarkDof>(kPoseDof, kPoseDof);
  EXPECT_TRUE(Eigen::MatrixXd(hessian.selfadjointView<Eigen::Lower>()).isApprox(of_all, 1e-12));
}

// Nothing says how large the world is, but that the box's errors are the same in any.
TEST(TangencyTerm, IsTheSameInASmallerWorld) {
  for (const double p : kShapeExponents) {
    ViewOfBox view(p, {}, 1.0);
    const double cost = view.term->Cost();
    for (size_t i = 4; i < 7; ++i) {
      view.view.camera_block[i] *= 0.6;
      view.view.landmark_block[i] *= 0.6;
    }
    for (size_t i = 7; i < 10; ++i) view.view.landmark_block[i] += std::log(0.6);
    EXPECT_NEAR(view.term->Cost(), cost, 1e-9 * cost);
  }
}

TEST(TangencyTerm, ABodyBehindTheCameraIsComparedAtATenthOfItsDepth) {
  for (const double p : kShapeExponents) {
    ViewOfBox view(p, {}, 1e9);
    const double depth_m = view.start.Centre().z();
    const Eigen::Vector3d back =
        view.view.world_from_camera.rotation * Eigen::Vector3d(0.0, 0.0, 2.0 * depth_m);
    for (size_t i = 0; i < 3; ++i) {
      view.view.landmark_block[4 + i] -= back[static_cast<Eigen::Index>(i)];
    }
    Landmark behind = view.start;
    behind.frame_from_object.translation.z() -= 2.0 * depth_m;
    double expected = 0.0;
    for (size_t i = 0; i < 4; ++i) {
      expected += 0.5 * std::pow(Tangency(view.edges[i], behind,
                                          0.1 * TangentDepth(view.edges[i], view.start),
                                          view.bias[i], nullptr),
                                 2);
    }
    EXPECT_NEAR(view.term->Cost(), ViewOfBox::kWeight * expected, 1e-6 * expected);
    const Derivatives found = Linearised(*view.term, Hessian::kNear);
    for (int i = 0; i < kDof; ++i) {
      const auto at = [&](double length) {
        return view.CostAfter(length * Eigen::Matrix<double, kDof, 1>::Unit(i));
      };
      EXPECT_NEAR(found.gradient[i], (at(1e-5) - at(-1e-5)) / 2e-5,
                  1e-4 * (1.0 + found.gradient.norm()))
          << p << " " << i;
    }
  }
}

}  // namespace
}  // namespace soslam
