// SPDX-License-Identifier: BSD-3-Clause
#include "initialisation/upright.h"

#include <ceres/loss_function.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>

#include "support/jacobians.h"
#include "support/random_estimates.h"
#include "support/shape_exponents.h"
#include "support/upright_bodies.h"

namespace soslam {
namespace {

constexpr double kPi = std::numbers::pi;

UprightVector RandomParameters() {
  UprightVector parameters;
  parameters << RandomUniform(-3.1, 3.1), RandomUniform(-3, 3), RandomUniform(-3, 3),
      RandomVector(-2.0, 0.5);
  return parameters;
}

Landmark RandomUpright(const Plane& plane) {
  return UprightLandmark(plane, RandomParameters(), RandomUniform(1, 2));
}

TEST(UprightLandmark, StandsUprightOnItsPlane) {
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const Plane plane = RandomPlane();
      const Landmark landmark = UprightLandmark(plane, RandomParameters(), p);
      EXPECT_LT(
          (landmark.frame_from_object.rotation * Eigen::Vector3d::UnitZ() - plane.normal).norm(),
          1e-12);
      EXPECT_EQ(landmark.shape_exponent, p);
      const FarthestPoint lowest = Farthest(landmark, -plane.normal);
      // Rounded edges reach beyond the body itself by a thousandth of its size.
      const double rounding = kEdgeRounding * (2.0 - p) * landmark.half_axes.sum();
      EXPECT_NEAR(-lowest.distance + plane.offset, 0.0, 1e-12 + rounding) << p;
      for (int k = 0; k < 20; ++k) {
        EXPECT_GE(plane.SignedDistance(RandomSurfacePoint(landmark)), -1e-12) << p;
      }
    }
  }
}

TEST(UprightLandmark, HasTheGivenYawFootAndHalfAxes) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane = RandomPlane();
    const UprightVector parameters = RandomParameters();
    const Landmark landmark = UprightLandmark(plane, parameters, 1.5);
    EXPECT_NEAR(Yaw(plane.normal, landmark.frame_from_object.rotation), parameters(0), 1e-12);
    EXPECT_LT((landmark.half_axes.array() - parameters.tail<3>().array().exp()).matrix().norm(),
              1e-12);
    // The foot, from the point of the plane that is nearest to the origin.
    const Eigen::Vector3d foot =
        landmark.Centre() - plane.SignedDistance(landmark.Centre()) * plane.normal;
    const Eigen::Vector3d from_nearest = foot + plane.offset * plane.normal;
    const Eigen::Vector3d along_axes =
        UprightRotation(plane.normal, 0.0).conjugate() * from_nearest;
    EXPECT_LT((along_axes - Eigen::Vector3d(parameters(1), parameters(2), 0.0)).norm(), 1e-12);
  }
}

TEST(UprightParameters, AreThoseThatTheLandmarkWasMadeOf) {
  for (int i = 0; i < 100; ++i) {
    const Plane plane = RandomPlane();
    const UprightVector parameters = RandomParameters();
    const Landmark landmark = UprightLandmark(plane, parameters, 1.5);
    EXPECT_LT((UprightParameters(plane, landmark) - parameters).norm(), 1e-12);
  }
}

TEST(UprightParameters, OfATiltedLandmarkOffThePlaneSetItUprightOnThePlane) {
  constexpr double kTilt = 1e-3;
  for (int i = 0; i < 100; ++i) {
    const Plane plane = RandomPlane();
    const Landmark upright = RandomUpright(plane);
    const Eigen::Vector3d tilt_axis =
        UprightRotation(plane.normal, RandomUniform(-3, 3)) * Eigen::Vector3d::UnitX();
    Landmark tilted = upright;
    tilted.frame_from_object.rotation =
        ExpRotation(kTilt * tilt_axis) * upright.frame_from_object.rotation;
    tilted.frame_from_object.translation += RandomUniform(-0.3, 0.3) * plane.normal;
    const Landmark found = UprightLandmark(plane, UprightParameters(plane, tilted), 1.5);
    EXPECT_LT((found.Centre() - upright.Centre()).norm(), 1e-12);
    EXPECT_LT((found.half_axes - upright.half_axes).norm(), 1e-12);
    EXPECT_LT(found.frame_from_object.rotation.angularDistance(upright.frame_from_object.rotation),
              kTilt * kTilt);
  }
}

TEST(UprightByParameters, AgreesWithNumbers) {
  constexpr double kStep = 1e-3;
  for (int i = 0; i < 50; ++i) {
    const Plane plane = RandomPlane();
    const UprightVector parameters = RandomParameters();
    const Landmark landmark = UprightLandmark(plane, parameters, 1.5);
    // The nine parameters of kLandmarkDof, from those of the landmark.
    const auto moved = [&](int k, double step) {
      UprightVector at = parameters;
      at(k) += step;
      const Landmark other = UprightLandmark(plane, at, 1.5);
      Eigen::Matrix<double, kLandmarkDof, 1> tangent;
      tangent << LogRotation(other.frame_from_object.rotation *
                             landmark.frame_from_object.rotation.conjugate()),
          other.Centre() - landmark.Centre(),
          (other.half_axes.array() / landmark.half_axes.array()).log().matrix();
      return tangent;
    };
    const UprightJacobian jacobian = UprightByParameters(plane, landmark);
    for (int k = 0; k < 6; ++k) {
      const Eigen::Matrix<double, kLandmarkDof, 1> numeric =
          (8.0 * (moved(k, kStep) - moved(k, -kStep)) -
           (moved(k, 2.0 * kStep) - moved(k, -2.0 * kStep))) /
          (12.0 * kStep);
      EXPECT_LT((jacobian.col(k) - numeric).norm(), 1e-9)
          << "parameter " << k << ": analytic " << jacobian.col(k).transpose() << ", numeric "
          << numeric.transpose();
    }
  }
}

// A term as a residual of one landmark block, whose shape exponent is fixed.
class TermResidual final : public ceres::CostFunction {
 public:
  TermResidual(const LandmarkTerm& term, double shape_exponent)
      : term_(term), shape_exponent_(shape_exponent) {
    set_num_residuals(term.NumResiduals());
    mutable_parameter_block_sizes()->push_back(kLandmarkSize);
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const Landmark landmark = WithShape(UnpackLandmark(blocks[0]), shape_exponent_);
    const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
    LandmarkTerm::Jacobian jacobian(num_residuals(), kLandmarkDof);
    // What a term leaves unwritten shows.
    jacobian.setConstant(std::numeric_limits<double>::quiet_NaN());
    term_.Evaluate(landmark, Eigen::Map<Eigen::VectorXd>(residuals, num_residuals()),
                   wanted ? &jacobian : nullptr);
    if (wanted) WriteLandmarkJacobian<Eigen::Dynamic>(blocks[0], jacobian, jacobians[0]);
    return true;
  }

 private:
  const LandmarkTerm& term_;
  double shape_exponent_;
};

void ExpectCorrectTermJacobian(const LandmarkTerm& term, const Landmark& landmark) {
  const LandmarkBlock block = Pack(landmark);
  ExpectCorrectJacobians(TermResidual(term, landmark.shape_exponent), {block.data()});
}

Eigen::VectorXd Residuals(const LandmarkTerm& term, const Landmark& landmark) {
  Eigen::VectorXd residuals(term.NumResiduals());
  term.Evaluate(landmark, residuals, nullptr);
  return residuals;
}

double Cost(const LandmarkTerm& term, const Landmark& landmark) {
  return 0.5 * Residuals(term, landmark).squaredNorm();
}

// A landmark's own box, with errors of up to 10 % of its sides; any of its edges may be a bound.
std::array<BoxEdge, 4> EdgesNear(const Landmark& landmark) {
  const Box box = Disturbed(*OutlineBox(TestCamera(), landmark), 0.1);
  const auto bits = TestRandom()();
  return BoxEdges(TestCamera(), box,
                  {(bits & 1U) != 0, (bits & 2U) != 0, (bits & 4U) != 0, (bits & 8U) != 0},
                  kDetectionSigmaFraction);
}

// Whether no edge is where its residual bends within the steps of numeric differences: its plane
// along a face of the body, or the body just at a bound.
bool AreOffTheKinks(const std::array<BoxEdge, 4>& edges, const Landmark& landmark) {
  return std::all_of(edges.begin(), edges.end(), [&](const BoxEdge& edge) {
    BoxEdge measured = edge;
    measured.is_bound = false;
    const double outside = Tangency(measured, landmark, TangentDepth(edge, landmark), 0.0, nullptr);
    if (edge.is_bound && std::abs(outside) < 0.1) return false;
    const Eigen::Vector3d in_object =
        landmark.frame_from_object.rotation.conjugate() * edge.plane.normalized();
    return landmark.shape_exponent == kEllipsoidExponent || in_object.cwiseAbs().minCoeff() > 0.1;
  });
}

TEST(BoxTerm, JacobianAgreesWithNumbers) {
  for (const double p : kShapeExponents) {
    SCOPED_TRACE(p);
    int checked = 0;
    while (checked < 20) {
      const Landmark landmark = WithShape(RandomLandmarkInCamera(), p);
      const auto edges = EdgesNear(landmark);
      if (!AreOffTheKinks(edges, landmark)) continue;
      ExpectCorrectTermJacobian(BoxTerm(edges, landmark), landmark);
      ++checked;
    }
  }
}

TEST(BoxTerm, IsZeroForTheOutlineBoxAndCountsStandardDeviations) {
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const Landmark landmark = WithShape(RandomLandmarkInCamera(), p);
      const Box box = *OutlineBox(TestCamera(), landmark);
      const auto edges = BoxEdges(TestCamera(), box, {}, kDetectionSigmaFraction);
      EXPECT_LT(Residuals(BoxTerm(edges, landmark), landmark).cwiseAbs().maxCoeff(), 1e-9);
      // A thousandth of a standard deviation narrower on every side, and the body reaches out that
      // much on each.
      const double dx = 1e-3 * edges[0].sigma_px;
      const double dy = 1e-3 * edges[1].sigma_px;
      auto narrower =
          BoxEdges(TestCamera(), {box.x_min + dx, box.y_min + dy, box.x_max - dx, box.y_max - dy},
                   {}, kDetectionSigmaFraction);
      for (size_t k = 0; k < 4; ++k) narrower[k].sigma_px = edges[k].sigma_px;
      const Eigen::VectorXd outside = Residuals(BoxTerm(narrower, landmark), landmark);
      EXPECT_LT((outside.array() - 1e-3).abs().maxCoeff(), 1e-5) << outside.transpose();
    }
  }
}

TEST(RatioTerm, JacobianAgreesWithNumbers) {
  for (int i = 0; i < 20; ++i) {
    const ShapePrior prior{RandomVector(0.3, 3.0).head<2>(), RandomVector(0.05, 0.5).head<2>(),
                           kCuboidExponent, i % 2 == 0 ? 0.0 : RandomUniform(-0.95, 0.95)};
    ExpectCorrectTermJacobian(RatioTerm(prior), RandomLandmarkInCamera());
  }
}

TEST(RatioTerm, CountsStandardDeviationsOfTheLogarithms) {
  for (int i = 0; i < 20; ++i) {
    const ShapePrior prior{RandomVector(0.3, 3.0).head<2>(), RandomVector(0.05, 0.5).head<2>(),
                           kCuboidExponent};
    const Eigen::Vector2d deviations = RandomVector(-3, 3).head<2>();
    Landmark landmark = RandomLandmarkInCamera();
    for (int k = 0; k < 2; ++k) {
      landmark.half_axes[k] =
          landmark.half_axes.z() * prior.ratio[k] * std::exp(deviations[k] * prior.log_sigma[k]);
    }
    EXPECT_LT((Residuals(RatioTerm(prior), landmark) - deviations).norm(), 1e-10);
  }
}

TEST(RatioTerm, CostIsThatOfTheCovariance) {
  for (int i = 0; i < 20; ++i) {
    const ShapePrior prior{RandomVector(0.3, 3.0).head<2>(), RandomVector(0.05, 0.5).head<2>(),
                           kCuboidExponent, RandomUniform(-0.95, 0.95)};
    const Landmark landmark = RandomLandmarkInCamera();
    const Eigen::Vector2d error =
        (landmark.half_axes.head<2>().array() / landmark.half_axes.z() / prior.ratio.array())
            .log()
            .matrix();
    Eigen::Matrix2d covariance = prior.log_sigma.cwiseAbs2().asDiagonal();
    covariance(0, 1) = covariance(1, 0) =
        prior.log_correlation * prior.log_sigma.x() * prior.log_sigma.y();
    const double expected = error.dot(covariance.inverse() * error);
    EXPECT_NEAR(Residuals(RatioTerm(prior), landmark).squaredNorm() / expected, 1.0, 1e-9);
  }
}

// The axis of the world at an angle from an upright landmark's front.
Eigen::Vector3d AxisAt(const Plane& plane, const Landmark& landmark, double angle) {
  const double yaw = Yaw(plane.normal, landmark.frame_from_object.rotation) + angle;
  return UprightRotation(plane.normal, yaw) * Eigen::Vector3d::UnitX();
}

TEST(AxisTerm, JacobianAgreesWithNumbersForUprightLandmarks) {
  for (int i = 0; i < 50; ++i) {
    const Plane plane = RandomPlane();
    const Landmark landmark = RandomUpright(plane);
    const AxisTerm term(plane, AxisAt(plane, landmark, RandomUniform(-3.1, 3.1)),
                        RandomUniform(0.1, 10.0));
    ExpectCorrectTermJacobian(term, landmark);
  }
}

TEST(AxisTerm, CostsNothingAlongAndAcrossTheAxisAndItsWeightHalfWayBetween) {
  for (int i = 0; i < 50; ++i) {
    const Plane plane = RandomPlane();
    const Landmark landmark = RandomUpright(plane);
    const double weight = RandomUniform(0.1, 10.0);
    for (int eighth = 0; eighth < 8; ++eighth) {
      const AxisTerm term(plane, AxisAt(plane, landmark, eighth * kPi / 4.0), weight);
      EXPECT_NEAR(Cost(term, landmark), eighth % 2 == 0 ? 0.0 : weight, 1e-9) << eighth;
    }
    const double angle = RandomUniform(-3.1, 3.1);
    EXPECT_NEAR(Cost(AxisTerm(plane, AxisAt(plane, landmark, angle), weight), landmark),
                weight * std::pow(std::sin(2.0 * angle), 2), 1e-9);
  }
}

// A landmark in a reference frame, another frame from which a camera sees it, and its box there.
struct ReferenceView {
  Rigid3d camera_from_reference = RandomRigid();
  Landmark in_camera = WithShape(RandomLandmarkInCamera(), RandomUniform(1.3, 2.0));
  std::array<BoxEdge, 4> edges = EdgesNear(in_camera);
  Landmark in_reference = Transform(camera_from_reference.Inverse(), in_camera);
  double delta = RandomUniform(0.5, 4.0);
  double weight = RandomUniform(0.1, 2.0);
  RobustViewTerm term{std::make_unique<BoxTerm>(edges, in_camera), camera_from_reference, delta,
                      weight};

  // Of the box in its own camera's frame, neither robust nor weighted.
  Eigen::VectorXd PlainResiduals() const { return Residuals(BoxTerm(edges, in_camera), in_camera); }
};

TEST(RobustViewTerm, HalfOfItsSquareIsTheWeightedHuberLoss) {
  int within = 0;
  int beyond = 0;
  for (int i = 0; i < 100; ++i) {
    const ReferenceView view;
    const Eigen::VectorXd plain = view.PlainResiduals();
    const Eigen::VectorXd robust = Residuals(view.term, view.in_reference);
    ASSERT_EQ(robust.size(), plain.size());
    const ceres::HuberLoss huber(view.delta);
    for (Eigen::Index k = 0; k < plain.size(); ++k) {
      double loss[3];
      huber.Evaluate(plain[k] * plain[k], loss);
      EXPECT_NEAR(robust[k] * robust[k], view.weight * loss[0], 1e-8 * (1.0 + loss[0]));
      EXPECT_GE(robust[k] * plain[k], 0.0);
      within += plain[k] != 0.0 && std::abs(plain[k]) < view.delta ? 1 : 0;
      beyond += std::abs(plain[k]) > view.delta ? 1 : 0;
    }
  }
  EXPECT_GT(within, 50);
  EXPECT_GT(beyond, 50);
}

TEST(RobustViewTerm, JacobianAgreesWithNumbers) {
  int checked = 0;
  while (checked < 50) {
    const ReferenceView view;
    // Where the loss turns from square to linear, its slope bends.
    const bool at_delta = ((view.PlainResiduals().array().abs() - view.delta).abs() < 0.1).any();
    if (at_delta || !AreOffTheKinks(view.edges, view.in_camera)) continue;
    ExpectCorrectTermJacobian(view.term, view.in_reference);
    ++checked;
  }
}

LandmarkTerms BoxAndRatio(const std::array<BoxEdge, 4>& edges, const ShapePrior& prior,
                          const Landmark& start) {
  LandmarkTerms terms;
  terms.push_back(std::make_unique<BoxTerm>(edges, start));
  terms.push_back(std::make_unique<RatioTerm>(prior));
  return terms;
}

double Cost(const LandmarkTerms& terms, const Landmark& landmark) {
  double cost = 0.0;
  for (const auto& term : terms) cost += Cost(*term, landmark);
  return cost;
}

Landmark DisturbedFootAndSize(const Landmark& landmark, const Plane& plane) {
  UprightVector parameters = UprightParameters(plane, landmark);
  parameters.segment<2>(1) += 0.2 * RandomVector(-1, 1).head<2>();
  parameters.tail<3>() += RandomVector(-0.2, 0.2);
  return UprightLandmark(plane, parameters, landmark.shape_exponent);
}

// The solver stops where a step would gain less than a millionth of a squared standard deviation.
constexpr double kCostTolerance = 1e-6;

TEST(FitUpright, FindsTheBodyOfAnExactBoxAtItsYaw) {
  for (const double p : kShapeExponents) {
    for (int i = 0; i < 20; ++i) {
      const StandingBody body(p);
      const Landmark start = DisturbedFootAndSize(body.truth, body.plane);
      const auto terms = BoxAndRatio(body.observation.edges, body.observation.prior, start);
      const auto solution = FitUpright(body.plane, start, terms, /*yaw_is_free=*/false);
      ASSERT_TRUE(solution);
      EXPECT_LT(solution->cost, kCostTolerance) << p;
      EXPECT_TRUE(IsSameBody(solution->landmark, body.truth, 2e-3)) << p;
    }
  }
}

TEST(FitUpright, LowersTheCostThatItReportsAndKeepsWhatItIsTold) {
  for (int i = 0; i < 100; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    const auto edges = body.Observe(Disturbed(body.box, 0.05)).edges;
    const Landmark start =
        Turned(DisturbedFootAndSize(body.truth, body.plane), RandomUniform(-0.5, 0.5));
    const auto terms = BoxAndRatio(edges, body.observation.prior, start);
    for (const bool yaw_is_free : {false, true}) {
      const auto solution = FitUpright(body.plane, start, terms, yaw_is_free);
      ASSERT_TRUE(solution);
      const Landmark& landmark = solution->landmark;
      EXPECT_NEAR(solution->cost, Cost(terms, landmark), 1e-9 * (1.0 + solution->cost));
      EXPECT_LE(solution->cost, Cost(terms, start));
      EXPECT_EQ(landmark.shape_exponent, start.shape_exponent);
      EXPECT_NEAR(body.plane.SignedDistance(landmark.Centre()), landmark.half_axes.z(), 1e-9);
      if (yaw_is_free) continue;
      EXPECT_LT(AngleBetweenFronts(landmark, start), 1e-9);
    }
  }
}

// From starts as the sweep over yaw has them, one run of the solver is enough.
TEST(FitUpright, GainsNothingWhenItIsRunAgain) {
  constexpr int kBodies = 300;
  int unfinished = 0;
  double largest_gain = 0.0;
  for (int i = 0; i < kBodies; ++i) {
    const StandingBody body(RandomUniform(1, 2));
    const UprightObservation observation = body.Observe(Disturbed(body.box, 0.02));
    const auto start = SolveAtYaw(observation, body.Yaw() + RandomUniform(-0.05, 0.05));
    ASSERT_TRUE(start);
    const auto terms = BoxAndRatio(observation.edges, observation.prior, *start);
    const auto once = FitUpright(body.plane, *start, terms, /*yaw_is_free=*/true);
    ASSERT_TRUE(once);
    auto again = once;
    for (int run = 0; run < 20 && again; ++run) {
      again = FitUpright(body.plane, again->landmark, terms, /*yaw_is_free=*/true);
    }
    ASSERT_TRUE(again);
    EXPECT_LE(again->cost, once->cost + 1e-9);
    unfinished += again->cost < once->cost - 1e-3 ? 1 : 0;
    largest_gain = std::max(largest_gain, once->cost - again->cost);
  }
  EXPECT_LE(unfinished, kBodies / 100) << "largest gain " << largest_gain;
}

// Four views of a body from around it hold all of its parameters without any prior.
TEST(FitUpright, FindsTheBodyThatSeveralViewsSee) {
  for (const double p : {1.1, 1.5, 2.0}) {
    for (int i = 0; i < 5; ++i) {
      const StandingBody body(p);
      const Landmark start =
          Turned(DisturbedFootAndSize(body.truth, body.plane), RandomUniform(-0.1, 0.1));
      LandmarkTerms terms;
      for (const double turn : {0.0, 0.6, 1.3, 2.2}) {
        // The camera goes round the body.
        const Rigid3d round = {ExpRotation(turn * body.plane.normal), {0, 0, 0}};
        const Rigid3d to_centre = {Eigen::Quaterniond::Identity(), -body.truth.Centre()};
        const Rigid3d camera_from_reference = to_centre.Inverse() * round * to_centre;
        const Landmark in_camera = Transform(camera_from_reference, body.truth);
        const Box box = *OutlineBox(TestCamera(), in_camera);
        const auto edges = BoxEdges(TestCamera(), box, {}, kDetectionSigmaFraction);
        terms.push_back(std::make_unique<RobustViewTerm>(
            std::make_unique<BoxTerm>(edges, Transform(camera_from_reference, start)),
            camera_from_reference, /*huber_delta=*/10.0, /*weight=*/1.0));
      }
      const auto solution = FitUpright(body.plane, start, terms, /*yaw_is_free=*/true);
      ASSERT_TRUE(solution);
      EXPECT_LT(solution->cost, 10.0 * kCostTolerance);
      const Landmark& found = solution->landmark;
      EXPECT_TRUE(IsSameBody(found, body.truth, 1e-2) ||
                  IsSameBody(WithAxesExchanged(found), body.truth, 1e-2))
          << p;
    }
  }
}

// No number at some landmarks, where `is_undefined` says.
class UndefinedTerm final : public LandmarkTerm {
 public:
  explicit UndefinedTerm(std::function<bool(const Landmark&)> is_undefined)
      : is_undefined_(std::move(is_undefined)) {}
  int NumResiduals() const override { return 1; }
  void Evaluate(const Landmark& landmark, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override {
    residuals[0] = is_undefined_(landmark) ? std::numeric_limits<double>::quiet_NaN() : 0.0;
    if (jacobian != nullptr) jacobian->setZero();
  }

 private:
  std::function<bool(const Landmark&)> is_undefined_;
};

TEST(FitUpright, HasNoSolutionWhereTheCostIsNoNumberAtTheStart) {
  const StandingBody body(1.5);
  LandmarkTerms terms = BoxAndRatio(body.observation.edges, body.observation.prior, body.truth);
  terms.push_back(std::make_unique<UndefinedTerm>([](const Landmark&) { return true; }));
  EXPECT_FALSE(FitUpright(body.plane, body.truth, terms, /*yaw_is_free=*/true));
}

TEST(FitUpright, StaysWhereTheCostIsANumber) {
  for (int i = 0; i < 20; ++i) {
    const StandingBody body(1.5);
    const Landmark start = DisturbedFootAndSize(body.truth, body.plane);
    LandmarkTerms terms = BoxAndRatio(body.observation.edges, body.observation.prior, start);
    const double between = 0.5 * (start.half_axes.z() + body.truth.half_axes.z());
    const bool is_beyond_below = body.truth.half_axes.z() < between;
    terms.push_back(std::make_unique<UndefinedTerm>([=](const Landmark& landmark) {
      return (landmark.half_axes.z() < between) == is_beyond_below;
    }));
    const auto solution = FitUpright(body.plane, start, terms, /*yaw_is_free=*/true);
    if (!solution) continue;
    EXPECT_TRUE(std::isfinite(Cost(terms, solution->landmark)));
    EXPECT_LE(solution->cost, Cost(terms, start));
  }
}

}  // namespace
}  // namespace soslam
