// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "constraints/tangent_space.h"
#include "mapping/back_end_variables.h"
#include "mapping/term.h"

namespace soslam {

// Levenberg-Marquardt's damping (after Nielsen, 1999): a multiple of the Hessian's diagonal, of
// which no element counts as less than a tenth per unit (rad, m, logarithm): where next to nothing
// is known, steps stay within the size of things, as long as damping is more than next to none.
class Damping {
 public:
  Damping() = default;
  // From `value` on; never less than `least`. A step that brings what was predicted lets it fall to
  // `fall` of itself.
  Damping(double value, double least, double fall) : value_(value), least_(least), fall_(fall) {}
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
  double least_ = 1e-12;
  double fall_ = 1.0 / 3.0;
  double growth_ = 2.0;
};

// A term, and where its derivatives by all variables go: null for what is held.
struct PlacedTerm {
  const Term* term;
  TermPlaces places;
};

// One landmark's cost, all other variables as they are, and steps that lower it. What its terms say
// of other variables is kept along, so that the equations of all need not look at them again.
class LandmarkFit {
 public:
  using Gradient = Eigen::Matrix<double, kLandmarkDof, 1>;
  using Square = Eigen::Matrix<double, kLandmarkDof, kLandmarkDof>;
  struct Equations {
    double cost;
    Gradient gradient;  // by the landmark
    Square hessian;
    std::vector<double> others;  // derivatives that are not by the landmark alone, part by part
  };

  // `terms` are those that depend on the landmark, which `index` is among the variables.
  LandmarkFit(std::vector<Variable>* variables, int index, const std::vector<PlacedTerm>& terms);

  // Anew: other variables have changed.
  void Linearise(Hessian hessian);
  double cost() const { return at_.cost; }

  // One step of Levenberg-Marquardt, tried in memory that fits can share. False when none is
  // expected to lower the cost by more than the tolerance.
  bool Step(Hessian hessian, double tolerance, Equations* candidate);

  // Adds the derivatives by all variables to where they go.
  void AddToPlaces() const;

 private:
  // A term of the landmark.
  struct Part {
    PlacedTerm placed;
    size_t position;                                     // of the landmark among its variables
    std::array<int, TermPlaces::kMaxVariables> sizes{};  // tangents of its variables
  };
  // Calls visit(place, own place, size) for each block of a part's derivatives that is not by the
  // landmark alone, in the order in which they are kept.
  template <typename Visit>
  static void ForEachKept(const Part& part, TermPlaces* own, Visit visit);
  // kFar instead of kNear where that is not positive definite.
  void Evaluate(Hessian hessian, Equations* equations) const;
  void Add(Hessian hessian, Equations* equations) const;

  Variable* landmark_;
  std::vector<Part> parts_;
  size_t num_others_ = 0;
  Equations at_;
  Damping damping_;
};

}  // namespace soslam
