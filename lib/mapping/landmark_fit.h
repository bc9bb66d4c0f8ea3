// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "constraints/tangent_space.h"
#include "mapping/back_end_variables.h"
#include "mapping/term.h"

namespace soslam {

// Levenberg-Marquardt's damping (after Nielsen, 1999): a multiple of the Hessian's diagonal, of
// which no element counts as less than a tenth per unit (rad, m, logarithm): where next to nothing
// is known, steps stay within the size of things.
class Damping {
 public:
  // What is added to the Hessian's diagonal.
  template <typename Vector>
  Vector Of(const Vector& diagonal) const {
    constexpr double kLeastInformation = 0.1;
    return value_ * diagonal.cwiseAbs().cwiseMax(kLeastInformation);
  }
  // `gain`: what a step has brought, as a share of what was predicted.
  void StepTaken(double gain);
  void StepRefused();
  // So large that steps do not change anything any more.
  bool IsExhausted() const { return value_ > 1e16; }

 private:
  double value_ = 1e-4;
  double growth_ = 2.0;
};

// One landmark's cost, all other variables as they are, and steps that lower it.
class LandmarkFit {
 public:
  // `terms` are those that depend on the landmark.
  LandmarkFit(Variable* landmark, int index, std::vector<const Term*> terms);

  // Anew: other variables have changed.
  double Linearise(Hessian hessian);
  double cost() const { return at_.cost; }
  // What it was linearised with: kFar instead of kNear where that is not positive definite.
  Hessian hessian() const { return at_.kind; }

  // One step of Levenberg-Marquardt. False when none is expected to lower the cost by more than the
  // tolerance.
  bool Step(Hessian hessian, double tolerance);

 private:
  struct Equations {
    Hessian kind;
    double cost;
    Eigen::Matrix<double, kLandmarkDof, 1> gradient;
    Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> hessian;
  };
  void Evaluate(Hessian hessian, Equations* equations) const;
  void Add(Hessian hessian, Equations* equations) const;

  Variable* landmark_;
  std::vector<const Term*> terms_;
  std::vector<size_t> positions_;  // of the landmark among each term's variables
  Equations at_, candidate_;
  Damping damping_;
};

}  // namespace soslam
