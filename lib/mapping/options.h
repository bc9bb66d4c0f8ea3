// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "base/options.h"
#include "constraints/variances.h"
#include "initialisation/semantic_table.h"
#include "symmetry/options.h"

namespace soslam {

struct OptimiseOptions {
  bool support = true;
  bool ratio = true;
  bool symmetry = false;
  RatioPrior ratio_prior = RatioPrior::kTable;
  // The paper's numbers read in metres, unlike in one frame: with dozens of boxes to a landmark,
  // what an ellipsoid cannot fit in them would outvote the one support and the one ratio
  // constraint.
  ConstraintVariances variances{.detection_dm4 = 1e5, .support_tangency_dm4 = 1e5};
  double odometry_rotation_sigma_deg = 0.2;
  double odometry_translation_sigma_m = 0.01;
  double symmetry_sigma = 30.0;
  double huber_delta = 1.0;
  SymmetryOptions symmetry_options;
  bool covariances = true;
  int max_iterations = 500;

  void Describe(OptionVisitor& visit) {
    visit.Flag("support", &support, "use the support constraint, eq. (5)-(8)");
    visit.Flag("ratio", &ratio, "use the scale ratio constraint, eq. (9)-(11)");
    visit.Flag("symmetry", &symmetry,
               "use the texture symmetry of each object's first observation, eq. (16)");
    visit.Choice("ratio_prior", &ratio_prior, kRatioPriorNames,
                 "where the size ratio of eq. (11) comes from");
    variances.Describe(visit);
    visit.Real("odometry_rotation_sigma_deg", &odometry_rotation_sigma_deg, {1e-9, 1e9},
               "standard deviation of the odometry between two frames");
    visit.Real("odometry_translation_sigma_m", &odometry_translation_sigma_m, {1e-9, 1e9},
               "standard deviation of the odometry between two frames, per axis");
    visit.Real("symmetry_sigma", &symmetry_sigma, {1e-9, 1e9},
               "standard deviation of a pair's descriptor difference, in the descriptor's unit");
    visit.Real("huber_delta", &huber_delta, {1e-9, 1e9},
               "weighted residuals beyond this count linearly (Huber loss H of eq. (1))");
    symmetry_options.Describe(visit);
    visit.Flag("covariances", &covariances, "compute the covariance of every landmark");
    visit.Integer("max_iterations", &max_iterations, {1, 10000}, "Levenberg-Marquardt iterations");
  }
};

}  // namespace soslam
