// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/minimise.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>
#include <optional>

#include "base/error.h"
#include "base/parallel.h"
#include "base/progress.h"
#include "mapping/block_cholesky.h"
#include "mapping/landmark_fit.h"

namespace soslam {
namespace {

// Fraction of the least gain: steps with a smaller predicted decrease are not tried.
constexpr double kHopeless = 1e-2;
// Costs of residuals that are all but zero.
constexpr double kNoCost = 1e-18;
// Inner iterations: steps of each landmark alone, after a step of all variables. Steps that lower
// the cost by `kLandmarkGain`, relative to the mean cost per landmark, are always taken, those
// below `kLeastLandmarkGain` never; in between see StepsOfLandmarks.
constexpr int kLandmarkSteps = 20;
constexpr double kLandmarkGain = 3e-4;
constexpr double kLeastLandmarkGain = 1e-8;
// Where a step is expected to lower the cost by less than this share, the minimum is near.
constexpr double kNear = 1e-2;
// Where nothing but landmarks varies, of the share by which the last step has lowered it: each goes
// back to kFar by itself where kNear leads nowhere, and is spared the steps that halve what is
// left.
constexpr double kNearForLandmarks = 0.3;
// Damping of steps of all variables. The inner iterations settle the landmarks; what remains is the
// low-frequency drift of the trajectory, which needs many steps to converge if the damping falls
// slowly.
constexpr double kFirstDamping = 1e-4;
constexpr double kDampingFall = 1e-2;
constexpr double kLeastDamping = 1e-12;

class Minimiser {
 public:
  Minimiser(const Terms& terms, const MinimiseOptions& options, std::vector<Variable>* variables)
      : variables_(variables), options_(options) {
    const auto varies = [&](int index, bool is_landmark) {
      const Variable& variable = (*variables)[static_cast<size_t>(index)];
      return !variable.is_held && (variable.kind == VariableKind::kLandmark) == is_landmark;
    };
    for (const Term* term : terms) {
      others_vary_ |=
          std::ranges::any_of(term->variables(), [&](int index) { return varies(index, false); });
    }
    if (others_vary_) {
      equations_.emplace(*variables, terms);
      factor_.emplace(equations_->hessian());
    }
    std::vector<std::vector<PlacedTerm>> of_landmark(variables->size());
    for (size_t i = 0; i < terms.size(); ++i) {
      const PlacedTerm placed{terms[i], others_vary_ ? equations_->PlacesOf(i) : TermPlaces()};
      const auto landmark = std::ranges::find_if(terms[i]->variables(),
                                                 [&](int index) { return varies(index, true); });
      if (landmark == terms[i]->variables().end()) {
        without_landmark_.push_back(placed);
      } else {
        of_landmark[static_cast<size_t>(*landmark)].push_back(placed);
      }
    }
    for (size_t i = 0; i < of_landmark.size(); ++i) {
      if (!of_landmark[i].empty())
        fits_.emplace_back(variables, static_cast<int>(i), of_landmark[i]);
    }
  }

  Minimisation Run() {
    Minimisation result;
    LineariseFits();
    cost_ = Cost();
    if (!std::isfinite(cost_)) {
      throw NumericalError("back end: the cost is not finite at the start");
    }
    result.costs.push_back(cost_);
    Progress progress("iterations", Progress::kUnknownCount);
    while (!result.converged && static_cast<int>(result.costs.size()) <= options_.max_iterations) {
      result.converged = !(others_vary_ ? StepOfAll() : StepOfEachLandmark());
      result.costs.push_back(cost_);
      progress.Step();
    }
    return result;
  }

 private:
  double Tolerance() const { return kHopeless * options_.least_gain * cost_ + kNoCost; }

  // Fits change nothing that others read. The equations are for steps to be tried in.
  using WorkOnFit = std::function<void(LandmarkFit&, LandmarkFit::Equations*)>;
  void ForEachFit(const WorkOnFit& work) {
    constexpr int kShares = 16;  // per thread, as some landmarks take longer than others
    const auto fits = static_cast<int>(fits_.size());
    const int shares = options_.threads > 1 ? std::min(fits, kShares * options_.threads) : 1;
    ParallelFor(shares, options_.threads, [&](int share) {
      LandmarkFit::Equations candidate;
      for (int i = share; i < fits; i += shares) work(fits_[static_cast<size_t>(i)], &candidate);
    });
  }
  void LineariseFits() {
    ForEachFit([&](LandmarkFit& fit, auto*) { fit.Linearise(hessian_); });
  }
  // Cost of all terms; of those of landmarks, at the last linearisation of the fits.
  double Cost() const { return CostOfFits() + CostOfOthers(); }
  double CostOfFits() const {
    double cost = 0.0;
    for (const LandmarkFit& fit : fits_) cost += fit.cost();
    return cost;
  }
  double CostOfOthers() const {
    double cost = 0.0;
    for (const PlacedTerm& placed : without_landmark_) cost += placed.term->Cost();
    return cost;
  }

  // Whether any of them moves or may do so.
  bool StepOfEachLandmark() {
    const double tolerance = Tolerance() / NumLandmarks();
    std::atomic<bool> moves = false;
    ForEachFit([&](LandmarkFit& fit, auto* candidate) {
      if (fit.Step(hessian_, tolerance, candidate)) moves = true;
    });
    const double before = cost_;
    cost_ = Cost();
    hessian_ = before - cost_ < kNearForLandmarks * before ? Hessian::kNear : Hessian::kFar;
    return moves;
  }
  double NumLandmarks() const { return static_cast<double>(std::max<size_t>(1, fits_.size())); }

  void SetUpEquations() {
    equations_->SetZero();
    for (const LandmarkFit& fit : fits_) fit.AddToPlaces();
    for (const PlacedTerm& placed : without_landmark_) {
      placed.term->Linearise(hessian_, placed.places);
    }
  }
  void LineariseFar() {
    hessian_ = Hessian::kFar;
    LineariseFits();
    SetUpEquations();
  }
  bool Factor() {
    damping_diagonal_ = damping_.Of(equations_->hessian().Diagonal());
    return factor_->Factor(equations_->hessian(), damping_diagonal_);
  }

  bool StepOfAll() {
    if (!are_set_up_) SetUpEquations();
    are_set_up_ = true;
    bool is_factored = Factor();
    if (!is_factored && hessian_ == Hessian::kNear) {
      LineariseFar();
      is_factored = Factor();
    }
    if (!is_factored) return RefuseStep();
    const Eigen::VectorXd step = -factor_->Solve(equations_->gradient());
    const double predicted =
        0.5 * step.dot(damping_diagonal_.cwiseProduct(step) - equations_->gradient());
    if (!(predicted > Tolerance())) return false;

    const double before = cost_;
    const Hessian of_step = hessian_;
    const std::vector<double> values = Values();
    MoveAll(step);
    // Where the step leads to, the next one begins.
    hessian_ = predicted < kNear * before ? Hessian::kNear : Hessian::kFar;
    LineariseFits();
    const double cost_of_others = CostOfOthers();
    cost_ = CostOfFits() + cost_of_others;
    StepsOfLandmarks(before, predicted);
    cost_ = CostOfFits() + cost_of_others;
    const double gain = before - cost_;  // with what landmarks brought
    if (gain > 0.0) {
      are_set_up_ = false;
      damping_.StepTaken(gain / predicted);
      return gain > options_.least_gain * before;
    }
    Restore(values);
    cost_ = before;
    // The equations of a far step are still those of where the variables are again.
    hessian_ = Hessian::kFar;
    if (of_step == Hessian::kNear) LineariseFar();
    return RefuseStep();
  }

  // A few of many landmarks move slowly along a flat valley, and would require a step of all
  // variables for each of their own steps. So each landmark continues alone as long as its steps
  // are predicted to bring 1 / (number of landmarks) of the mean decrease per landmark predicted
  // for the step of all variables.
  void StepsOfLandmarks(double cost_before, double predicted) {
    const double mean_cost = cost_before / NumLandmarks();
    const double mean_share = predicted / NumLandmarks() / NumLandmarks();
    const double worth_it =
        std::min(kLandmarkGain * std::min(mean_cost, cost_ / NumLandmarks()), mean_share);
    const double tolerance = std::max(kLeastLandmarkGain * mean_cost, worth_it);
    ForEachFit([&](LandmarkFit& fit, auto* candidate) {
      for (int i = 0; i < kLandmarkSteps && fit.Step(hessian_, tolerance, candidate); ++i) {
      }
    });
  }

  // Whether another one may be taken.
  bool RefuseStep() {
    damping_.StepRefused();
    return !damping_.IsExhausted();
  }

  std::vector<double> Values() const {
    std::vector<double> values;
    for (const Variable& variable : *variables_) {
      values.insert(values.end(), variable.values, variable.values + NumValues(variable.kind));
    }
    return values;
  }
  void Restore(const std::vector<double>& values) {
    auto next = values.begin();
    for (Variable& variable : *variables_) {
      std::copy_n(next, NumValues(variable.kind), variable.values);
      next += NumValues(variable.kind);
    }
  }
  void MoveAll(const Eigen::VectorXd& step) {
    for (size_t i = 0; i < variables_->size(); ++i) {
      const int block = equations_->BlockOf(static_cast<int>(i));
      if (block < 0) continue;
      Variable& variable = (*variables_)[i];
      Move(variable.kind, &step[equations_->hessian().FirstRow(block)], variable.values);
    }
  }

  std::vector<Variable>* variables_;
  MinimiseOptions options_;
  bool others_vary_ = false;  // than landmarks
  std::vector<LandmarkFit> fits_;
  std::vector<PlacedTerm> without_landmark_;
  std::optional<NormalEquations> equations_;
  std::optional<BlockCholesky> factor_;
  Damping damping_{kFirstDamping, kLeastDamping, kDampingFall};
  bool are_set_up_ = false;  // the equations, where the variables are
  Hessian hessian_ = Hessian::kFar;
  Eigen::VectorXd damping_diagonal_;
  double cost_ = 0.0;
};

}  // namespace

Minimisation Minimise(const Terms& terms, const MinimiseOptions& options,
                      std::vector<Variable>* variables) {
  return Minimiser(terms, options, variables).Run();
}

}  // namespace soslam
