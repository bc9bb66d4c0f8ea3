// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "soslam/initialisation/object_evidence.h"
#include "soslam/initialisation/upright.h"

namespace soslam {

// A landmark and its cost (EvaluateCost).
struct ObjectFit {
  Landmark landmark;
  EvidenceCost cost;
};

// The best landmark at each yaw of a grid over half a turn; none where there is no solution.
struct YawProfile {
  std::vector<double> yaw;  // rad, see Yaw
  std::vector<std::optional<ObjectFit>> fits;

  std::vector<double> Costs() const;  // NaN where there is no landmark
  double Step() const;                // rad
  // The landmarks at the lowest local minima, lowest first: at least six, as any may become the
  // best one when it is fitted.
  std::vector<Landmark> Minima(size_t count) const;

  // Standard deviation of the yaw (rad) about the first of the optima, with exp(-cost) as its
  // likelihood. Optima are refined: their yaws lie between those of the grid.
  struct Optimum {
    double yaw;
    double cost;
  };
  double StandardDeviation(const std::vector<Optimum>& optima) const;
};

// The yaw (rad) at which grids of yaws begin: that of the horizontal direction from which yaws are
// counted in the first view's camera. If the world is turned, grids turn along.
double FirstYaw(const ObjectEvidence& evidence);

// The profile in steps of about `step` (rad) from FirstYaw.
// Without further evidence and compared cost, landmarks are those of BodyAtYaw.
YawProfile ProfileOverYaw(const ObjectEvidence& evidence, double step);

// Rank of a cost: those that are equal in single precision are not told apart, as their order would
// be that of rounding errors.
inline float RankOfCost(double cost) { return static_cast<float>(1.0 + cost); }

// Indices of the local minima of a circular curve, lowest first; for a flat minimum its first
// index. NaN counts as infinite.
std::vector<size_t> CircularMinima(const std::vector<double>& values);

struct FitOptions {
  size_t max_hypotheses = 1;
  // The step (rad) of the profile that the starts are from: a compared cost decides their yaws on
  // ever finer grids about them. Zero: their yaws are those that fit best.
  double compared_step = 0.0;
};

// The hypotheses for an object: landmarks fitted to all of its evidence from each start, lowest
// RankOfCost first (if equal, the lower yaw), at most max_hypotheses; those that coincide are
// returned once. Bodies that may lean are then tilted (FitLeaning).
std::vector<ObjectFit> FitObject(const ObjectEvidence& evidence,
                                 const std::vector<Landmark>& starts, const FitOptions& options);

// The hypotheses from the minima of the profile, on each face that the object may rest on.
std::vector<ObjectFit> FitObject(const ObjectEvidence& evidence, double yaw_step,
                                 size_t max_hypotheses);

// The evidence for an object on each face that it may rest on.
std::vector<ObjectEvidence> OnEachFace(const ObjectEvidence& evidence);

// Joins the hypotheses of several faces as FitObject orders them.
std::vector<ObjectFit> MergeFits(std::vector<std::vector<ObjectFit>> on_faces,
                                 size_t max_hypotheses);

}  // namespace soslam
