// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "soslam/constraints/image_options.h"
#include "soslam/constraints/parameters.h"
#include "soslam/geometry/box.h"
#include "soslam/geometry/camera.h"
#include "soslam/geometry/mirror_mapping.h"
#include "soslam/image/binary_descriptor.h"
#include "soslam/image/edge_maps.h"

namespace soslam {

// Image data that the descriptors of one observation look up.
struct SymmetryImage {
  // Takes the maps of the whole frame, and the box of the observation.
  SymmetryImage(EdgeMaps edge_maps, const Box& own_box);

  Box box;
  EdgeMaps maps;
  BinaryDescriptors<&SmoothForBrief, &BriefDescriptor> brief;
  BinaryDescriptors<&SmoothForFreak, &FreakDescriptor> freak;
  std::vector<Eigen::Vector2d> edge_pixels;  // in the box, row by row
};

// One descriptor of one image on the surface of one landmark.
class SymmetryDescriptor {
 public:
  struct Pair {
    double residual = 0.0;         // beta(u) - beta(u^S) of eq. (16), in the descriptor's unit
    Eigen::Vector2d mirror_pixel;  // u^S of eq. (14)
    LandmarkJacobian1 jacobian;    // of the residual, only when asked for; nearest edges are fixed
  };

  SymmetryDescriptor(Descriptor descriptor, const SymmetryImage& image, const Camera& camera,
                     const Landmark& landmark_in_camera);

  // The pair of a pixel. None when the pixel's ray misses the surface, the mirror pixel is behind
  // the camera or outside the image, or a nearest edge is not on the surface; with
  // `min_viewing_cosine`, also when the camera sees one of the two surface points at a smaller
  // viewing cosine (or not at all). The mirror plane may be offset from the xz plane, see
  // VisibleSurface::MirrorImage; visibility is then checked without the offset.
  std::optional<Pair> Evaluate(const Eigen::Vector2d& pixel,
                               std::optional<double> min_viewing_cosine, bool with_jacobian,
                               double mirror_plane = 0.0) const;

  // The first half of Evaluate, which is the same for all descriptors: the intersection of the
  // pixel's ray with the surface.
  std::optional<VisibleSurface::Point> VisiblePoint(const Eigen::Vector2d& pixel,
                                                    std::optional<double> min_viewing_cosine) const;
  // The second half, at the VisiblePoint of the same pixel on the same landmark.
  std::optional<Pair> EvaluateAt(const Eigen::Vector2d& pixel, const VisibleSurface::Point& point,
                                 bool with_jacobian, double mirror_plane = 0.0) const;

  // Fills in the residuals of Evaluate, one for each mirror plane; NaN if there is no pair. False
  // when the pixel's ray misses the surface.
  bool EvaluateForPlanes(const Eigen::Vector2d& pixel, double min_viewing_cosine,
                         const std::vector<double>& mirror_planes,
                         Eigen::Ref<Eigen::VectorXd> residuals) const;

 private:
  struct Value {
    double value = 0.0;
    LandmarkJacobian1 jacobian = LandmarkJacobian1::Zero();
  };
  // Intersection of an edge pixel's ray with the surface.
  struct EdgeOnSurface {
    Eigen::Vector2d pixel;
    Eigen::Vector3d in_object;  // m
  };

  std::optional<Pair> Compare(const Eigen::Vector2d& pixel, const VisibleSurface::Point& point,
                              const Value& value, bool with_jacobian, double mirror_plane) const;
  // The value at a point, and at its pixel.
  std::optional<Value> Describe(const Eigen::Vector2d& pixel, const VisibleSurface::Point& point,
                                bool with_jacobian) const;
  std::optional<Value> DistanceToEdge(const Eigen::Vector2d& pixel,
                                      const VisibleSurface::Point& point, bool with_jacobian) const;
  // The map's value at a pixel, for kGrey and kDistanceTransform.
  std::optional<Sample> LookUp(const Eigen::Vector2d& pixel) const;
  // The edge nearest to a point: on the surface (the first of several, eq. 19), or in the image.
  std::optional<Eigen::Vector2d> EdgePixel(const Eigen::Vector2d& pixel,
                                           const Eigen::Vector3d& point_in_object) const;

  Descriptor descriptor_;
  const SymmetryImage& image_;
  VisibleSurface surface_;
  std::vector<EdgeOnSurface> edges_on_surface_;  // for kNearestEdge3d
};

// Symmetry constraint, eq. (16): the descriptor of a pixel equals that of its mirror pixel. Divided
// by sigma (in the descriptor's unit). Nearest edges are looked up anew in every evaluation;
// derivatives treat them as fixed.
//
// Residuals: 1. Blocks: world_from_camera, landmark in the world. The pairs to be used are chosen
// before the solve. Evaluate fails if SymmetryDescriptor has no pair, which makes the solver
// shorten its step. Only for descriptors with a derivative.
class SymmetryResidual final : public ceres::SizedCostFunction<1, kPoseSize, kLandmarkSize> {
 public:
  SymmetryResidual(Descriptor descriptor, std::shared_ptr<const SymmetryImage> image,
                   const Camera& camera, const Eigen::Vector2d& pixel,
                   const ShapeExponents& shape_exponents, double sigma);

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  Descriptor descriptor_;
  std::shared_ptr<const SymmetryImage> image_;
  Camera camera_;
  Eigen::Vector2d pixel_;
  ShapeExponents shape_exponents_;
  double weight_;
};

}  // namespace soslam
