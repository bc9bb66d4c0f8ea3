// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "constraints/leaning_on_plane.h"
#include "initialisation/landmark_terms.h"
#include "initialisation/upright.h"

namespace soslam {

// The residuals of LeaningOnPlane on a constant plane.
class LeaningTerm final : public LandmarkTerm {
 public:
  explicit LeaningTerm(const Plane& plane) : plane_(plane) {}
  int NumResiduals() const override { return 3; }
  void Evaluate(const Landmark& landmark, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override;

 private:
  Plane plane_;
};

// Levenberg-Marquardt over all nine parameters of a body that leans on a plane, from an upright
// landmark and from that landmark tilted to four sides. `costs` hold a LeaningTerm. Returns the
// landmark of lowest cost; none if that cost is not finite.
std::optional<UprightSolution> FitLeaning(const Plane& plane, const Landmark& upright,
                                          const LandmarkCosts& costs);

}  // namespace soslam
