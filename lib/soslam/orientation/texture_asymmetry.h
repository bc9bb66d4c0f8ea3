// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "soslam/constraints/landmark_cost.h"
#include "soslam/geometry/camera.h"
#include "soslam/orientation/options.h"
#include "soslam/orientation/symmetry.h"

namespace soslam {

// Calls `add` with candidates of pixels to compare, section V-D: corners in the box and/or a
// uniform grid over it, or its edge pixels. Corners come first, strongest first. `add` returns
// whether the pixel's ray meets the landmark: at most options.max_corners corners do.
void ForEachSample(const SymmetryImage& image, const SymmetryOptions& options,
                   const std::function<bool(const Eigen::Vector2d&)>& add);

// The candidates whose rays meet a landmark.
std::vector<Eigen::Vector2d> SamplePixels(const SymmetryImage& image, const Camera& camera,
                                          const Landmark& landmark_in_camera,
                                          const SymmetryOptions& options);

// Throws SettingsError if the mirror plane may be offset from the xz plane but the descriptor is
// measured on the surface, on which mirror points then no longer lie.
void CheckMirrorPlane(const TextureOptions& options, Descriptor descriptor);

// The visible mirrored pairs of the texture in one detection's box, on the landmark's own surface,
// with the offset of the mirror plane (see VisibleSurface::MirrorImage) within
// options.mirror_plane_range at which they differ least. Mirror pixels may then lie outside the
// landmark: the width of an object is not known better than its centre.
struct MirroredTexture {
  // The mean over the pairs of d^2 / (d^2 + s^2), d the descriptor difference of eq. (16), s the
  // difference from which on a pair counts as asymmetric: 0 to 1. The loss saturates, so that a
  // completely different pair has no more weight than a clearly different one.
  double asymmetry = 1.0;
  double mirror_plane = 0.0;
  std::vector<Eigen::Vector2d> pixels;  // one of each pair
};

// Finds the mirrored texture of many landmarks. None if too few pairs are visible.
class TextureAsymmetry {
 public:
  // `image` must outlive this object.
  TextureAsymmetry(const SymmetryImage& image, const Camera& camera, const TextureOptions& options,
                   const SymmetryOptions& symmetry_options);

  // Pairs are mirrored in the xz plane of the landmark's own axes (InOwnAxes).
  std::optional<MirroredTexture> Find(const Landmark& landmark_in_camera) const;
  // Cost of a landmark as a negative log likelihood: options.asymmetry_cost times the asymmetry,
  // with an asymmetry of 1 if too few pairs are visible.
  double Cost(const Landmark& landmark_in_camera) const;

 private:
  const SymmetryImage& image_;
  Camera camera_;
  TextureOptions options_;
  SymmetryOptions symmetry_options_;
  std::vector<double> places_;  // candidate offsets of the mirror plane
};

// The asymmetry cost for the back end, with the pairs and the mirror plane of the initial landmark
// fixed, multiplied by `weight`. A pair whose pixel leaves the surface counts as fully asymmetric,
// the limit for large differences. Only for descriptors with a derivative.
class AsymmetryCost final : public LandmarkCost {
 public:
  AsymmetryCost(std::shared_ptr<const SymmetryImage> image, const Camera& camera,
                const Landmark& start_in_camera, const TextureOptions& options,
                const SymmetryOptions& symmetry_options, double weight);

  // 0 if too few pairs are visible.
  int NumPairs() const { return static_cast<int>(texture_.pixels.size()); }

  double Value(const Landmark& landmark_in_camera) const override;
  void AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const override;
  bool ConvergesSlowly() const override { return true; }

 private:
  SymmetryDescriptor ComputeDescriptor(const Landmark& landmark_in_camera) const;
  // Residual of a pair, and its derivative by the landmark in its own axes; the loss is included.
  double Residual(const SymmetryDescriptor& descriptor, const Eigen::Vector2d& pixel,
                  LandmarkJacobian1* jacobian) const;

  std::shared_ptr<const SymmetryImage> image_;
  Camera camera_;
  Descriptor descriptor_;
  RestingFace rests_on_;  // of the initial landmark
  MirroredTexture texture_;
  double scale_;   // s
  double weight_;  // of one pair
};

}  // namespace soslam
