// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mapping/back_end_variables.h"
#include "mapping/symmetric_blocks.h"
#include "mapping/term.h"

namespace soslam {

using Terms = std::vector<const Term*>;

// Gradient and Hessian of the sum of all terms by a step of all variables that are not held and
// that a term depends on.
class NormalEquations {
 public:
  NormalEquations(const std::vector<Variable>& variables, const Terms& terms);

  void SetZero();
  // At the variables' values; `terms` are those that it was made for. Returns the cost, infinite
  // where a term is not defined.
  double Linearise(const Terms& terms, Hessian hessian);
  // Where a term adds its derivatives, by its index among the terms.
  const TermPlaces& PlacesOf(size_t term) const { return places_[term]; }

  const SymmetricBlocks& hessian() const { return hessian_; }
  const Eigen::VectorXd& gradient() const { return gradient_; }

  // Block index of a variable; -1 if it is fixed or no term depends on it.
  int BlockOf(int variable) const { return block_of_[static_cast<size_t>(variable)]; }

 private:
  static std::vector<int> Blocks(const std::vector<Variable>& variables, const Terms& terms);
  static SymmetricBlocks Pattern(const std::vector<Variable>& variables, const Terms& terms,
                                 const std::vector<int>& block_of);
  TermPlaces MakePlaces(const Term& term);

  std::vector<int> block_of_;  // by variable
  SymmetricBlocks hessian_;
  Eigen::VectorXd gradient_;
  std::vector<TermPlaces> places_;  // by term
};

}  // namespace soslam
