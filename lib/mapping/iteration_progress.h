// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/iteration_callback.h>

#include "base/progress.h"

namespace soslam {

// Shows how many iterations a solver has made.
class IterationProgress : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    progress_.Step();
    return ceres::SOLVER_CONTINUE;
  }

 private:
  Progress progress_{"iterations", Progress::kUnknownCount};
};

}  // namespace soslam
