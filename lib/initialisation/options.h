// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "base/options.h"
#include "constraints/variances.h"
#include "initialisation/semantic_table.h"

namespace soslam {

enum class InitialisationMethod {
  kSingleFrame,  // section IV: one landmark per observation
  kSvd,          // QuadricSLAM: one landmark per object from all of its observations
};
inline constexpr std::array kInitialisationMethodNames = {"single_frame", "svd"};

struct InitialiseOptions {
  InitialisationMethod method = InitialisationMethod::kSingleFrame;
  RatioPrior ratio_prior = RatioPrior::kTable;
  ConstraintVariances variances;
  int yaw_starts = 12;
  int max_iterations = 100;
  double tie_edge_px = 1.0;

  void Describe(OptionVisitor& visit) {
    visit.Choice("method", &method, kInitialisationMethodNames,
                 "one landmark per observation (section IV), or per object by SVD over all");
    visit.Choice("ratio_prior", &ratio_prior, kRatioPriorNames,
                 "where the size ratio of eq. (11) comes from");
    variances.Describe(visit);
    visit.Integer("yaw_starts", &yaw_starts, {1, 360},
                  "starting yaws over half a turn of the single-frame solve, eq. (12)");
    visit.Integer("max_iterations", &max_iterations, {1, 10000},
                  "Levenberg-Marquardt iterations per start");
    visit.Real("tie_edge_px", &tie_edge_px, {0.0, 1000.0},
               "solutions whose outline fits the box to this rms edge distance explain it equally "
               "well; among them the one whose front faces the camera most is chosen");
  }
};

}  // namespace soslam
