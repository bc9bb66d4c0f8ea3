// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/texture_asymmetry.h"

#include <algorithm>
#include <cmath>

#include "image/brief.h"
#include "symmetry/sampling.h"

namespace soslam {
namespace {

// Places of the mirror plane to either side of the centre.
constexpr int kMirrorPlaneSteps = 8;

double Size(const Landmark& landmark) { return std::cbrt(landmark.half_axes.prod()); }

// In the descriptor's unit.
double Scale(const Landmark& landmark, Descriptor descriptor, const TextureOptions& options) {
  switch (descriptor) {
    case Descriptor::kDistanceTransform:
      return options.asymmetry_scale_px;
    case Descriptor::kGrey:
      return options.asymmetry_scale;
    case Descriptor::kBrief:
      return options.asymmetry_scale * static_cast<double>(BriefBits().size());
    default:
      return options.asymmetry_scale * Size(landmark);
  }
}

bool AreEnough(size_t pairs, size_t samples, const SymmetryOptions& options) {
  return static_cast<double>(pairs) >=
         std::max(static_cast<double>(options.min_pairs),
                  options.min_pair_fraction * static_cast<double>(samples));
}

// The samples whose pairs are visible; none when they are too few.
std::vector<Eigen::Vector2d> VisiblePairs(const SymmetryDescriptor& descriptor,
                                          const SymmetryImage& image, const Camera& camera,
                                          const Box& box, const Landmark& landmark_in_camera,
                                          const SymmetryOptions& options) {
  const auto samples = SamplePixels(image.maps, camera, landmark_in_camera, box, options);
  std::vector<Eigen::Vector2d> visible;
  std::copy_if(samples.begin(), samples.end(), std::back_inserter(visible), [&](const auto& pixel) {
    return descriptor.Evaluate(pixel, options.min_viewing_cosine, false).has_value();
  });
  if (!AreEnough(visible.size(), samples.size(), options)) visible.clear();
  return visible;
}

// Where the mirror plane may lie, metres to the side of the centre.
std::vector<double> MirrorPlaneOffsets(const Landmark& landmark, const TextureOptions& options) {
  const double range = options.mirror_plane_range * Size(landmark);
  if (!(range > 0.0)) return {0.0};
  std::vector<double> offsets;
  for (int i = -kMirrorPlaneSteps; i <= kMirrorPlaneSteps; ++i) {
    offsets.push_back(range * i / kMirrorPlaneSteps);
  }
  return offsets;
}

}  // namespace

double AsymmetryCost(const SymmetryImage& image, const Camera& camera, const Box& box,
                     const Landmark& landmark_in_camera, const TextureOptions& options,
                     const SymmetryOptions& symmetry_options) {
  const SymmetryDescriptor descriptor(symmetry_options.descriptor, image, camera,
                                      landmark_in_camera);
  const double squared_scale =
      std::pow(Scale(landmark_in_camera, symmetry_options.descriptor, options), 2);
  const auto samples = SamplePixels(image.maps, camera, landmark_in_camera, box, symmetry_options);
  const std::vector<double> offsets = MirrorPlaneOffsets(landmark_in_camera, options);
  std::vector<double> sums(offsets.size(), 0.0);
  std::vector<size_t> pairs(offsets.size(), 0);
  for (const Eigen::Vector2d& pixel : samples) {
    const auto residuals =
        descriptor.Residuals(pixel, symmetry_options.min_viewing_cosine, offsets);
    if (!residuals) continue;
    for (size_t i = 0; i < offsets.size(); ++i) {
      if (std::isnan((*residuals)[i])) continue;
      const double squared = std::pow((*residuals)[i], 2);
      sums[i] += squared / (squared + squared_scale);
      ++pairs[i];
    }
  }
  double lowest = 1.0;
  for (size_t i = 0; i < offsets.size(); ++i) {
    if (!AreEnough(pairs[i], samples.size(), symmetry_options)) continue;
    lowest = std::min(lowest, sums[i] / static_cast<double>(pairs[i]));
  }
  return options.asymmetry_cost * lowest;
}

AsymmetryResidual::AsymmetryResidual(std::shared_ptr<const SymmetryImage> image,
                                     const Camera& camera, const Box& box,
                                     const Landmark& start_in_camera, const TextureOptions& options,
                                     const SymmetryOptions& symmetry_options, double weight)
    : image_(std::move(image)),
      camera_(camera),
      descriptor_(symmetry_options.descriptor),
      pixels_(VisiblePairs(SymmetryDescriptor(descriptor_, *image_, camera, start_in_camera),
                           *image_, camera, box, start_in_camera, symmetry_options)),
      shape_exponent_(start_in_camera.shape_exponent),
      scale_(Scale(start_in_camera, descriptor_, options)),
      amplitude_(std::sqrt(2.0 * weight * options.asymmetry_cost /
                           static_cast<double>(std::max<size_t>(1, pixels_.size())))) {
  set_num_residuals(static_cast<int>(pixels_.size()));
  *mutable_parameter_block_sizes() = {kPoseSize, kLandmarkSize};
}

bool AsymmetryResidual::Evaluate(double const* const* blocks, double* residuals,
                                 double** jacobians) const {
  const RelativeObservation observation(blocks, shape_exponent_);
  const SymmetryDescriptor descriptor(descriptor_, *image_, camera_,
                                      observation.landmark_in_camera());
  Eigen::Matrix<double, Eigen::Dynamic, kLandmarkDof> by_landmark(num_residuals(), kLandmarkDof);
  by_landmark.setZero();
  for (size_t i = 0; i < pixels_.size(); ++i) {
    const auto pair = descriptor.Evaluate(pixels_[i], std::nullopt, jacobians != nullptr);
    residuals[i] = amplitude_;
    if (!pair) continue;
    // d / sqrt(d^2 + s^2)
    const double norm = std::hypot(pair->residual, scale_);
    residuals[i] = amplitude_ * pair->residual / norm;
    if (jacobians == nullptr) continue;
    by_landmark.row(static_cast<Eigen::Index>(i)) =
        amplitude_ * scale_ * scale_ / (norm * norm * norm) * pair->jacobian;
  }
  observation.WriteJacobians<Eigen::Dynamic>(by_landmark, blocks, jacobians);
  return true;
}

}  // namespace soslam
