// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "soslam/base/options.h"
#include "soslam/constraints/landmark_terms.h"
#include "soslam/initialisation/upright_options.h"
#include "soslam/model/sequence.h"
#include "soslam/model/shape_prior.h"

namespace soslam {

enum class YawPriorSource {
  kNone,
  kMotion,       // the object's other detections shortly before and after
  kGroundTruth,  // for ablations: separates errors of yaw from all others
};
inline constexpr std::array kYawPriorSourceNames = {"none", "motion", "groundtruth"};

struct YawPriorOptions {
  YawPriorSource source = YawPriorSource::kNone;
  int motion_frames = 5;
  double motion_min_m = 2.0;
  double motion_foot_sigma_m = 0.3;
  double standing_sigma_deg = 5.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Prior of the yaw");
    visit.Choice("yaw_prior", &source, kYawPriorSourceNames,
                 "prior of the yaw beside the box: none; from the object's boxes in the frames "
                 "before and after, along its motion or, if it stands, the yaw that fits all of "
                 "them (motion); or, for ablations, the truth");
    visit.OnlyWhere({{"yaw_prior", {"motion"}}}, [&] {
      visit.Integer("motion_frames", &motion_frames, {1, 100000},
                    "how many frames before and as many after");
      visit.Real("motion_min_m", &motion_min_m, {0.0, 1e6},
                 "objects that move less over these frames count as standing");
      visit.Real(
          "motion_foot_sigma_m", &motion_foot_sigma_m, {1e-6, 1e6},
          "standard deviation, across the motion, of how far the middle of a box's lower edge "
          "seems to move on the support plane");
      visit.Real("standing_sigma_deg", &standing_sigma_deg, {1e-3, 180.0},
                 "standard deviation of the yaw of what stands");
    });
  }
};

// Yaw of a detection's object in the camera frame, from ground truth; none without ground truth.
std::optional<double> TrueYaw(const Sequence& sequence, const Detection& detection);

// Prior of each detection, with the frames' estimated poses; none if the source has no information.
// kMotion: the direction of the straight line through the feet of the object, where the rays
// through the centres of its boxes' lower edges meet their support planes; if the motion is shorter
// than motion_min_m, the yaw that fits its boxes best (ProfileOverYaw).
std::vector<std::optional<YawPrior>> YawPriors(const Sequence& sequence,
                                               const std::vector<std::optional<ShapePrior>>& shapes,
                                               const YawPriorOptions& options,
                                               const UprightOptions& upright, int threads);

}  // namespace soslam
