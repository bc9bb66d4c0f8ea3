// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/landmark_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace soslam {

void Damping::StepTaken(double gain) {
  constexpr double kLeast = 1e-12;
  value_ = std::max(kLeast, value_ * std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * gain - 1.0, 3)));
  growth_ = 2.0;
}

void Damping::StepRefused() {
  value_ *= growth_;
  growth_ *= 2.0;
}

LandmarkFit::LandmarkFit(Variable* landmark, int index, std::vector<const Term*> terms)
    : landmark_(landmark), terms_(std::move(terms)) {
  for (const Term* term : terms_) {
    const auto& variables = term->variables();
    positions_.push_back(
        static_cast<size_t>(std::ranges::find(variables, index) - variables.begin()));
  }
}

void LandmarkFit::Add(Hessian hessian, Equations* equations) const {
  equations->kind = hessian;
  equations->cost = 0.0;
  equations->gradient.setZero();
  equations->hessian.setZero();
  for (size_t i = 0; i < terms_.size(); ++i) {
    TermPlaces places;
    places.gradient[positions_[i]] = equations->gradient.data();
    places.hessian[positions_[i]][positions_[i]] = equations->hessian.data();
    equations->cost += terms_[i]->Linearise(hessian, places);
  }
}

void LandmarkFit::Evaluate(Hessian hessian, Equations* equations) const {
  Add(hessian, equations);
  if (hessian == Hessian::kNear && equations->hessian.llt().info() != Eigen::Success) {
    Add(Hessian::kFar, equations);
  }
}

double LandmarkFit::Linearise(Hessian hessian) {
  Evaluate(hessian, &at_);
  return at_.cost;
}

bool LandmarkFit::Step(Hessian hessian, double tolerance) {
  const auto diagonal = damping_.Of<Eigen::Matrix<double, kLandmarkDof, 1>>(at_.hessian.diagonal());
  Eigen::Matrix<double, kLandmarkDof, kLandmarkDof> damped = at_.hessian;
  damped.diagonal() += diagonal;
  const Eigen::LLT<Eigen::Matrix<double, kLandmarkDof, kLandmarkDof>> factor(damped);
  if (factor.info() != Eigen::Success) {
    damping_.StepRefused();
    return !damping_.IsExhausted();
  }
  const Eigen::Matrix<double, kLandmarkDof, 1> step = -factor.solve(at_.gradient);
  const double predicted = 0.5 * step.dot(diagonal.cwiseProduct(step) - at_.gradient);
  if (!(predicted > tolerance)) return false;
  std::array<double, kLandmarkSize> before;
  std::copy_n(landmark_->values, kLandmarkSize, before.begin());
  Move(VariableKind::kLandmark, step.data(), landmark_->values);
  Evaluate(hessian, &candidate_);
  if (candidate_.cost < at_.cost) {
    damping_.StepTaken((at_.cost - candidate_.cost) / predicted);
    std::swap(at_, candidate_);
    return true;
  }
  std::ranges::copy(before, landmark_->values);
  damping_.StepRefused();
  return !damping_.IsExhausted();
}

}  // namespace soslam
