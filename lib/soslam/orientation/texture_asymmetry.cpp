// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/texture_asymmetry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "soslam/base/error.h"
#include "soslam/constraints/loss.h"
#include "soslam/geometry/mirror_mapping.h"

namespace soslam {
namespace {

// Number of offsets of the mirror plane on either side of the centre.
constexpr int kMirrorPlaneSteps = 8;

// The scale s of MirroredTexture, in the descriptor's unit.
double Scale(const Landmark& landmark, Descriptor descriptor, const TextureOptions& options) {
  switch (descriptor) {
    case Descriptor::kDistanceTransform:
      return options.asymmetry_scale_px;
    case Descriptor::kGrey:
    case Descriptor::kBrief:
    case Descriptor::kFreak:
      return options.asymmetry_scale;
    default:
      return options.asymmetry_scale * MeanHalfAxis(landmark);
  }
}

}  // namespace

void ForEachSample(const SymmetryImage& image, const SymmetryOptions& options,
                   const std::function<bool(const Eigen::Vector2d&)>& add) {
  const Box& box = image.box;
  if (options.sampling == Sampling::kEdges) {
    // Every stride-th edge pixel, so that they are thinned evenly.
    const auto max_count = static_cast<size_t>(options.max_edge_pixels);
    const size_t stride =
        std::max<size_t>(1, (image.edge_pixels.size() + max_count - 1) / max_count);
    for (size_t i = 0; i < image.edge_pixels.size(); i += stride) add(image.edge_pixels[i]);
    return;
  }
  if (options.sampling != Sampling::kUniform) {
    int corners = 0;
    for (const Eigen::Vector2f& corner : image.maps.corners) {
      const Eigen::Vector2d pixel = corner.cast<double>();
      if (corners < options.max_corners && box.Contains(pixel) && add(pixel)) ++corners;
    }
  }
  if (options.sampling != Sampling::kCorners) {
    const int columns = options.uniform_columns;
    for (int row = 0; row < columns; ++row) {
      for (int column = 0; column < columns; ++column) {
        add({box.x_min + (column + 0.5) / columns * box.Width(),
             box.y_min + (row + 0.5) / columns * box.Height()});
      }
    }
  }
}

std::vector<Eigen::Vector2d> SamplePixels(const SymmetryImage& image, const Camera& camera,
                                          const Landmark& landmark_in_camera,
                                          const SymmetryOptions& options) {
  const VisibleSurface surface(camera, landmark_in_camera);
  std::vector<Eigen::Vector2d> samples;
  ForEachSample(image, options, [&](const Eigen::Vector2d& pixel) {
    const bool is_on_landmark = surface.FromPixel(pixel).has_value();
    if (is_on_landmark) samples.push_back(pixel);
    return is_on_landmark;
  });
  return samples;
}

void CheckMirrorPlane(const TextureOptions& options, Descriptor descriptor) {
  const bool on_surface = descriptor == Descriptor::kNearestEdge3d ||
                          descriptor == Descriptor::kImprovedDt ||
                          descriptor == Descriptor::kLinearisedDt;
  if (!on_surface || !(options.mirror_plane_range > 0.0)) return;
  throw SettingsError(fmt::format("mirror_plane_range is {}; expected 0 with descriptor = {}",
                                  options.mirror_plane_range,
                                  kDescriptorNames[static_cast<size_t>(descriptor)]));
}

TextureAsymmetry::TextureAsymmetry(const SymmetryImage& image, const Camera& camera,
                                   const TextureOptions& options,
                                   const SymmetryOptions& symmetry_options)
    : image_(image), camera_(camera), options_(options), symmetry_options_(symmetry_options) {
  const int steps = options.mirror_plane_range > 0.0 ? kMirrorPlaneSteps : 0;
  for (int i = -steps; i <= steps; ++i) {
    places_.push_back(options.mirror_plane_range * i / kMirrorPlaneSteps);
  }
}

double TextureAsymmetry::Cost(const Landmark& landmark_in_camera) const {
  const auto texture = Find(landmark_in_camera);
  return options_.asymmetry_cost * (texture ? texture->asymmetry : 1.0);
}

std::optional<MirroredTexture> TextureAsymmetry::Find(const Landmark& landmark_in_camera) const {
  const SymmetryDescriptor descriptor(symmetry_options_.descriptor, image_, camera_,
                                      InOwnAxes(landmark_in_camera));
  const double scale = Scale(landmark_in_camera, symmetry_options_.descriptor, options_);
  const GemanMcClureLoss loss(scale);
  std::vector<Eigen::Vector2d> samples;
  const auto num_places = static_cast<Eigen::Index>(places_.size());
  constexpr Eigen::Index kUsualSamples = 256;  // more than 150 corners and a grid of 8 x 8
  Eigen::MatrixXd residuals(num_places, kUsualSamples);  // by sample; NaN if there is no pair
  ForEachSample(image_, symmetry_options_, [&](const Eigen::Vector2d& pixel) {
    const auto column = static_cast<Eigen::Index>(samples.size());
    if (column == residuals.cols()) residuals.conservativeResize(num_places, 2 * column);
    const bool is_on_surface = descriptor.EvaluateForPlanes(
        pixel, symmetry_options_.min_viewing_cosine, places_, residuals.col(column));
    if (is_on_surface) samples.push_back(pixel);
    return is_on_surface;
  });
  std::optional<MirroredTexture> best;
  Eigen::Index best_place = 0;
  std::vector<double> sums(places_.size()), pairs(places_.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    for (Eigen::Index place = 0; place < num_places; ++place) {
      const double residual = residuals(place, static_cast<Eigen::Index>(i));
      if (!std::isfinite(residual)) continue;
      sums[place] += 2.0 * EvaluateLoss(loss, residual).cost / (scale * scale);
      pairs[place] += 1.0;
    }
  }
  for (Eigen::Index place = 0; place < num_places; ++place) {
    if (pairs[place] < symmetry_options_.MinPairs(samples.size())) continue;
    const double asymmetry = sums[place] / pairs[place];
    if (best && best->asymmetry <= asymmetry) continue;
    best = MirroredTexture{asymmetry, places_[place], {}};
    best_place = place;
  }
  if (!best) return std::nullopt;
  for (size_t i = 0; i < samples.size(); ++i) {
    if (std::isfinite(residuals(best_place, static_cast<Eigen::Index>(i)))) {
      best->pixels.push_back(samples[i]);
    }
  }
  return best;
}

AsymmetryCost::AsymmetryCost(std::shared_ptr<const SymmetryImage> image, const Camera& camera,
                             const Landmark& start_in_camera, const TextureOptions& options,
                             const SymmetryOptions& symmetry_options, double weight)
    : image_(std::move(image)),
      camera_(camera),
      descriptor_(symmetry_options.descriptor),
      rests_on_(start_in_camera.rests_on),
      texture_(TextureAsymmetry(*image_, camera, options, symmetry_options)
                   .Find(start_in_camera)
                   .value_or(MirroredTexture())),
      scale_(Scale(start_in_camera, descriptor_, options)),
      weight_(2.0 * weight * options.asymmetry_cost /
              static_cast<double>(std::max<size_t>(1, texture_.pixels.size()))) {}

SymmetryDescriptor AsymmetryCost::ComputeDescriptor(const Landmark& landmark_in_camera) const {
  Landmark landmark = landmark_in_camera;
  landmark.rests_on = rests_on_;
  return {descriptor_, *image_, camera_, InOwnAxes(landmark)};
}

double AsymmetryCost::Residual(const SymmetryDescriptor& descriptor, const Eigen::Vector2d& pixel,
                               LandmarkJacobian1* jacobian) const {
  const bool with_jacobian = jacobian != nullptr;
  if (with_jacobian) jacobian->setZero();
  const auto pair = descriptor.Evaluate(pixel, std::nullopt, with_jacobian, texture_.mirror_plane);
  if (!pair) return 1.0;  // the limit for large differences
  const RobustResidual robust = RobustifyResidual(GemanMcClureLoss(scale_), pair->residual);
  // A ray that grazes the surface has no derivative.
  if (with_jacobian && pair->jacobian.allFinite()) {
    *jacobian = robust.slope / scale_ * pair->jacobian;
  }
  return robust.value / scale_;
}

double AsymmetryCost::Value(const Landmark& landmark_in_camera) const {
  const SymmetryDescriptor descriptor = ComputeDescriptor(landmark_in_camera);
  double sum = 0.0;
  for (const Eigen::Vector2d& pixel : texture_.pixels) {
    const double residual = Residual(descriptor, pixel, nullptr);
    sum += residual * residual;
  }
  return 0.5 * weight_ * sum;
}

void AsymmetryCost::AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const {
  const SymmetryDescriptor descriptor = ComputeDescriptor(landmark_in_camera);
  const Eigen::Matrix3d own_from_object = OwnFromObject(rests_on_).cwiseAbs();
  LandmarkModel pairs;
  for (const Eigen::Vector2d& pixel : texture_.pixels) {
    LandmarkJacobian1 jacobian;
    const double residual = Residual(descriptor, pixel, &jacobian);
    jacobian.tail<3>() *= own_from_object;  // logarithms of half axes by those of the object frame
    pairs.Add(residual, jacobian.transpose());
  }
  sum->Add(pairs, weight_);
}

}  // namespace soslam
