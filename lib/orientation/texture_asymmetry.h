// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "constraints/symmetry.h"
#include "geometry/camera.h"
#include "initialisation/landmark_cost.h"
#include "orientation/mirror_residuals.h"
#include "orientation/mirror_search.h"
#include "orientation/options.h"
#include "symmetry/options.h"

namespace soslam {

// Throws SettingsError for a mirror plane that may lie beside the xz plane and a descriptor that is
// measured on the surface, where mirror points are not any more.
void CheckMirrorPlane(const TextureOptions& options, Descriptor descriptor);

// The visible mirrored pairs of the texture in one detection's box, on the landmark's own surface,
// at the place of the mirror plane (see VisibleSurface::MirrorImage) within
// options.mirror_plane_range where they differ least. Mirror pixels may then lie beside the
// landmark: how wide the object is, is known no better than where its middle is.
struct MirroredTexture {
  // The mean over the pairs of d^2 / (d^2 + s^2), d the descriptor difference of eq. (16), s what
  // counts as no symmetry: 0 to 1; a pair that differs wholly counts no more than one that differs
  // clearly.
  double asymmetry = 1.0;
  double mirror_plane = 0.0;
  std::vector<Eigen::Vector2d> pixels;  // one of each pair
};

// Finds it for many landmarks. None where too few pairs are visible. Not for several threads at
// once.
class TextureAsymmetry {
 public:
  // `image` has to outlive it.
  TextureAsymmetry(const SymmetryImage& image, const Camera& camera, const TextureOptions& options,
                   const SymmetryOptions& symmetry_options);

  std::optional<MirroredTexture> Find(const Landmark& landmark_in_camera);
  // What it costs a landmark, as a negative logarithm of a likelihood: options.asymmetry_cost times
  // the asymmetry; all of it where too few pairs are visible.
  double Cost(const Landmark& landmark_in_camera);

 private:
  // Without pixels.
  std::optional<MirroredTexture> FindByMap(const Landmark& landmark_in_camera);
  std::optional<MirroredTexture> FindPairByPair(const Landmark& landmark_in_camera) const;

  const SymmetryImage& image_;
  Camera camera_;
  TextureOptions options_;
  SymmetryOptions symmetry_options_;
  std::vector<double> places_;          // of the mirror plane
  std::optional<MirrorSearch> search_;  // where the descriptor and the samples allow it
};

// The same for the back end, of the pairs and the mirror plane that are the start's, multiplied by
// `weight`. A pair whose pixel leaves the surface counts as asymmetric, the limit of one that
// differs more and more. Not for kBrief, which has no derivative.
class AsymmetryTerm final : public LandmarkCost {
 public:
  AsymmetryTerm(std::shared_ptr<const SymmetryImage> image, const Camera& camera,
                const Landmark& start_in_camera, const TextureOptions& options,
                const SymmetryOptions& symmetry_options, double weight);

  // None where too few are visible.
  int NumPairs() const { return static_cast<int>(texture_.pixels.size()); }

  double Value(const Landmark& landmark_in_camera) const override;
  void AddTo(const Landmark& landmark_in_camera, LandmarkModel* sum) const override;
  bool HasKinks() const override { return true; }

 private:
  std::shared_ptr<const SymmetryImage> image_;
  Camera camera_;
  Descriptor descriptor_;
  MirroredTexture texture_;
  double scale_;                           // s
  double weight_;                          // of one pair's share
  std::optional<MirrorResiduals> by_map_;  // where the descriptor is a map's value
};

}  // namespace soslam
