// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "planes/camera_holding.h"

namespace soslam {

// What speaks against cameras being held in one way, as negative logarithms of likelihoods.
struct HoldingEvidence {
  CameraHolding holding = CameraHolding::kLevel;
  bool doubts_verticals = false;  // edges that were taken for vertical ones are others
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();
  // Of each object's boxes, upright bodies explaining them; none where there is no such body.
  std::vector<std::optional<double>> object_costs;
  double other_cost = 0.0;        // of planes, say
  double share_from_below = 0.0;  // of the boxes, whose camera is below what the object stands on
  bool can_be_chosen = true;      // otherwise it only makes the choice less clear
};

struct HoldingChoice {
  size_t best = 0;  // into the evidence
  // Of each: the whole cost over that of the best one, and how probable it is.
  std::vector<double> costs;
  std::vector<double> probabilities;
  // Of the chosen up direction, as others may be right (rad^2); zero where the choice is clear.
  double tilt_variance = 0.0;
};

// Within a few degrees, which boxes hardly tell apart: ways to hold cameras that lead to the same
// up are the same.
bool IsSameUp(const Eigen::Vector3d& one, const Eigen::Vector3d& other);

// A choice is clear when all that lead to another up are together less probable than this.
inline constexpr double kClearHolding = 0.01;

// The most probable of at least one that can be chosen; all have the same objects. One sequence in
// a hundred is taken to be held in any certain way other than level, or to have edges that are
// taken for vertical ones by mistake, one in a thousand to see all things from below their planes.
// Where objects cost more than `expected_cost` even in the best case, boxes say less than their
// noise promises: costs count in that proportion. No object alone decides, as its boxes may be of
// several.
HoldingChoice ChooseHolding(const std::vector<HoldingEvidence>& evidence, double expected_cost,
                            double clear = kClearHolding);

}  // namespace soslam
