// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "soslam/constraints/landmark_cost.h"
#include "soslam/constraints/object_point.h"
#include "soslam/model/estimates.h"

namespace soslam {

// Size (m) of an object for the widths of PointCost: twice the cubic root of its half axes'
// product.
double SizeForPoints(const Landmark& landmark);
// One size for all landmarks of an object (at least one), as costs with different sizes cannot be
// compared: their median.
double SizeForPoints(const std::vector<Landmark>& landmarks);

// Points as evidence for landmarks in one camera, all with the widths of one size.
struct PointEvidence {
  std::vector<ObjectPoint> points;
  double size_m;
  double weight;
  PointOptions options;
};

// Negative log likelihood of points, each of which is either on the surface of the object, or
// behind or in front of it, where nothing is known of its distance d. The density of d (positive
// outside, SurfaceDistance) is a mixture with fixed widths:
//
//   outside: p S N(d / s) + (1 - p) B
//   inside:  p S [(1 - r) N(d / s) + r N(d / t)] + (1 - p) B [(1 - e) N(d / s) + e]
//
// with N(x) = exp(-x^2 / 2); p the point's prior; s its own standard deviation along the surface's
// normal combined with that of the surface, t with the roughness; S such that the first term is a
// density; B one over the size; e the outlier probability. A body is opaque: only outliers of the
// background are inside. A constant of each point, which depends on the size but not on the
// landmark, makes the cost zero for a point on the surface with the smallest standard deviation of
// any normal, and positive otherwise: costs with one size can be compared. Second derivatives are
// those of expectation maximisation: each point pulls with its posterior probability.
class PointCost final : public LandmarkCost {
 public:
  enum class SecondDerivatives {
    kMaximisation,
    kFisherInformation,  // of the points, as covariances need
  };

  // Widths are those of an object of this size along the normals of `start_in_camera`; the cost is
  // multiplied by `weight`.
  PointCost(const std::vector<ObjectPoint>& points, const Landmark& start_in_camera, double size_m,
            const PointOptions& options, double weight,
            SecondDerivatives second_derivatives = SecondDerivatives::kMaximisation);

  double Value(const Landmark& landmark_in_camera) const override;
  void AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const override;
  bool ConvergesSlowly() const override { return true; }

  // In the order of the points.
  std::vector<PointPosterior> Posteriors(const Landmark& landmark_in_camera) const;

 private:
  struct Density {
    Eigen::Vector3d position;
    int index;  // of the point
    double sigma_m;
    double rough_sigma_m;
    double surface;     // p S
    double background;  // (1 - p) B
    double highest;     // no density is higher
  };
  // Terms of the density at one distance.
  struct Mixture {
    double sharp;      // within s, of the object and of the background
    double rough;      // within t, of the object
    double constant;   // of the background
    double of_object;  // part of sharp and rough

    double Sum() const { return sharp + rough + constant; }
    double Responsibility() const { return of_object / Sum(); }
  };
  Mixture MixtureAt(const Density& density, double distance) const;
  // Negative logarithm of the density at a distance, relative to the highest, and the factor w of
  // its derivative w d.
  std::pair<double, double> CostAndWeight(const Density& density, double distance) const;
  // Fisher information (1 / m^2) of a point's distance, shared out by responsibility: its mean over
  // all distances is that of a point, and points far away have none. That of expectation
  // maximisation is larger, as it takes for known which points are of the object.
  double FisherInformation(const Density& density, double distance) const;

  std::vector<Density> densities_;
  double outlier_probability_;
  double weight_;
  SecondDerivatives second_derivatives_;
};

}  // namespace soslam
