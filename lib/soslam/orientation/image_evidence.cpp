// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/orientation/image_evidence.h"

#include <utility>
#include <vector>

#include "soslam/orientation/texture_asymmetry.h"

namespace soslam {
namespace {

class TextureEvidence : public ImageEvidence {
 public:
  TextureEvidence(std::shared_ptr<const SymmetryImage> image, const Camera& camera,
                  const SymmetryOptions& symmetry_options)
      : image_(std::move(image)), camera_(camera), symmetry_options_(symmetry_options) {}

 protected:
  static ImageResiduals Pairs(int count) {
    return {"symmetry", "symmetry_with_too_few_visible_pairs", {}, count};
  }

  std::shared_ptr<const SymmetryImage> image_;
  Camera camera_;
  SymmetryOptions symmetry_options_;
};

class SymmetryEvidence final : public TextureEvidence {
 public:
  SymmetryEvidence(std::shared_ptr<const SymmetryImage> image, const Camera& camera,
                   const SymmetryOptions& options, double sigma)
      : TextureEvidence(std::move(image), camera, options), sigma_(sigma) {}

  ImageResiduals ResidualsAt(const Landmark& start, const Landmark* /*weighed_at*/,
                             double /*weight*/) const override {
    const SymmetryDescriptor descriptor(symmetry_options_.descriptor, *image_, camera_, start);
    const auto samples = SamplePixels(*image_, camera_, start, symmetry_options_);
    std::vector<Eigen::Vector2d> visible;
    for (const Eigen::Vector2d& pixel : samples) {
      if (descriptor.Evaluate(pixel, symmetry_options_.min_viewing_cosine, false)) {
        visible.push_back(pixel);
      }
    }
    ImageResiduals residuals = Pairs(static_cast<int>(visible.size()));
    if (residuals.count < symmetry_options_.MinPairs(samples.size())) return residuals;
    for (const Eigen::Vector2d& pixel : visible) {
      residuals.functions.push_back(std::make_unique<SymmetryResidual>(
          symmetry_options_.descriptor, image_, camera_, pixel, start.shape_exponents, sigma_));
    }
    return residuals;
  }

 private:
  double sigma_;
};

class AsymmetryEvidence final : public TextureEvidence {
 public:
  AsymmetryEvidence(std::shared_ptr<const SymmetryImage> image, const Camera& camera,
                    const TextureOptions& options, const SymmetryOptions& symmetry_options)
      : TextureEvidence(std::move(image), camera, symmetry_options),
        options_(options),
        asymmetry_(*image_, camera, options, symmetry_options) {}

  ImageResiduals ResidualsAt(const Landmark& start, const Landmark* /*weighed_at*/,
                             double weight) const override {
    auto cost = std::make_unique<AsymmetryCost>(image_, camera_, start, options_, symmetry_options_,
                                                weight);
    ImageResiduals residuals = Pairs(cost->NumPairs());
    if (residuals.count == 0) {
      residuals.constant_cost = weight * options_.asymmetry_cost;
    } else {
      residuals.functions.push_back(
          std::make_unique<ImageResidual>(std::move(cost), start.shape_exponents));
    }
    return residuals;
  }

  double ComparedCost(const Landmark& landmark) const override { return asymmetry_.Cost(landmark); }

 private:
  TextureOptions options_;
  TextureAsymmetry asymmetry_;
};

class EdgeEvidence final : public ImageEvidence {
 public:
  EdgeEvidence(std::shared_ptr<const EdgeImage> image, const Camera& camera,
               const EdgeOptions& options)
      : image_(std::move(image)), camera_(camera), options_(options) {}

  ImageResiduals ResidualsAt(const Landmark& start, const Landmark* weighed_at,
                             double weight) const override {
    auto cost = std::make_unique<EdgeCost>(image_, camera_, start, options_);
    const double support =
        weighed_at ? EdgeCost(image_, camera_, *weighed_at, options_).Support(*weighed_at)
                   : cost->Support(start);
    cost->Weigh(weight * support * support);
    ImageResiduals residuals{"edges", "no_edge_point_counts", {}, 1, cost->ConstantCost()};
    if (cost->NumPoints() > 0) {
      residuals.functions.push_back(
          std::make_unique<ImageResidual>(std::move(cost), start.shape_exponents));
    }
    return residuals;
  }

  std::unique_ptr<const LandmarkCost> CostNear(const Landmark& start) const override {
    return std::make_unique<EdgeCost>(image_, camera_, start, options_);
  }

 private:
  std::shared_ptr<const EdgeImage> image_;
  Camera camera_;
  EdgeOptions options_;
};

}  // namespace

std::shared_ptr<const ImageEvidence> MakeSymmetryEvidence(
    std::shared_ptr<const SymmetryImage> image, const Camera& camera,
    const SymmetryOptions& options, double sigma) {
  return std::make_shared<SymmetryEvidence>(std::move(image), camera, options, sigma);
}

std::shared_ptr<const ImageEvidence> MakeAsymmetryEvidence(
    std::shared_ptr<const SymmetryImage> image, const Camera& camera, const TextureOptions& options,
    const SymmetryOptions& symmetry_options) {
  return std::make_shared<AsymmetryEvidence>(std::move(image), camera, options, symmetry_options);
}

std::shared_ptr<const ImageEvidence> MakeEdgeEvidence(std::shared_ptr<const EdgeImage> image,
                                                      const Camera& camera,
                                                      const EdgeOptions& options) {
  return std::make_shared<EdgeEvidence>(std::move(image), camera, options);
}

}  // namespace soslam
