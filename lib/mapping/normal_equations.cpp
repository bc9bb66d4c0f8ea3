// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/normal_equations.h"

namespace soslam {

NormalEquations::NormalEquations(const std::vector<Variable>& variables, const Terms& terms)
    : block_of_(Blocks(variables, terms)),
      hessian_(Pattern(variables, terms, block_of_)),
      gradient_(hessian_.NumRows()) {
  places_.reserve(terms.size());
  for (const Term* term : terms) places_.push_back(MakePlaces(*term));
}

std::vector<int> NormalEquations::Blocks(const std::vector<Variable>& variables,
                                         const Terms& terms) {
  std::vector<int> block_of(variables.size(), -1);
  for (const Term* term : terms) {
    for (const int variable : term->variables()) {
      const auto index = static_cast<size_t>(variable);
      if (!variables[index].is_held) block_of[index] = 0;
    }
  }
  int blocks = 0;
  for (int& block : block_of) {
    if (block == 0) block = blocks++;
  }
  return block_of;
}

SymmetricBlocks NormalEquations::Pattern(const std::vector<Variable>& variables, const Terms& terms,
                                         const std::vector<int>& block_of) {
  std::vector<int> sizes;
  for (size_t i = 0; i < variables.size(); ++i) {
    if (block_of[i] >= 0) sizes.push_back(NumTangents(variables[i].kind));
  }
  std::vector<std::array<int, 2>> couplings;
  for (const Term* term : terms) {
    const std::vector<int>& of_term = term->variables();
    for (size_t i = 0; i < of_term.size(); ++i) {
      for (size_t j = 0; j < i; ++j) {
        const int row = block_of[static_cast<size_t>(of_term[i])];
        const int column = block_of[static_cast<size_t>(of_term[j])];
        if (row >= 0 && column >= 0) couplings.push_back({row, column});
      }
    }
  }
  return SymmetricBlocks(std::move(sizes), std::move(couplings));
}

TermPlaces NormalEquations::MakePlaces(const Term& term) {
  TermPlaces places;
  for (size_t i = 0; i < term.variables().size(); ++i) {
    const int row = BlockOf(term.variables()[i]);
    if (row < 0) continue;
    places.gradient[i] = &gradient_[hessian_.FirstRow(row)];
    for (size_t j = 0; j <= i; ++j) {
      const int column = BlockOf(term.variables()[j]);
      if (column >= 0) places.hessian[i][j] = hessian_.Data(hessian_.Begin(row, column));
    }
  }
  return places;
}

void NormalEquations::SetZero() {
  hessian_.SetZero();
  gradient_.setZero();
}

double NormalEquations::Linearise(const Terms& terms, Hessian hessian) {
  SetZero();
  double cost = 0.0;
  for (size_t i = 0; i < terms.size(); ++i) cost += terms[i]->Linearise(hessian, places_[i]);
  return cost;
}

}  // namespace soslam
