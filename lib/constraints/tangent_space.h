// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "constraints/parameters.h"

namespace soslam {

// The kinds of variables that are estimated. A variable's values are its parameter block
// (parameters.h); its steps are tangent vectors:
//   pose      (rotation vector applied from the left, translation): 6
//   landmark  the same and the logarithms of the half axes, in the order of kLandmarkDof: 9
//   normal    along two axes at right angles to it: 2
//   offset    of a plane: 1
//   bias      of a detector's left, top, right and bottom edges: 4
enum class VariableKind { kPose, kLandmark, kNormal, kOffset, kBias };

inline constexpr int kPoseDof = 6;
inline constexpr int kNormalDof = 2;
inline constexpr int kBiasSize = 4;

int NumValues(VariableKind kind);
int NumTangents(VariableKind kind);

// Where a step leads.
void Move(VariableKind kind, const double* step, double* values);

// d values / d step at a step of zero, NumValues x NumTangents: chains Jacobians by a block's
// values to those by its steps.
using ValuesByStep = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                   kLandmarkSize, kLandmarkDof>;
ValuesByStep ByStep(VariableKind kind, const double* values);

// by_steps = by_values ByStep(kind, values), by_values with NumValues columns. But for rotations
// and normals, values are steps, and are copied.
using ByValues = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
void ChainToSteps(VariableKind kind, const double* values, const ByValues& by_values,
                  Eigen::MatrixXd* by_steps);

}  // namespace soslam
