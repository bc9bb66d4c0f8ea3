// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <memory>
#include <optional>

#include "constraints/tangency.h"
#include "geometry/landmark.h"
#include "geometry/plane.h"
#include "initialisation/landmark_cost.h"
#include "initialisation/ratio_rows.h"
#include "initialisation/semantic_table.h"

namespace soslam {

// Parameters of an object that stands upright on its support plane: yaw (rad, see UprightRotation),
// foot (projection of its centre onto the plane, along the ground's x and y, m), and logarithms of
// its half axes.
using UprightVector = Eigen::Matrix<double, 6, 1>;
using UprightJacobian = Eigen::Matrix<double, kLandmarkDof, 6>;  // d landmark / d UprightVector

// Ground frame of the upright objects on a support plane: frame_from_ground, with the frame of the
// plane.
struct UprightGround {
  explicit UprightGround(const Plane& plane);

  Landmark LandmarkAt(const UprightVector& parameters, double shape_exponent) const;
  // Parameters of a landmark that is upright on the plane; for any other, those of the nearest
  // upright landmark.
  UprightVector ParametersOf(const Landmark& landmark) const;
  UprightJacobian ByParameters(const Landmark& landmark) const;

  Eigen::Quaterniond rotation;  // UprightRotation(normal, 0)
  Eigen::Vector3d x, y, normal;
  Eigen::Vector3d origin;  // the plane's point nearest to its frame's origin
};

// A cost of few residuals, each with unit variance.
class LandmarkTerm : public LandmarkCost {
 public:
  static constexpr int kMaxResiduals = 4;
  using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, kLandmarkDof, 0, kMaxResiduals>;

  virtual int NumResiduals() const = 0;
  // `jacobian` (NumResiduals() x 9) may be null.
  virtual void Evaluate(const Landmark& landmark, Eigen::Ref<Eigen::VectorXd> residuals,
                        Jacobian* jacobian) const = 0;

  double Value(const Landmark& landmark) const final;
  void AddTo(const Landmark& landmark, LandmarkModel* sum) const final;
};

// Tangencies of the four edges of one detection, with the tangent points at the depths that they
// have on `start_in_camera`.
class BoxTerm final : public LandmarkTerm {
 public:
  BoxTerm(const std::array<BoxEdge, 4>& edges, const Landmark& start_in_camera);
  int NumResiduals() const override { return 4; }
  void Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override;

 private:
  std::array<BoxEdge, 4> edges_;
  std::array<TangentDepth, 4> depths_;
};

// Signed distances (OutlineExcess) by which the silhouette reaches outside the four edges of one
// detection. Not finite if the object is not wholly in front of the camera.
class OutlineTerm final : public LandmarkTerm {
 public:
  explicit OutlineTerm(const std::array<BoxEdge, 4>& edges) : edges_(edges) {}
  int NumResiduals() const override { return 4; }
  void Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override;

 private:
  std::array<BoxEdge, 4> edges_;
};

// The two residuals of RatioRows.
class RatioTerm final : public LandmarkTerm {
 public:
  explicit RatioTerm(const ShapePrior& prior) : rows_(prior) {}
  int NumResiduals() const override { return 2; }
  void Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override;

 private:
  RatioRows rows_;
};

// Residual of the logarithm of the height, 2 c, under the prior's height_m.
class HeightTerm final : public LandmarkTerm {
 public:
  explicit HeightTerm(const LogNormal& height_m) : height_m_(height_m) {}
  int NumResiduals() const override { return 1; }
  void Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override;

 private:
  LogNormal height_m_;
};

// Term in one camera for a landmark in another frame; each residual has a Huber loss (none if delta
// is infinite), and the cost is multiplied by a weight.
class RobustViewTerm final : public LandmarkTerm {
 public:
  RobustViewTerm(std::unique_ptr<const LandmarkTerm> term, const Rigid3d& camera_from_reference,
                 double huber_delta, double weight)
      : term_(std::move(term)),
        camera_from_reference_(camera_from_reference),
        huber_delta_(huber_delta),
        root_weight_(std::sqrt(weight)) {}
  int NumResiduals() const override { return term_->NumResiduals(); }
  void Evaluate(const Landmark& landmark_in_reference, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override;

 private:
  std::unique_ptr<const LandmarkTerm> term_;
  Rigid3d camera_from_reference_;
  double huber_delta_;
  double root_weight_;
};

// A horizontal axis of the world on a plane: x, or y where x is vertical.
Eigen::Vector3d WorldAxis(const Plane& plane_in_world);

// Weak prior of yaws along or across a horizontal axis of the world, as for furniture: cost
// `weight` sin^2(2 d), with d the angle between yaw and axis, so at most `weight`.
class AxisTerm final : public LandmarkTerm {
 public:
  AxisTerm(const Plane& plane_in_camera, const Eigen::Vector3d& axis_in_camera, double weight);
  int NumResiduals() const override { return 1; }
  void Evaluate(const Landmark& landmark_in_camera, Eigen::Ref<Eigen::VectorXd> residuals,
                Jacobian* jacobian) const override;

 private:
  Eigen::Vector3d normal_;
  double axis_yaw_;
  double amplitude_;
};

// Sum of the costs as a function of the upright parameters.
QuadraticModel<6> UprightModel(const LandmarkCosts& costs, const UprightGround& ground,
                               const Landmark& landmark);

// Levenberg-Marquardt over the parameters of an upright landmark; yaw fixed or free. Returns the
// landmark and its total cost; none if the cost is not finite at the start.
struct UprightSolution {
  Landmark landmark;
  double cost;
};
std::optional<UprightSolution> FitUpright(const Plane& plane, const Landmark& start,
                                          const LandmarkCosts& costs, bool yaw_is_free);

}  // namespace soslam
