// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <utility>
#include <vector>

namespace soslam {

// Where a term's derivatives are added, by the positions of its variables in Term::variables():
// null for what is held.
struct TermPlaces {
  static constexpr int kMaxVariables = 3;
  std::array<double*, kMaxVariables> gradient{};
  // [i][j] with j <= i: tangents of i by tangents of j, column-major. Of [i][i] the lower triangle
  // counts.
  std::array<std::array<double*, kMaxVariables>, kMaxVariables> hessian{};
};

// What of the second derivatives of a cost counts.
enum class Hessian {
  kInformation,  // J^T W J, W the weights that the losses give to the residuals
  kFar,          // and where a body turns past its edges and faces
  kNear,  // all, where residuals have them, and of losses: may be indefinite far from a minimum
};

// A part of the cost, a sum of squares under a loss, as a function of at most three variables. It
// reads their values where they are.
class Term {
 public:
  // `variables` index those of the problem, in ascending order.
  explicit Term(std::vector<int> variables) : variables_(std::move(variables)) {}
  virtual ~Term() = default;
  Term(const Term&) = delete;
  Term& operator=(const Term&) = delete;

  const std::vector<int>& variables() const { return variables_; }

  // Infinite where the term is not defined.
  virtual double Cost() const = 0;

  // Returns the cost and adds its gradient and what of its Hessian is asked for, by the variables'
  // steps (tangent_space.h); neither where the cost is infinite. Positive semidefinite but for
  // kNear.
  virtual double Linearise(Hessian hessian, const TermPlaces& places) const = 0;

 private:
  std::vector<int> variables_;
};

}  // namespace soslam
