// SPDX-License-Identifier: BSD-3-Clause
#include "constraints/edges_on_surface.h"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

#include "geometry/mirror_mapping.h"
#include "support/facing_view.h"

namespace soslam {
namespace {

// Pixels around where the landmark's centre is seen, so that most of their rays meet it.
std::vector<Eigen::Vector2d> PixelsOn(const Landmark& landmark, int count) {
  const Eigen::Vector2d middle = *TestCamera().Project(landmark.Centre());
  std::vector<Eigen::Vector2d> pixels;
  for (int i = 0; i < count; ++i) pixels.emplace_back(middle + RandomVector(-60, 60).head<2>());
  return pixels;
}

TEST(EdgesOnSurface, NearestIsTheNearestInSpace) {
  for (int i = 0; i < 20; ++i) {
    const Landmark landmark = FacingView().LandmarkInCamera();
    const std::vector<Eigen::Vector2d> pixels = PixelsOn(landmark, 1 + 7 * i);
    const EdgesOnSurface edges(TestCamera(), landmark, pixels);
    const VisibleSurface surface(TestCamera(), landmark);
    const Eigen::Vector3d point = RandomVector(-1, 1).cwiseProduct(landmark.half_axes);
    double least = std::numeric_limits<double>::infinity();
    std::optional<Eigen::Vector2d> expected;
    for (const Eigen::Vector2d& pixel : pixels) {
      const auto edge = surface.FromPixel(pixel);
      if (!edge || (edge->in_object - point).norm() >= least) continue;
      least = (edge->in_object - point).norm();
      expected = pixel;
    }
    EXPECT_EQ(edges.Nearest(point), expected);
  }
}

// Wherever in batches they are: two edges that mirror each other are equally near.
TEST(EdgesOnSurface, OfSeveralTheFirstIsNearest) {
  Landmark landmark;
  landmark.frame_from_object.translation = {0.0, 0.0, 5.0};
  landmark.half_axes = {0.8, 0.6, 0.7};
  const Camera camera = TestCamera();
  const Eigen::Vector2d middle(camera.cx, camera.cy);
  const Eigen::Vector2d left = middle - Eigen::Vector2d(8.0, 0.0);
  const Eigen::Vector2d right = middle + Eigen::Vector2d(8.0, 0.0);
  const Eigen::Vector2d farther = middle + Eigen::Vector2d(32.0, 0.0);
  for (const size_t first : {0, 5, 31, 32, 60}) {
    for (const size_t second : {first + 1, first + 29, first + 32}) {
      std::vector<Eigen::Vector2d> pixels(100, farther);
      pixels[first] = left;
      pixels[second] = right;
      EXPECT_EQ(EdgesOnSurface(camera, landmark, pixels).Nearest({0.0, 0.0, -0.7}), left);
      std::swap(pixels[first], pixels[second]);
      EXPECT_EQ(EdgesOnSurface(camera, landmark, pixels).Nearest({0.0, 0.0, -0.7}), right);
    }
  }
}

TEST(EdgesOnSurface, NoneWithoutAnEdgeOnTheSurface) {
  const Landmark landmark = FacingView().LandmarkInCamera();
  EXPECT_EQ(EdgesOnSurface(TestCamera(), landmark, {}).Nearest(Eigen::Vector3d::Zero()),
            std::nullopt);
  const EdgesOnSurface beside(TestCamera(), landmark, {{-1e5, 0.0}});
  EXPECT_EQ(beside.Nearest(Eigen::Vector3d::Zero()), std::nullopt);
}

}  // namespace
}  // namespace soslam
