// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/problem.h>

#include <Eigen/SparseCore>
#include <set>
#include <vector>

namespace soslam {

// The blocks of a problem that are not constant, in its order.
std::vector<double*> VariableBlocks(const ceres::Problem& problem);

// Normal equations of the problem linearised at its present values, by the tangents of blocks.
struct NormalEquations {
  Eigen::SparseMatrix<double> matrix;  // J^T J, under the weights of the losses
  Eigen::VectorXd gradient;            // of the cost
};

// The curvature rows of TangencyResidual are for solvers: without them, the matrix is the
// information of the residuals.
enum class CurvatureRows { kWith, kWithout };

// The normal equations of blocks that are not constant; of no size where they are not defined.
NormalEquations MakeNormalEquations(const std::vector<double*>& blocks, CurvatureRows curvature,
                                    ceres::Problem* problem);

// Rao's score test of blocks that are constant: the linearised problem predicts by how much the
// cost would fall if they were free, and where to. What is variable moves with them.
class ScoreTest {
 public:
  // Linearises the problem at its present values, and eliminates what is variable. The problem must
  // be defined there, and outlive this object.
  ScoreTest(std::set<double*> constant_blocks, ceres::Problem* problem);

  // The decrease of the cost if these of the blocks were free, beyond that which needs none of
  // them. Moves these blocks to their minimum, and nothing else.
  double Step(const std::set<double*>& blocks) const;

 private:
  std::set<double*> blocks_;
  ceres::Problem* problem_;
  Eigen::MatrixXd information_;  // by the tangents of blocks
  Eigen::VectorXd gradient_;
};

}  // namespace soslam
