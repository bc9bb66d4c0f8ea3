// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "soslam/constraints/landmark_cost.h"
#include "support/numeric_derivatives.h"

namespace soslam {

// The derivative of a function of a landmark is what central differences of fourth order say.
template <typename Function>
void ExpectDerivative(const LandmarkJacobian1& derivative, const Landmark& landmark,
                      const Function& function) {
  constexpr double kStep = 1e-4;
  for (int i = 0; i < kLandmarkDof; ++i) {
    const auto moved = [&](double step) -> double {
      return function(ApplyStep(landmark, step * LandmarkStep::Unit(i)));
    };
    EXPECT_NEAR(derivative[i], DerivativeAtZero(moved, kStep), 1e-7 * (1.0 + derivative.norm()))
        << "parameter " << i;
  }
}

// The model's cost is the value, and its gradient that of the value.
inline void ExpectCorrectGradient(const LandmarkCost& cost, const Landmark& landmark) {
  LandmarkModel model;
  cost.AddTo(landmark, &model);
  EXPECT_NEAR(model.cost, cost.Value(landmark), 1e-12 * (1.0 + model.cost));
  ExpectDerivative(model.gradient.transpose(), landmark,
                   [&](const Landmark& moved) { return cost.Value(moved); });
}

inline void ExpectSameModels(const LandmarkModel& one, const LandmarkModel& other) {
  EXPECT_NEAR(one.cost, other.cost, 1e-9 * (1.0 + other.cost));
  EXPECT_LT((one.gradient - other.gradient).norm(), 1e-9 * (1.0 + other.gradient.norm()));
  EXPECT_LT((one.information - other.information).norm(), 1e-9 * (1.0 + other.information.norm()));
}

}  // namespace soslam
