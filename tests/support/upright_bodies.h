// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "soslam/initialisation/body_at_yaw.h"
#include "soslam/initialisation/object_evidence.h"
#include "support/drawn_cuboids.h"
#include "support/random.h"
#include "support/shape_exponents.h"

namespace soslam {

inline constexpr double kDetectionSigmaFraction = 0.02;

inline double RandomYaw() { return RandomUniform(-3.1, 3.1); }

inline UprightVector RandomUprightParameters() {
  UprightVector parameters;
  parameters << RandomYaw(), RandomUniform(-3, 3), RandomUniform(-3, 3), RandomVector(-2.0, 0.5),
      RandomUniform(-1, 1);
  return parameters;
}

// A floor as a camera sees it that looks level or down.
inline Plane RandomFloor() {
  const Eigen::Vector3d up(RandomUniform(-0.15, 0.15), -1.0, RandomUniform(-0.7, 0.05));
  return {up.normalized(), RandomUniform(0.8, 1.6)};
}

inline constexpr double kMinBoxSidePx = 40.0;

// A body that stands on the floor at any yaw, near enough for a box of kMinBoxSidePx.
inline Landmark RandomUprightBody(const Plane& floor, const ShapeExponents& shape_exponents) {
  for (;;) {
    Landmark landmark =
        StandingCuboid(TestCamera(), floor, {RandomUniform(150, 490), RandomUniform(250, 440)},
                       RandomYaw(), RandomVector(0.15, 0.6));
    landmark.shape_exponents = shape_exponents;
    const auto box = OutlineBox(TestCamera(), landmark);
    if (landmark.Centre().z() > 0.0 && box && box->Width() > kMinBoxSidePx &&
        box->Height() > kMinBoxSidePx) {
      return landmark;
    }
  }
}

inline ShapePrior PriorOf(const Landmark& landmark, double log_sigma) {
  return {landmark.half_axes.head<2>() / landmark.half_axes.z(),
          Eigen::Vector2d::Constant(log_sigma), landmark.shape_exponents};
}

inline ObjectEvidence EvidenceOfBox(const Box& box, const std::array<bool, 4>& is_one_sided,
                                    const Plane& floor, const ShapePrior& prior) {
  ObjectEvidence evidence;
  evidence.views = {
      {BoxEdges(TestCamera(), box, is_one_sided, kDetectionSigmaFraction), Rigid3d()}};
  evidence.plane = floor;
  evidence.prior = prior;
  evidence.scene_axis =
      (UprightRotation(floor.normal, RandomYaw()) * Eigen::Vector3d::UnitX()).eval();
  evidence.huber_delta = std::numeric_limits<double>::infinity();
  return evidence;
}

// A body, and the evidence of one exact box and its true ratio.
struct ObservedBody {
  explicit ObservedBody(const ShapeExponents& shape_exponents, double ratio_log_sigma = 0.05)
      : plane(RandomFloor()),
        truth(RandomUprightBody(plane, shape_exponents)),
        box(*OutlineBox(TestCamera(), truth)),
        evidence(EvidenceOfBox(box, {}, plane, PriorOf(truth, ratio_log_sigma))) {}

  double Yaw() const { return soslam::Yaw(plane.normal, truth.frame_from_object.rotation); }
  // The same evidence with another box.
  ObjectEvidence Observe(const Box& other, const std::array<bool, 4>& is_one_sided = {}) const {
    ObjectEvidence changed = evidence;
    changed.views[0].edges = BoxEdges(TestCamera(), other, is_one_sided, kDetectionSigmaFraction);
    return changed;
  }

  Plane plane;
  Landmark truth;
  Box box;
  ObjectEvidence evidence;
};

inline std::optional<Landmark> SolveAtYaw(const ObjectEvidence& evidence, double yaw) {
  return BodyAtYaw(evidence).Solve(yaw);
}

// Each edge moved by up to `fraction` of the box's width or height.
inline Box Disturbed(const Box& box, double fraction) {
  const auto shift = [&](double side) { return fraction * side * RandomUniform(-1.0, 1.0); };
  return {box.x_min + shift(box.Width()), box.y_min + shift(box.Height()),
          box.x_max + shift(box.Width()), box.y_max + shift(box.Height())};
}

// The angle (rad) between the fronts of two upright landmarks, front and back being the same.
inline double AngleBetweenFronts(const Landmark& one, const Landmark& other) {
  const auto front = [](const Landmark& landmark) -> Eigen::Vector3d {
    return landmark.frame_from_object.rotation * Eigen::Vector3d::UnitX();
  };
  const double cosine = std::abs(front(one).dot(front(other)));
  return std::atan2(front(one).cross(front(other)).norm(), cosine);
}

// Whether two landmarks of one plane are the same body, within a fraction of its size.
inline testing::AssertionResult IsSameBody(const Landmark& found, const Landmark& expected,
                                           double tolerance) {
  const double size = expected.half_axes.maxCoeff();
  const double centre = (found.Centre() - expected.Centre()).norm() / size;
  const double half_axes = (found.half_axes - expected.half_axes).norm() / size;
  const double front = AngleBetweenFronts(found, expected);
  if (centre <= tolerance && half_axes <= tolerance && front <= tolerance &&
      found.shape_exponents == expected.shape_exponents) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure()
         << "differ by (fractions of the size) centre " << centre << ", half axes " << half_axes
         << ", front " << front << " rad; shape exponents " << found.shape_exponents << " and "
         << expected.shape_exponents;
}

inline Eigen::VectorXd Residuals(const LandmarkTerm& term, const Landmark& landmark) {
  Eigen::VectorXd residuals(term.NumResiduals());
  term.Evaluate(landmark, residuals, nullptr);
  return residuals;
}

}  // namespace soslam
