// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/held_views_term.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>

#include "constraints/tangent_space.h"
#include "mapping/tangency_term.h"
#include "support/random_scene.h"
#include "support/shape_exponents.h"

namespace soslam {
namespace {

constexpr double kHuberDelta = 1.0;
constexpr double kNoLoss = 1e9;

using Gradient = Eigen::Matrix<double, kLandmarkDof, 1>;
using Square = Eigen::Matrix<double, kLandmarkDof, kLandmarkDof>;

struct Derivatives {
  double cost = 0.0;
  Gradient gradient = Gradient::Zero();
  Square hessian = Square::Zero();

  // Adds a term whose landmark is the variable at `position`.
  void Add(const Term& term, size_t position, Hessian kind) {
    Square added = Square::Zero();
    TermPlaces places;
    places.gradient[position] = gradient.data();
    places.hessian[position][position] = added.data();
    cost += term.Linearise(kind, places);
    hessian += added.selfadjointView<Eigen::Lower>();
  }
};

// A landmark and cameras around it, whose boxes are some pixels off.
struct Views {
  Views(double shape_exponent, size_t count) {
    landmark = WithShape(RandomView().landmark_in_world, shape_exponent);
    block = ToParameterBlock(landmark);
    while (views.size() < count) AddView();
  }

  void AddView() {
    Landmark in_camera = landmark;
    in_camera.frame_from_object = RandomLandmarkInCamera().frame_from_object;
    auto box = OutlineBox(TestCamera(), in_camera);
    if (!box) return;
    for (double* side : {&box->x_min, &box->y_min, &box->x_max, &box->y_max}) {
      *side += RandomUniform(-8, 8);
    }
    const auto is_random = [] { return RandomUniform(0, 1) < 0.3; };
    const auto edges = BoxEdges(TestCamera(), *box, {is_random(), false, false, is_random()}, 0.05);
    views.push_back({landmark.frame_from_object * in_camera.frame_from_object.Inverse(),
                     TangentBox(edges, in_camera), RandomUniform(0.2, 1.0)});
    normals.push_back(NormalsInObject(edges, in_camera));
  }
  static Eigen::Matrix<double, 3, 4> NormalsInObject(const std::array<BoxEdge, 4>& edges,
                                                     const Landmark& in_camera) {
    Eigen::Matrix<double, 3, 4> in_object;
    for (int i = 0; i < 4; ++i) {
      in_object.col(i) = in_camera.frame_from_object.rotation.conjugate() *
                         edges[static_cast<size_t>(i)].plane.normalized();
    }
    return in_object;
  }
  // Whether no edge's plane is near a kink of the body.
  bool AreOffKinks() const {
    return std::ranges::all_of(
        normals, [](const auto& normal) { return normal.cwiseAbs().minCoeff() > 0.1; });
  }

  void MoveBy(const Gradient& step) { Move(VariableKind::kLandmark, step.data(), block.data()); }
  void MoveByChance(double size) {
    Gradient step;
    for (double& value : step) value = RandomUniform(-size, size);
    MoveBy(step);
  }
  HeldViewsTerm Term(double huber_delta) const { return {0, block.data(), views, huber_delta}; }

  // What their TangencyTerms say together.
  Derivatives SumOfTangencies(Hessian kind) const {
    const std::array<double, kBiasSize> no_bias{};
    Derivatives sum;
    for (const HeldView& view : views) {
      const PoseBlock pose = ToParameterBlock(view.world_from_camera);
      const TangencyTerm term({0, 1, 2}, {pose.data(), block.data(), no_bias.data()}, view.box,
                              kHuberDelta, view.weight);
      sum.Add(term, 1, kind);
    }
    return sum;
  }

  Landmark landmark;
  LandmarkBlock block;
  std::vector<HeldView> views;
  std::vector<Eigen::Matrix<double, 3, 4>> normals;
};

void ExpectSumOfTangencies(const Views& views) {
  for (const Hessian kind : {Hessian::kInformation, Hessian::kFar, Hessian::kNear}) {
    const Derivatives expected = views.SumOfTangencies(kind);
    const HeldViewsTerm term = views.Term(kHuberDelta);
    Derivatives found;
    found.Add(term, 0, kind);
    EXPECT_NEAR(found.cost, expected.cost, 1e-11 * expected.cost);
    EXPECT_NEAR(term.Cost(), expected.cost, 1e-11 * expected.cost);
    EXPECT_LT((found.gradient - expected.gradient).norm(), 1e-9 * expected.hessian.norm());
    EXPECT_LT((found.hessian - expected.hessian).norm(), 1e-9 * expected.hessian.norm());
  }
}

TEST(HeldViewsTerm, IsTheSumOfItsTangencies) {
  for (const double p : kShapeExponents) {
    for (const size_t count : {1, 3, 4, 6, 9}) {
      Views views(p, count);
      views.MoveByChance(0.05);
      ExpectSumOfTangencies(views);
    }
  }
}

TEST(HeldViewsTerm, LeavesOutEdgesThatHaveNoTangentPoint) {
  for (const double p : kShapeExponents) {
    Views views(p, 5);
    TangentBox& without_left = views.views[0].box;
    std::shift_left(without_left.edges.begin(), without_left.edges.end(), 1);
    without_left.num_edges = 3;
    views.views[1].box.num_edges = 3;
    views.views[4].box.num_edges = 0;
    views.MoveByChance(0.05);
    ExpectSumOfTangencies(views);
  }
}

TEST(HeldViewsTerm, ComparesABodyBehindACameraAtATenthOfItsDepth) {
  for (const double p : kShapeExponents) {
    Views views(p, 6);
    const Eigen::Vector3d& camera = views.views[2].world_from_camera.translation;
    Gradient step = Gradient::Zero();
    step.segment<3>(3) = 1.1 * (camera - views.landmark.Centre());
    views.MoveBy(step);
    ExpectSumOfTangencies(views);
  }
}

// Against differences of the cost. Without a loss: its curvature is bounded from below on purpose.
TEST(HeldViewsTerm, DerivativesAgreeWithNumbers) {
  constexpr double kStep = 1e-4;
  for (const double p : kShapeExponents) {
    int checked = 0;
    for (int trial = 0; trial < 100; ++trial) {
      Views views(p, 2);
      if (!views.AreOffKinks()) continue;
      ++checked;
      Derivatives found;
      found.Add(views.Term(kNoLoss), 0, Hessian::kNear);
      const auto cost_after = [&](const Gradient& step) {
        const LandmarkBlock before = views.block;
        views.MoveBy(step);
        const double cost = views.Term(kNoLoss).Cost();
        views.block = before;
        return cost;
      };
      for (int i = 0; i < kLandmarkDof; ++i) {
        const Gradient along = kStep * Gradient::Unit(i);
        const double slope = (8.0 * (cost_after(along) - cost_after(-along)) -
                              (cost_after(2.0 * along) - cost_after(-2.0 * along))) /
                             (12.0 * kStep);
        EXPECT_NEAR(found.gradient[i], slope, 1e-6 * (1.0 + found.gradient.norm()));
        for (int j = 0; j <= i; ++j) {
          const Gradient across = kStep * Gradient::Unit(j);
          const double second = (cost_after(along + across) - cost_after(along - across) -
                                 cost_after(across - along) + cost_after(-along - across)) /
                                (4.0 * kStep * kStep);
          EXPECT_NEAR(found.hessian(i, j), second, 2e-4 * (1.0 + found.hessian.norm()))
              << p << " " << i << " " << j;
        }
      }
    }
    EXPECT_GT(checked, 2);
  }
}

TEST(HeldViewsTerm, IsInfiniteWhereItIsNotDefined) {
  for (const double p : kShapeExponents) {
    Views views(p, 3);
    views.block.back() = 1e3;  // of a half axis beyond numbers
    // Bound edges, too, must make the cost infinite: otherwise derivatives that are NaN would come
    // with a finite cost.
    for (HeldView& view : views.views) {
      for (TangentBox::Edge& edge : view.box.edges) edge.is_bound = RandomUniform(0, 1) < 0.5;
    }
    for (TangentBox::Edge& edge : views.views[1].box.edges) edge.is_bound = true;
    Derivatives found;
    found.Add(views.Term(kHuberDelta), 0, Hessian::kNear);
    EXPECT_EQ(found.cost, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(found.gradient.isZero(0.0));
    EXPECT_TRUE(found.hessian.isZero(0.0));
  }
}

}  // namespace
}  // namespace soslam
