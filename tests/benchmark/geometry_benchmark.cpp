// SPDX-License-Identifier: BSD-3-Clause
// What constraints and evaluation are made of: support function, mirror mapping, IoU.
#include <benchmark/benchmark.h>

#include "geometry/iou.h"
#include "geometry/mirror_mapping.h"
#include "geometry/support_function.h"

namespace soslam {
namespace {

const Camera kCamera = {640, 480, 520.0, 520.0, 319.5, 239.5};

// Three metres ahead, turned against the line of sight.
Landmark AheadOfCamera(double shape_exponent) {
  return {{UprightRotation({0.0, -0.9, -0.435889894354}, 0.6), {0.1, 0.2, 3.0}},
          {0.3, 0.4, 0.5},
          shape_exponent};
}

// In the benchmarks with an argument, it is a hundred times the shape exponent.
double ShapeExponent(const benchmark::State& state) {
  return 0.01 * static_cast<double>(state.range(0));
}

void Shapes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("p_percent")->Arg(100)->Arg(125)->Arg(200);
}

void Support(benchmark::State& state) {
  const Landmark landmark = AheadOfCamera(ShapeExponent(state));
  Eigen::Vector3d direction(0.3, -0.5, 0.8);
  for (auto _ : state) {
    benchmark::DoNotOptimize(direction);
    benchmark::DoNotOptimize(
        SupportFunction(landmark.half_axes, landmark.shape_exponent, direction));
  }
}
BENCHMARK(Support)->Name("geometry/support_function")->Apply(Shapes);

// A pixel to the surface, to its mirror image, and back to a pixel: eq. (13), (14).
void MirrorPixel(benchmark::State& state) {
  const VisibleSurface surface(kCamera, AheadOfCamera(ShapeExponent(state)));
  Eigen::Vector2d pixel(345.0, 265.0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(pixel);
    const auto point = surface.FromPixel(pixel);
    if (!point) {
      state.SkipWithError("the pixel's ray misses");
      return;
    }
    benchmark::DoNotOptimize(surface.ToPixel(surface.MirrorImage(*point)));
  }
}
BENCHMARK(MirrorPixel)->Name("geometry/mirror_pixel")->Apply(Shapes);

// IoU of two boxes that are rotated against each other.
void Iou(benchmark::State& state) {
  Landmark one = AheadOfCamera(kEllipsoidExponent);
  const Landmark other = RotatedAboutZ(one, 0.4);
  one.frame_from_object.translation.x() += 0.1;
  for (auto _ : state) {
    benchmark::DoNotOptimize(one);
    benchmark::DoNotOptimize(BoxIou(one, other));
  }
}
BENCHMARK(Iou)->Name("geometry/iou");

}  // namespace
}  // namespace soslam
