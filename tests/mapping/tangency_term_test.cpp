// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/tangency_term.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>

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
    term = TermOf(TangentBox(edges, start), huber_delta);
  }
  std::unique_ptr<TangencyTerm> TermOf(const TangentBox& box, double huber_delta) const {
    return std::make_unique<TangencyTerm>(
        std::array{0, 1, 2},
        TangencyTerm::Blocks{view.camera_block.data(), view.landmark_block.data(), bias.data()},
        box, huber_delta, kWeight);
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
  // Excess of an edge, in its standard deviations.
  double Excess(size_t edge) const {
    const std::array<const double*, 2> blocks = {view.camera_block.data(),
                                                 view.landmark_block.data()};
    const RelativeObservation observation(blocks.data(), start.shape_exponent);
    const Landmark& landmark = observation.landmark_in_camera();
    const double depth_m =
        TangentDepth(edges[edge], start) * landmark.Centre().z() / start.Centre().z();
    return Tangency(edges[edge], landmark, depth_m, bias[edge], nullptr);
  }
  // d excess / d step of the landmark, from differences.
  Eigen::Matrix<double, kLandmarkDof, 1> ExcessGradient(size_t edge) {
    constexpr double kStep = 1e-6;
    const LandmarkBlock before = view.landmark_block;
    const auto at = [&](int i, double length) {
      const Eigen::Matrix<double, kLandmarkDof, 1> step =
          length * Eigen::Matrix<double, kLandmarkDof, 1>::Unit(i);
      Move(VariableKind::kLandmark, step.data(), view.landmark_block.data());
      const double excess = Excess(edge);
      view.landmark_block = before;
      return excess;
    };
    Eigen::Matrix<double, kLandmarkDof, 1> gradient;
    for (int i = 0; i < kLandmarkDof; ++i) {
      gradient[i] = (at(i, kStep) - at(i, -kStep)) / (2.0 * kStep);
    }
    return gradient;
  }
  // d^2 excess / d turn^2 of what its contact moves by along the body, from differences: the point
  // of contact is dh / dm, of h at the plane's normal m in the object frame.
  Eigen::Matrix3d ContactCurvature(size_t edge) const {
    constexpr double kStep = 1e-6;
    const TangentBox::Edge compared = TangentBox(edges, start).edges[edge];
    const Landmark landmark = view.LandmarkInCamera();
    const Eigen::Matrix3d world_from_object =
        (view.world_from_camera.rotation * landmark.frame_from_object.rotation).toRotationMatrix();
    const Eigen::Vector3d m = landmark.frame_from_object.rotation.conjugate() * compared.plane;
    Eigen::Matrix3d moves;
    for (int i = 0; i < 3; ++i) {
      const auto contact = [&](double length) {
        return SupportFunction(landmark.half_axes, start.shape_exponent,
                               m + length * m.norm() * Eigen::Vector3d::Unit(i))
            .contact;
      };
      moves.col(i) = (contact(kStep) - contact(-kStep)) / (2.0 * kStep * m.norm());
    }
    const Eigen::Matrix3d m_by_turn = Skew(m) * world_from_object.transpose();
    return m_by_turn.transpose() * moves * m_by_turn / landmark.Centre().z();
  }

  // d^2 cost / (d step_i d step_j), from differences.
  double Second(int i, int j) {
    constexpr double kStep = 1e-4;
    const auto at = [&](double x, double y) {
      Eigen::Matrix<double, kDof, 1> step = Eigen::Matrix<double, kDof, 1>::Zero();
      step[i] += x;
      step[j] += y;
      return CostAfter(step);
    };
    return (at(kStep, kStep) - at(kStep, -kStep) - at(-kStep, kStep) + at(-kStep, -kStep)) /
           (4.0 * kStep * kStep);
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

// Derivatives by all variables except the fixed ones.
Derivatives Linearised(const TangencyTerm& term, Hessian kind,
                       const std::array<bool, 3>& is_held = {}) {
  constexpr std::array kSizes = {kPoseDof, kLandmarkDof, kBiasSize};
  constexpr std::array kFirst = {0, kPoseDof, kPoseDof + kLandmarkDof};
  Derivatives derivatives;
  derivatives.gradient.setZero();
  std::array<std::array<Eigen::MatrixXd, 3>, 3> blocks;
  TermPlaces places;
  for (size_t i = 0; i < 3; ++i) {
    if (!is_held[i]) places.gradient[i] = &derivatives.gradient[kFirst[i]];
    for (size_t j = 0; j <= i; ++j) {
      blocks[i][j] = Eigen::MatrixXd::Zero(kSizes[i], kSizes[j]);
      if (!is_held[i] && !is_held[j]) places.hessian[i][j] = blocks[i][j].data();
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
    double expected = 0.0;
    for (size_t i = 0; i < 4; ++i) {
      const double excess = std::abs(view.Excess(i));
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
          EXPECT_NEAR(found.hessian(i, j), view.Second(i, j), 2e-4 * (1.0 + found.hessian.norm()))
              << p << " " << i << " " << j;
        }
      }
    }
  }
  EXPECT_GT(checked, 5);
}

// Hessians by the landmark, within the Huber loss's delta and beyond it. With J the gradients of
// excesses: J^T W J; far from a minimum (kFar), also the positive curvature from the contact that
// moves along the object; near it (kNear), the whole Hessian.
TEST(TangencyTerm, HessiansAreWhatTheirKindsSay) {
  constexpr double kDelta = 1.0;
  using Square = Eigen::Matrix<double, kLandmarkDof, kLandmarkDof>;
  std::array<int, 2> held{}, beyond{};
  for (const double p : kShapeExponents) {
    for (int trial = 0; trial < 40; ++trial) {
      ViewOfBox view(p, {}, kDelta);
      if (!IsOffKinks(view)) continue;
      Square information = Square::Zero(), rounded_up = Square::Zero();
      Eigen::Matrix3d holds = Eigen::Matrix3d::Zero();
      for (size_t i = 0; i < 4; ++i) {
        const double excess = view.Excess(i);
        const double weight = ViewOfBox::kWeight * std::min(1.0, kDelta / std::abs(excess));
        const Eigen::Matrix<double, kLandmarkDof, 1> gradient = view.ExcessGradient(i);
        information += weight * gradient * gradient.transpose();
        const bool is_beyond = std::abs(excess) > kDelta;
        const bool is_held = excess > 0.0 && p < kEllipsoidExponent;
        if (is_beyond) {
          rounded_up += HuberLoss::kLeastCurvature * weight * gradient * gradient.transpose();
        }
        if (is_held) holds += weight * excess * view.ContactCurvature(i);
        ++beyond[is_beyond];
        ++held[is_held];
      }
      const auto of_landmark = [&](Hessian kind) -> Square {
        return Linearised(*view.term, kind)
            .hessian.block<kLandmarkDof, kLandmarkDof>(kPoseDof, kPoseDof);
      };
      const double tolerance = 1e-6 * information.norm();
      EXPECT_LT((of_landmark(Hessian::kInformation) - information).norm(), tolerance) << p;
      Square far = information;
      far.topLeftCorner<3, 3>() += holds;
      EXPECT_LT((of_landmark(Hessian::kFar) - far).norm(), tolerance) << p;
      const Square near = of_landmark(Hessian::kNear) - rounded_up;
      for (int i = 0; i < kLandmarkDof; ++i) {
        for (int j = 0; j <= i; ++j) {
          EXPECT_NEAR(near(i, j), view.Second(kPoseDof + i, kPoseDof + j), 2e-4 * near.norm())
              << p << " " << i << " " << j;
        }
      }
    }
  }
  for (const int count : {beyond[0], beyond[1], held[0], held[1]}) EXPECT_GT(count, 10);
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
      // What it has more is by turns of the body against the camera alone.
      Eigen::Matrix<double, kDof, kDof> by_turns = Eigen::Matrix<double, kDof, kDof>::Zero();
      const Eigen::Matrix3d turn_turn =
          (far.hessian - information.hessian).block<3, 3>(kPoseDof, kPoseDof);
      by_turns.block<3, 3>(0, 0) = by_turns.block<3, 3>(kPoseDof, kPoseDof) = turn_turn;
      by_turns.block<3, 3>(0, kPoseDof) = by_turns.block<3, 3>(kPoseDof, 0) = -turn_turn;
      if (p == kEllipsoidExponent) {
        EXPECT_TRUE(turn_turn.isZero(0.0));
      }
      EXPECT_LT((far.hessian - information.hessian - by_turns).norm(), 1e-12 * far.hessian.norm());
    }
  }
}

TEST(TangencyTerm, LeavesOutWhatIsHeld) {
  const ViewOfBox view(1.3, {}, 1.0);
  for (const Hessian kind : {Hessian::kInformation, Hessian::kFar, Hessian::kNear}) {
    const Derivatives all = Linearised(*view.term, kind);
    for (int held = 0; held < 8; ++held) {
      const std::array<bool, 3> is_held = {(held & 1) != 0, (held & 2) != 0, (held & 4) != 0};
      Eigen::Matrix<double, kDof, 1> is_free;
      is_free << Eigen::VectorXd::Constant(kPoseDof, is_held[0] ? 0.0 : 1.0),
          Eigen::VectorXd::Constant(kLandmarkDof, is_held[1] ? 0.0 : 1.0),
          Eigen::VectorXd::Constant(kBiasSize, is_held[2] ? 0.0 : 1.0);
      const Derivatives found = Linearised(*view.term, kind, is_held);
      EXPECT_EQ(found.cost, all.cost);
      EXPECT_EQ(found.gradient, all.gradient.cwiseProduct(is_free));
      EXPECT_EQ(found.hessian, is_free.asDiagonal() * all.hessian * is_free.asDiagonal());
    }
  }
}

// Each edge for itself, bounds that are reached and others, and some left out.
TEST(TangencyTerm, IsTheSumOfTheEdgesThatThereAre) {
  int idle = 0, reached = 0;
  for (const double p : kShapeExponents) {
    for (int trial = 0; trial < 20; ++trial) {
      ViewOfBox view(p, {true, trial % 2 == 0, false, true}, 1.0);
      TangentBox box(view.edges, view.start);
      std::shift_left(box.edges.begin(), box.edges.end(), trial % 3);
      box.num_edges -= trial % 3;
      const auto term = view.TermOf(box, 1.0);
      for (const Hessian kind : {Hessian::kInformation, Hessian::kFar, Hessian::kNear}) {
        const Derivatives found = Linearised(*term, kind);
        Derivatives rest = found;
        for (int i = 0; i < box.num_edges; ++i) {
          TangentBox one = box;
          one.edges[0] = box.edges[static_cast<size_t>(i)];
          one.num_edges = 1;
          const Derivatives of_one = Linearised(*view.TermOf(one, 1.0), kind);
          if (one.edges[0].is_bound) {
            one.edges[0].is_bound = false;
            const Derivatives of_edge = Linearised(*view.TermOf(one, 1.0), kind);
            const bool is_idle = of_one.cost == 0.0;
            ++(is_idle ? idle : reached);
            // A bound is idle where the body reaches beyond it, which a larger bias would lower.
            EXPECT_EQ(is_idle, of_edge.gradient[kPoseDof + kLandmarkDof + one.edges[0].side] < 0.0);
            EXPECT_EQ(of_one.gradient, (is_idle ? 0.0 : 1.0) * of_edge.gradient);
            EXPECT_EQ(of_one.hessian, (is_idle ? 0.0 : 1.0) * of_edge.hessian);
          }
          rest.cost -= of_one.cost;
          rest.gradient -= of_one.gradient;
          rest.hessian -= of_one.hessian;
        }
        EXPECT_NEAR(rest.cost, 0.0, 1e-12 * found.cost);
        EXPECT_LT(rest.gradient.norm(), 1e-12 * (1.0 + found.hessian.norm()));
        EXPECT_LT(rest.hessian.norm(), 1e-12 * (1.0 + found.hessian.norm()));
      }
    }
  }
  EXPECT_GT(idle, 10);
  EXPECT_GT(reached, 10);
}

TEST(TangencyTerm, IsInfiniteWhereItIsNotDefined) {
  for (const double p : kShapeExponents) {
    for (const bool are_bounds : {false, true}) {
      for (const int num_edges : {0, 2, 4}) {
        ViewOfBox view(p, {are_bounds, are_bounds, are_bounds, are_bounds}, 1.0);
        TangentBox box(view.edges, view.start);
        box.num_edges = std::min(box.num_edges, num_edges);
        view.view.landmark_block.back() = 1e3;  // of a half axis beyond numbers
        const Derivatives found = Linearised(*view.TermOf(box, 1.0), Hessian::kNear);
        EXPECT_EQ(found.cost, std::numeric_limits<double>::infinity());
        EXPECT_TRUE(found.gradient.isZero(0.0));
        EXPECT_TRUE(found.hessian.isZero(0.0));
      }
    }
  }
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
      for (int j = 0; j <= i && IsOffKinks(view); ++j) {
        EXPECT_NEAR(found.hessian(i, j), view.Second(i, j), 2e-4 * (1.0 + found.hessian.norm()))
            << p << " " << i << " " << j;
      }
    }
  }
}

}  // namespace
}  // namespace soslam
