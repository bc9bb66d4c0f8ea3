// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/symmetry.h"

#include <cmath>
#include <limits>

namespace soslam {

SymmetryImage::SymmetryImage(EdgeMaps edge_maps, const Box& own_box)
    : box(own_box), maps(std::move(edge_maps)), brief(maps.grey), freak(maps.grey) {
  const auto inside = CutToImage(box, maps.edges.cols, maps.edges.rows);
  if (!inside) return;
  for (int y = static_cast<int>(std::ceil(inside->y_min)); y <= inside->y_max; ++y) {
    const auto* row = maps.edges.ptr<unsigned char>(y);
    for (int x = static_cast<int>(std::ceil(inside->x_min)); x <= inside->x_max; ++x) {
      if (row[x] != 0) edge_pixels.emplace_back(x, y);
    }
  }
}

SymmetryDescriptor::SymmetryDescriptor(Descriptor descriptor, const SymmetryImage& image,
                                       const Camera& camera, const Landmark& landmark_in_camera)
    : descriptor_(descriptor), image_(image), surface_(camera, landmark_in_camera) {
  if (descriptor != Descriptor::kNearestEdge3d) return;
  for (const Eigen::Vector2d& pixel : image.edge_pixels) {
    const auto point = surface_.FromPixel(pixel);
    if (point) edges_on_surface_.push_back({pixel, point->in_object});
  }
}

std::optional<SymmetryDescriptor::Pair> SymmetryDescriptor::Evaluate(
    const Eigen::Vector2d& pixel, std::optional<double> min_viewing_cosine, bool with_jacobian,
    double mirror_plane) const {
  const auto point = VisiblePoint(pixel, min_viewing_cosine);
  return point ? EvaluateAt(pixel, *point, with_jacobian, mirror_plane) : std::nullopt;
}

std::optional<SymmetryDescriptor::Pair> SymmetryDescriptor::EvaluateAt(
    const Eigen::Vector2d& pixel, const VisibleSurface::Point& point, bool with_jacobian,
    double mirror_plane) const {
  const auto value = Describe(pixel, point, with_jacobian);
  return value ? Compare(pixel, point, *value, with_jacobian, mirror_plane) : std::nullopt;
}

bool SymmetryDescriptor::EvaluateForPlanes(const Eigen::Vector2d& pixel, double min_viewing_cosine,
                                           const std::vector<double>& mirror_planes,
                                           Eigen::Ref<Eigen::VectorXd> residuals) const {
  residuals.setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto point = surface_.FromPixel(pixel);
  if (!point) return false;
  if (!surface_.AreSeen(*point, min_viewing_cosine)) return true;
  const auto own = Describe(pixel, *point, false);
  if (!own) return true;
  const bool is_in_map =
      descriptor_ == Descriptor::kGrey || descriptor_ == Descriptor::kDistanceTransform;
  const VisibleSurface::MirrorLine line = surface_.MirrorImages(*point);
  for (size_t i = 0; i < mirror_planes.size(); ++i) {
    const double mirror_plane = mirror_planes[i];
    if (is_in_map) {  // a good part of the time of soslam-refine
      const Eigen::Vector3d pixel_times_depth = line.at_zero + mirror_plane * line.by_plane;
      if (!(pixel_times_depth.z() > 0.0)) continue;
      const auto value = LookUp(pixel_times_depth.hnormalized());
      if (value) residuals[i] = own->value - value->value;
    } else if (const auto pair = Compare(pixel, *point, *own, false, mirror_plane)) {
      residuals[i] = pair->residual;
    }
  }
  return true;
}

std::optional<VisibleSurface::Point> SymmetryDescriptor::VisiblePoint(
    const Eigen::Vector2d& pixel, std::optional<double> min_viewing_cosine) const {
  auto point = surface_.FromPixel(pixel);
  if (point && min_viewing_cosine && !surface_.AreSeen(*point, *min_viewing_cosine)) {
    return std::nullopt;
  }
  return point;
}

std::optional<SymmetryDescriptor::Pair> SymmetryDescriptor::Compare(
    const Eigen::Vector2d& pixel, const VisibleSurface::Point& point, const Value& value,
    bool with_jacobian, double mirror_plane) const {
  const VisibleSurface::Point mirrored = surface_.MirrorImage(point, mirror_plane);
  const auto mirror_pixel = surface_.ToPixel(mirrored);
  if (!mirror_pixel) return std::nullopt;
  Pair pair;
  pair.mirror_pixel = *mirror_pixel;
  if (descriptor_ == Descriptor::kBrief || descriptor_ == Descriptor::kFreak) {
    const auto distance = descriptor_ == Descriptor::kBrief
                              ? image_.brief.Distance(pixel, *mirror_pixel)
                              : image_.freak.Distance(pixel, *mirror_pixel);
    if (!distance) return std::nullopt;
    pair.residual = *distance;
    return pair;
  }
  const auto mirror_value = Describe(*mirror_pixel, mirrored, with_jacobian);
  if (!mirror_value) return std::nullopt;
  pair.residual = value.value - mirror_value->value;
  if (with_jacobian) pair.jacobian = value.jacobian - mirror_value->jacobian;
  return pair;
}

std::optional<SymmetryDescriptor::Value> SymmetryDescriptor::Describe(
    const Eigen::Vector2d& pixel, const VisibleSurface::Point& point, bool with_jacobian) const {
  switch (descriptor_) {
    case Descriptor::kBrief:
    case Descriptor::kFreak:
      return Value();  // compares two pixels directly
    case Descriptor::kGrey:
    case Descriptor::kDistanceTransform: {
      const auto sample = LookUp(pixel);
      if (!sample) return std::nullopt;
      Value value{sample->value};
      if (with_jacobian && !point.IsOnRay()) {
        value.jacobian = surface_.PixelDerivative(point, sample->gradient);
      }
      return value;
    }
    default:
      return DistanceToEdge(pixel, point, with_jacobian);
  }
}

std::optional<Eigen::Vector2d> SymmetryDescriptor::EdgePixel(
    const Eigen::Vector2d& pixel, const Eigen::Vector3d& point_in_object) const {
  if (descriptor_ != Descriptor::kNearestEdge3d) return NearestEdge(image_.maps, pixel);
  std::optional<Eigen::Vector2d> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (const EdgeOnSurface& edge : edges_on_surface_) {
    const double squared_distance = (edge.in_object - point_in_object).squaredNorm();
    if (!(squared_distance < least)) continue;
    least = squared_distance;
    nearest = edge.pixel;
  }
  return nearest;
}

std::optional<SymmetryDescriptor::Value> SymmetryDescriptor::DistanceToEdge(
    const Eigen::Vector2d& pixel, const VisibleSurface::Point& point, bool with_jacobian) const {
  const auto edge_pixel = EdgePixel(pixel, point.in_object);
  if (!edge_pixel) return std::nullopt;
  const bool is_on_plane = descriptor_ == Descriptor::kLinearisedDt;
  const auto on_surface = is_on_plane ? std::nullopt : surface_.FromPixel(*edge_pixel);
  const auto on_plane =
      is_on_plane ? surface_.FromPixelOnTangentPlane(*edge_pixel, point) : std::nullopt;
  if (!on_surface && !on_plane) return std::nullopt;

  const Eigen::Vector3d& edge = is_on_plane ? *on_plane : on_surface->in_object;
  const Eigen::Vector3d difference = edge - point.in_object;
  Value value{difference.norm()};
  // On an edge the distance has a kink; 0 is one of its subgradients.
  if (with_jacobian && value.value > 0.0) {
    const Eigen::Vector3d direction = difference / value.value;
    value.jacobian = (is_on_plane ? surface_.DerivativeOnTangentPlane(edge, point, direction)
                                  : surface_.Derivative(*on_surface, direction)) -
                     surface_.Derivative(point, direction);
  }
  return value;
}

std::optional<Sample> SymmetryDescriptor::LookUp(const Eigen::Vector2d& pixel) const {
  const bool grey = descriptor_ == Descriptor::kGrey;
  const auto sample = SampleBilinear(grey ? image_.maps.grey : image_.maps.distance, pixel);
  if (!sample) return std::nullopt;
  const double scale = grey ? 1.0 / 255.0 : 1.0;
  return Sample{scale * sample->value, scale * sample->gradient};
}

SymmetryResidual::SymmetryResidual(Descriptor descriptor,
                                   std::shared_ptr<const SymmetryImage> image, const Camera& camera,
                                   const Eigen::Vector2d& pixel,
                                   const ShapeExponents& shape_exponents, double sigma)
    : descriptor_(descriptor),
      image_(std::move(image)),
      camera_(camera),
      pixel_(pixel),
      shape_exponents_(shape_exponents),
      weight_(1.0 / sigma) {}

bool SymmetryResidual::Evaluate(double const* const* blocks, double* residuals,
                                double** jacobians) const {
  const RelativeObservation observation(blocks, shape_exponents_);
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
