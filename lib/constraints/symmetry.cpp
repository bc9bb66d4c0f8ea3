// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/symmetry.h"

#include <cmath>
#include <limits>

#include "image/brief.h"

namespace soslam {

SymmetryImage::SymmetryImage(EdgeMaps edge_maps, const Box& box)
    : maps(std::move(edge_maps)), smoothed_grey(SmoothForBrief(maps.grey)) {
  for (int y = 0; y < maps.edges.rows; ++y) {
    for (int x = 0; x < maps.edges.cols; ++x) {
      const Eigen::Vector2d pixel(x, y);
      if (maps.edges.at<unsigned char>(y, x) != 0 && box.Contains(pixel)) {
        edge_pixels.push_back(pixel);
      }
    }
  }
}

SymmetryDescriptor::SymmetryDescriptor(Descriptor descriptor, const SymmetryImage& image,
                                       const Camera& camera, const Landmark& landmark_in_camera)
    : descriptor_(descriptor), image_(image), surface_(camera, landmark_in_camera) {
  if (descriptor != Descriptor::kNearestEdge3d) return;
  for (const Eigen::Vector2d& pixel : image.edge_pixels) {
    if (const auto point = surface_.FromPixel(pixel)) {
      surface_edge_pixels_.push_back(pixel);
      surface_edges_in_object_.push_back(point->in_object);
    }
  }
}

std::optional<SymmetryDescriptor::Pair> SymmetryDescriptor::Evaluate(
    const Eigen::Vector2d& pixel, std::optional<double> min_viewing_cosine,
    bool with_jacobian) const {
  const auto point = surface_.FromPixel(pixel, with_jacobian);
  if (!point) return std::nullopt;
  const VisibleSurface::Point mirrored = surface_.MirrorImage(*point);
  if (min_viewing_cosine && !(surface_.ViewingCosine(*point) >= *min_viewing_cosine &&
                              surface_.ViewingCosine(mirrored) >= *min_viewing_cosine)) {
    return std::nullopt;
  }
  const auto mirror = surface_.ToPixel(mirrored, with_jacobian);
  if (!mirror) return std::nullopt;

  Pair pair;
  pair.mirror_pixel = mirror->pixel;
  if (descriptor_ == Descriptor::kBrief) {
    const auto distance = BriefDistance(pixel, mirror->pixel);
    if (!distance) return std::nullopt;
    pair.residual = *distance;
    return pair;
  }
  const bool on_surface =
      descriptor_ != Descriptor::kGrey && descriptor_ != Descriptor::kDistanceTransform;
  const auto value = on_surface ? SurfaceDistance(pixel, *point, with_jacobian)
                                : LookUp(pixel, with_jacobian, LandmarkJacobian2::Zero());
  const auto mirror_value = on_surface ? SurfaceDistance(mirror->pixel, mirrored, with_jacobian)
                                       : LookUp(mirror->pixel, with_jacobian, mirror->jacobian);
  if (!value || !mirror_value) return std::nullopt;
  pair.residual = value->value - mirror_value->value;
  if (with_jacobian) pair.jacobian = value->jacobian - mirror_value->jacobian;
  return pair;
}

std::optional<std::vector<double>> SymmetryDescriptor::Residuals(
    const Eigen::Vector2d& pixel, double min_viewing_cosine,
    const std::vector<double>& offsets) const {
  const auto point = surface_.FromPixel(pixel);
  if (!point) return std::nullopt;
  const VisibleSurface::Point mirrored = surface_.MirrorImage(*point);
  if (!(surface_.ViewingCosine(*point) >= min_viewing_cosine &&
        surface_.ViewingCosine(mirrored) >= min_viewing_cosine)) {
    return std::nullopt;
  }
  const bool on_surface =
      descriptor_ != Descriptor::kGrey && descriptor_ != Descriptor::kDistanceTransform;
  const auto describe = [&](const Eigen::Vector2d& at, const VisibleSurface::Point& on) {
    return on_surface ? SurfaceDistance(at, on, false)
                      : LookUp(at, false, LandmarkJacobian2::Zero());
  };
  const auto compare = [&](const VisibleSurface::Point& moved) -> std::optional<double> {
    const auto mirror = surface_.ToPixel(moved);
    if (!mirror) return std::nullopt;
    if (descriptor_ == Descriptor::kBrief) return BriefDistance(pixel, mirror->pixel);
    const auto value = describe(pixel, *point);
    const auto mirror_value = describe(mirror->pixel, moved);
    if (!value || !mirror_value) return std::nullopt;
    return value->value - mirror_value->value;
  };
  std::vector<double> residuals;
  for (const double offset : offsets) {
    VisibleSurface::Point moved = mirrored;
    moved.in_object.y() += 2.0 * offset;
    residuals.push_back(compare(moved).value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return residuals;
}

std::optional<SymmetryDescriptor::Value> SymmetryDescriptor::SurfaceDistance(
    const Eigen::Vector2d& pixel, const VisibleSurface::Point& point, bool with_jacobian) const {
  std::optional<Eigen::Vector2d> edge_pixel;
  if (descriptor_ == Descriptor::kNearestEdge3d) {
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < surface_edges_in_object_.size(); ++i) {
      const double distance = (surface_edges_in_object_[i] - point.in_object).squaredNorm();
      if (distance < nearest) {
        nearest = distance;
        edge_pixel = surface_edge_pixels_[i];
      }
    }
  } else {
    edge_pixel = NearestEdge(image_.maps, pixel);
  }
  if (!edge_pixel) return std::nullopt;
  const auto edge = descriptor_ == Descriptor::kLinearisedDt
                        ? surface_.FromPixelOnTangentPlane(*edge_pixel, point, with_jacobian)
                        : surface_.FromPixel(*edge_pixel, with_jacobian);
  if (!edge) return std::nullopt;

  const Eigen::Vector3d difference = edge->in_object - point.in_object;
  Value value{difference.norm(), LandmarkJacobian1::Zero()};
  // On an edge the distance has a kink; 0 is one of its subgradients.
  if (with_jacobian && value.value > 0.0) {
    value.jacobian = difference.transpose() / value.value * (edge->jacobian - point.jacobian);
  }
  return value;
}

std::optional<SymmetryDescriptor::Value> SymmetryDescriptor::LookUp(
    const Eigen::Vector2d& pixel, bool with_jacobian,
    const LandmarkJacobian2& pixel_jacobian) const {
  const bool grey = descriptor_ == Descriptor::kGrey;
  const auto sample = SampleBilinear(grey ? image_.maps.grey : image_.maps.distance, pixel);
  if (!sample || !std::isfinite(sample->value)) return std::nullopt;
  const double scale = grey ? 1.0 / 255.0 : 1.0;
  Value value{scale * sample->value, LandmarkJacobian1::Zero()};
  if (with_jacobian) value.jacobian = scale * sample->gradient.transpose() * pixel_jacobian;
  return value;
}

std::optional<double> SymmetryDescriptor::BriefDistance(const Eigen::Vector2d& pixel,
                                                        const Eigen::Vector2d& mirror_pixel) const {
  const auto descriptor = BriefDescriptor(image_.smoothed_grey, pixel, false);
  const auto mirrored = BriefDescriptor(image_.smoothed_grey, mirror_pixel, true);
  if (!descriptor || !mirrored) return std::nullopt;
  return HammingDistance(*descriptor, *mirrored);
}

SymmetryResidual::SymmetryResidual(Descriptor descriptor,
                                   std::shared_ptr<const SymmetryImage> image, const Camera& camera,
                                   const Eigen::Vector2d& pixel, double shape_exponent,
                                   double sigma)
    : descriptor_(descriptor),
      image_(std::move(image)),
      camera_(camera),
      pixel_(pixel),
      shape_exponent_(shape_exponent),
      weight_(1.0 / sigma) {}

bool SymmetryResidual::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const RelativeObservation observation(blocks, shape_exponent_);
  const SymmetryDescriptor descriptor(descriptor_, *image_, camera_,
                                      observation.landmark_in_camera());
  const auto pair = descriptor.Evaluate(pixel_, std::nullopt, jacobians != nullptr);
  if (!pair) return false;
  residuals[0] = weight_ * pair->residual;
  if (jacobians != nullptr) {
    observation.WriteJacobians<1>(weight_ * pair->jacobian, blocks, jacobians);
  }
  return true;
}

}  // namespace soslam
