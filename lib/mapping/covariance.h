// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "mapping/back_end_variables.h"
#include "mapping/normal_equations.h"
#include "model/estimates.h"

namespace soslam {

// Marginal covariances of the variables where they are: blocks of the inverse of the information
// J^T W J, from one sparse Cholesky factor of it. They hold in so far as the residuals' sigmas do.
class MarginalCovariances {
 public:
  // Evaluates and factors. The variables have to outlive it.
  MarginalCovariances(const BackEndVariables& variables, const Terms& terms);

  // Whether the terms determine all variables. If not, there are no covariances.
  bool AreDetermined() const { return inverse_.has_value(); }

  // Covariance of an object's landmark over (rotation vector in the world frame, rad; centre, m;
  // log half axes).
  Covariance9 OfLandmark(size_t object_index) const;
  // Whether there is one: something has to depend on the landmark.
  bool HasLandmark(size_t object_index) const {
    return AreDetermined() &&
           block_of_[static_cast<size_t>(variables_.Landmark(object_index))] >= 0;
  }

  // Covariance of a plane's variables over (normal, offset): its rank is 3, as the normal has unit
  // length; zero for fixed variables.
  Eigen::Matrix4d OfPlane(size_t plane_index) const;

 private:
  const BackEndVariables& variables_;
  std::vector<int> block_of_;  // by variable
  std::optional<SymmetricBlocks> inverse_;
};

}  // namespace soslam
