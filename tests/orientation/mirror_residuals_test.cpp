// SPDX-License-Identifier: BSD-3-Clause
#include "orientation/mirror_residuals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "constraints/symmetry.h"
#include "support/facing_view.h"
#include "support/landmark_costs.h"

namespace soslam {
namespace {

// More than a batch, and not a multiple of one; some beside the body.
std::vector<Eigen::Vector2d> SomePixels() {
  std::vector<Eigen::Vector2d> pixels;
  for (int y = 150; y < 340; y += 23) {
    for (int x = 220; x < 430; x += 31) pixels.emplace_back(x + 0.4, y + 0.7);
  }
  return pixels;
}

LandmarkModel PairByPair(Descriptor kind, const SymmetryImage& image, const Landmark& landmark,
                         double mirror_plane, double scale) {
  const SymmetryDescriptor descriptor(kind, image, TestCamera(), landmark);
  LandmarkModel sum;
  for (const Eigen::Vector2d& pixel : SomePixels()) {
    const auto pair = descriptor.Evaluate(pixel, std::nullopt, true, mirror_plane);
    if (!pair) {
      sum.cost += 0.5;
      continue;
    }
    const double norm = std::hypot(pair->residual, scale);
    sum.Add(pair->residual / norm,
            scale * scale / (norm * norm * norm) * pair->jacobian.transpose());
  }
  return sum;
}

TEST(MirrorResiduals, SayWhatTheDescriptorSaysPairByPair) {
  SymmetryImage image = SparseImage();
  for (int y = 0; y < image.maps.grey.rows; ++y) {
    for (int x = 0; x < image.maps.grey.cols; ++x) {
      image.maps.grey.at<unsigned char>(y, x) = static_cast<unsigned char>((7 * x + 3 * y) % 256);
    }
  }
  const double weight = 0.6;
  int with_a_slope = 0;
  for (const double p : {1.0, 1.3, 2.0}) {
    for (const double mirror_plane : {0.0, -0.2}) {
      for (int i = 0; i < 20; ++i) {
        const Landmark landmark = WithShape(FacingView().LandmarkInCamera(), p);
        for (const auto kind : {Descriptor::kGrey, Descriptor::kDistanceTransform}) {
          const bool is_grey = kind == Descriptor::kGrey;
          const double scale = is_grey ? 0.2 : 5.0;
          const MirrorResiduals residuals(is_grey ? image.maps.grey : image.maps.distance,
                                          is_grey ? 1.0 / 255.0 : 1.0, TestCamera(), SomePixels(),
                                          mirror_plane, scale);
          LandmarkModel found, expected;
          residuals.AddTo(landmark, weight, &found);
          expected = PairByPair(kind, image, landmark, mirror_plane, scale);
          expected.cost *= weight;
          expected.gradient *= weight;
          expected.information *= weight;
          ExpectSameModels(found, expected);
          EXPECT_NEAR(weight * residuals.Value(landmark), expected.cost, 1e-9);
          with_a_slope += expected.gradient.norm() > 1e-3 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(with_a_slope, 100);
}

}  // namespace
}  // namespace soslam
