// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "mapping/back_end_variables.h"
#include "mapping/term.h"

namespace soslam {

// A cost of a number x, and what is said of its second derivative.
struct Curve {
  double cost, slope, far, near;
};
using CurveOf = std::function<Curve(double x)>;

// Where a variable has its x: an offset is one, of poses and landmarks it is that in the world.
inline double& XOf(const Variable& variable) {
  return variable.values[variable.kind == VariableKind::kOffset ? 0 : 4];
}

// A cost of the last of its variables: of its x alone, and hence not of the others.
class CurveTerm final : public Term {
 public:
  CurveTerm(const std::vector<int>& variables, const Variable& last, CurveOf curve)
      : Term(variables), last_(last), curve_(std::move(curve)) {}

  double Cost() const override { return curve_(XOf(last_)).cost; }

  double Linearise(Hessian hessian, const TermPlaces& places) const override {
    ++linearised_;
    const Curve at = curve_(XOf(last_));
    const size_t last = variables().size() - 1;
    if (places.gradient[last] == nullptr) return at.cost;
    const int size = NumTangents(last_.kind), x = last_.kind == VariableKind::kOffset ? 0 : 3;
    places.gradient[last][x] += at.slope;
    // What no cost depends on is in its minimum.
    for (int i = 0; i < size; ++i) places.hessian[last][last][i * (size + 1)] += i == x ? 0.0 : 1.0;
    places.hessian[last][last][x * (size + 1)] += hessian == Hessian::kNear ? at.near : at.far;
    return at.cost;
  }

  int times_linearised() const { return linearised_; }

 private:
  Variable last_;
  CurveOf curve_;
  mutable int linearised_ = 0;
};

}  // namespace soslam
