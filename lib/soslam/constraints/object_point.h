// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "soslam/base/options.h"

namespace soslam {

// Sparse point that may be on the surface of an object.
struct ObjectPoint {
  Eigen::Vector3d position;                              // in the camera that the landmark is in
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2
  double prior = 0.5;  // probability that it is of the object, whatever its distance from it
  int index = 0;       // in the list of all points
};

// Sparse points as evidence for objects.
struct PointOptions {
  bool point_evidence = false;
  double point_sigma_fraction = 0.03;
  double point_roughness_fraction = 0.3;
  double point_range_fraction = 0.02;
  double point_outlier_probability = 0.1;
  double effective_points = 6.0;

  void Describe(OptionVisitor& visit) {
    visit.Group("Points");
    visit.Flag(
        "point_evidence", &point_evidence,
        "use sparse points, which lie on the surfaces of objects, or behind or in front of them");
    visit.OnlyWhere({{"point_evidence", {"true"}}}, [&] {
      visit.Real("point_sigma_fraction", &point_sigma_fraction, {1e-4, 1.0},
                 "standard deviation of a point's distance from the surface, as a fraction of the "
                 "object's size (twice the cubic root of its half axes' product)");
      visit.Real("point_roughness_fraction", &point_roughness_fraction, {1e-4, 10.0},
                 "the same for points of parts that lie inside the label's shape, as a chair's");
      visit.Real("point_range_fraction", &point_range_fraction, {0.0, 1.0},
                 "standard deviation of a point's position because of the drift of poses, as a "
                 "fraction of its distance from the camera");
      visit.Real(
          "point_outlier_probability", &point_outlier_probability, {1e-6, 1.0},
          "probability that a point behind or in front of the object was triangulated to lie "
          "inside it");
      visit.Real(
          "effective_points", &effective_points, {1e-3, 1e6},
          "independent points of an object: all of its points have the weight of at most this "
          "many, as their errors are correlated");
    });
  }
};

}  // namespace soslam
