// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "soslam/constraints/odometry.h"
#include "soslam/model/estimates.h"
#include "soslam/model/finding.h"
#include "soslam/model/semantic_table.h"
#include "soslam/model/sequence.h"
#include "soslam/planes/planes_estimate.h"

namespace soslam {

// Plausibility checks of results without ground truth.

// A finding if more than a third of the tries gave no landmark; those of moving objects are left
// out.
std::vector<Finding> CheckFailures(const LandmarkEstimates& estimates);

// Boxes without ids that the images share: each would be an object of its own. At least ten boxes
// in three images of a segment, where single images have no objects in common.
std::vector<Finding> CheckObjectIds(const Sequence& sequence);

// Labels of detections that are not in the semantic table, if they are a third of all or more, with
// the names of the table that they probably misspell.
std::vector<Finding> CheckLabels(const Sequence& sequence, const SemanticTable& table,
                                 const std::string& table_file);

// The heights of landmarks against those of their labels: one common factor, which indicates a
// wrong scale, or single objects that are a multiple. Labels of the table without a height are
// skipped.
std::vector<Finding> CheckSizes(const LandmarkEstimates& estimates, const Sequence& sequence,
                                const SemanticTable& table);

// Landmarks of objects that are flat or needle-shaped, as results from views that do not determine
// all axes. They do not show which of their axes is the height.
std::vector<Finding> CheckDegenerate(const LandmarkEstimates& estimates);
// Landmarks that shrank to a point.
std::vector<Finding> CheckCollapsed(const LandmarkEstimates& estimates);

// Another focal length or other planes that lower the cost more than chance does in one map of 1000
// where what is given is right: the most probable, and the others that are nearly as probable.
// Corrections that are too small to matter count as none, and so do those that leave the cost far
// above what noise gives.
std::vector<Finding> CheckInputs(const Sequence& sequence, const MapEstimate& map);

// Final cost of boxes whose edges have a standard deviation, against the cost expected by chance.
std::vector<Finding> CheckCost(const SolverSummary& solver);

// Motions between frames that differ more from the odometry than its noise allows: the squared
// corrections over their variances, summed over all steps, against the 99 % bound of chi-square.
// One pose per frame of the sequence.
std::vector<Finding> CheckPoseCorrections(const Sequence& sequence,
                                          const std::vector<Rigid3d>& world_from_camera,
                                          const OdometryNoise& noise);

// Estimated planes that are nearly as many as the objects on them.
std::vector<Finding> CheckPlaneCount(size_t planes, size_t objects);

inline constexpr const char* kUpDirectionCheck = "up_direction";

// The way in which cameras are held, and thus the up direction, if other ways are about as probable
// and leave up uncertain by `tilt_variance`.
std::vector<Finding> CheckUp(CameraOrientation orientation,
                             const std::vector<TriedOrientation>& orientations,
                             double tilt_variance);

// Why up may be wrong by more than its standard deviation, in words; empty where no finding says
// so.
std::string DoubtOfUp(const std::vector<Finding>& findings);

}  // namespace soslam
