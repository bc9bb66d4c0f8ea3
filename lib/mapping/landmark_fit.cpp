// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/landmark_fit.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "initialisation/levenberg_marquardt.h"

namespace soslam {

void Damping::StepTaken(double gain) {
  value_ = std::max(least_, value_ * std::max(fall_, 1.0 - std::pow(2.0 * gain - 1.0, 3)));
  growth_ = 2.0;
}

void Damping::StepRefused() {
  value_ *= growth_;
  growth_ *= 2.0;
}

LandmarkFit::LandmarkFit(std::vector<Variable>* variables, int index,
                         const std::vector<PlacedTerm>& terms)
    : landmark_(&(*variables)[static_cast<size_t>(index)]) {
  for (const PlacedTerm& placed : terms) {
    const auto& of_term = placed.term->variables();
    Part part{placed, 0, {}};
    for (size_t i = 0; i < of_term.size(); ++i) {
      if (of_term[i] == index) part.position = i;
      part.sizes[i] = NumTangents((*variables)[static_cast<size_t>(of_term[i])].kind);
    }
    TermPlaces own;
    ForEachKept(part, &own,
                [&](double*, double**, int size) { num_others_ += static_cast<size_t>(size); });
    parts_.push_back(part);
  }
}

template <typename Visit>
void LandmarkFit::ForEachKept(const Part& part, TermPlaces* own, Visit visit) {
  const TermPlaces& places = part.placed.places;
  for (size_t i = 0; i < part.sizes.size(); ++i) {
    if (i != part.position && places.gradient[i] != nullptr) {
      visit(places.gradient[i], &own->gradient[i], part.sizes[i]);
    }
    for (size_t j = 0; j <= i; ++j) {
      const bool is_landmark = i == part.position && j == part.position;
      if (is_landmark || places.hessian[i][j] == nullptr) continue;
      visit(places.hessian[i][j], &own->hessian[i][j], part.sizes[i] * part.sizes[j]);
    }
  }
}

void LandmarkFit::Add(Hessian hessian, Equations* equations) const {
  equations->cost = 0.0;
  equations->gradient.setZero();
  equations->hessian.setZero();
  equations->others.assign(num_others_, 0.0);
  double* next = equations->others.data();
  for (const Part& part : parts_) {
    TermPlaces own;
    own.gradient[part.position] = equations->gradient.data();
    own.hessian[part.position][part.position] = equations->hessian.data();
    ForEachKept(part, &own, [&](double*, double** own_place, int size) {
      *own_place = next;
      next += size;
    });
    equations->cost += part.placed.term->Linearise(hessian, own);
  }
}

void LandmarkFit::AddToPlaces() const {
  const Part& any = parts_.front();
  Eigen::Map<Gradient>(any.placed.places.gradient[any.position]) += at_.gradient;
  Eigen::Map<Square>(any.placed.places.hessian[any.position][any.position]) += at_.hessian;
  const double* next = at_.others.data();
  for (const Part& part : parts_) {
    TermPlaces own;
    ForEachKept(part, &own, [&](double* place, double**, int size) {
      Eigen::Map<Eigen::VectorXd>(place, size) += Eigen::Map<const Eigen::VectorXd>(next, size);
      next += size;
    });
  }
}

void LandmarkFit::Evaluate(Hessian hessian, Equations* equations) const {
  Add(hessian, equations);
  Gradient step;
  if (hessian == Hessian::kNear &&
      !SolveForNegative(equations->hessian, equations->gradient, &step)) {
    Add(Hessian::kFar, equations);
  }
}

void LandmarkFit::Linearise(Hessian hessian) { Evaluate(hessian, &at_); }

bool LandmarkFit::Step(Hessian hessian, double tolerance, Equations* candidate) {
  const auto diagonal = damping_.Of<Gradient>(at_.hessian.diagonal());
  Square damped = at_.hessian;
  damped.diagonal() += diagonal;
  Gradient step;
  if (!SolveForNegative(damped, at_.gradient, &step)) {
    damping_.StepRefused();
    return !damping_.IsExhausted();
  }
  const double predicted = 0.5 * step.dot(diagonal.cwiseProduct(step) - at_.gradient);
  if (!(predicted > tolerance)) return false;
  std::array<double, kLandmarkSize> before;
  std::copy_n(landmark_->values, kLandmarkSize, before.begin());
  Move(VariableKind::kLandmark, step.data(), landmark_->values);
  Evaluate(hessian, candidate);
  if (candidate->cost < at_.cost) {
    damping_.StepTaken((at_.cost - candidate->cost) / predicted);
    std::swap(at_, *candidate);
    return true;
  }
  std::ranges::copy(before, landmark_->values);
  damping_.StepRefused();
  return !damping_.IsExhausted();
}

}  // namespace soslam
