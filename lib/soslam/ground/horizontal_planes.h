// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "soslam/model/map_points.h"
#include "soslam/model/sequence.h"
#include "soslam/planes/up_prior.h"

namespace soslam {

// Sparse point with its uncertainty.
struct GroundPoint {
  Eigen::Vector3d position_in_world;
  Eigen::Matrix3d covariance;      // from its reprojection error and the cameras that observe it
  std::vector<int> frame_indices;  // of the frames that observe it
};

// Points that at least two frames of the sequence observe, in front of their cameras.
std::vector<GroundPoint> GroundPoints(const Sequence& sequence,
                                      const std::vector<MapPoint>& points);

// One of several parallel planes, up . x = height.
struct PlaneOfPoints {
  double height = 0.0;
  std::vector<Eigen::Vector3d> points_in_world;
  Eigen::Vector3d centre_in_world = Eigen::Vector3d::Zero();  // mean of the points
  // Covariance of turns (rad) about the x and y axes of UprightRotation(up, 0) through the centre,
  // and of a rise along up.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

// Horizontal planes in sparse points and the up direction that they share.
struct HorizontalPlanes {
  Eigen::Vector3d up_in_world = Eigen::Vector3d::UnitZ();
  Eigen::Matrix2d tilt_covariance = Eigen::Matrix2d::Zero();  // of the two turns above (rad^2)
  // Part of it: the spread over other directions that are nearly as likely.
  Eigen::Matrix2d ambiguity = Eigen::Matrix2d::Zero();
  std::vector<PlaneOfPoints> planes;  // ascending heights
  double gain = 0.0;  // log likelihood ratio against points on no plane and up of the prior
};

// Weight of a direction with this gain beside the best one. Points are not independent, so that
// gains count as shares of the best one: a tenth less makes a direction e times less probable.
double WeightOfGain(double gain, double best_gain);

// Adds a variance of up (rad^2).
void AddAmbiguity(double variance, HorizontalPlanes* planes);

// Finds the up direction, among those that the up prior of the cameras allows, in which points lie
// most probably on few planes: heights of points are normally distributed about those of planes, or
// uniformly. The unit of length is the typical distance of the points from the cameras. Without
// planes, up is that of the up prior.
HorizontalPlanes FindHorizontalPlanes(const std::vector<GroundPoint>& points,
                                      const UpPrior& up_prior);

// The up direction and the heights from the points of these planes only. The covariances include
// the scatter over sectors of the planes, which shows planes that are not even or not parallel.
HorizontalPlanes Refined(const HorizontalPlanes& planes, const std::vector<GroundPoint>& points,
                         const UpPrior& up_prior);

}  // namespace soslam
