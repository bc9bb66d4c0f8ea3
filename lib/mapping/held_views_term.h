// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "base/wide_loops.h"
#include "constraints/huber.h"
#include "geometry/rigid3.h"
#include "mapping/tangent_box.h"
#include "mapping/term.h"

namespace soslam {

// A detection's box from a pose that is held.
struct HeldView {
  Rigid3d world_from_camera;
  TangentBox box;
  double weight;
};

// The sum of one landmark's TangencyTerms where all poses are held and the detector has no bias,
// four views side by side in wide registers. Variable: the landmark.
class HeldViewsTerm final : public Term {
 public:
  // `variable` is the landmark's index. One view or more, all of the landmark's shape exponent.
  HeldViewsTerm(int variable, const double* landmark_in_world, const std::vector<HeldView>& views,
                double huber_delta);

  double Cost() const override { return Linearise(Hessian::kInformation, {}); }
  double Linearise(Hessian hessian, const TermPlaces& places) const override;

  // In the world. Views that there are not look from where the last one does.
  struct alignas(kFourAlignment) FourViews {
    ThreeFours camera;
    ThreeFours optical_axis;
    Four least_depth_m;
    std::array<FourEdges, 4> sides;
  };

 private:
  const double* landmark_in_world_;
  double shape_exponent_;
  HuberLoss loss_;
  std::vector<FourViews> views_;
};

}  // namespace soslam
