// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "soslam/base/error.h"
#include "soslam/dataset/calibration_file.h"
#include "soslam/image/distort_pixels.h"

namespace soslam {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::vector<Eigen::Vector2d> ImagePoints(const LensCamera& lens_camera,
                                         const std::vector<Eigen::Vector3d>& rays) {
  std::vector<Eigen::Vector2d> pixels;
  for (const Eigen::Vector3d& ray : rays) pixels.push_back(*lens_camera.camera.Project(ray));
  return DistortPixels(lens_camera.camera, lens_camera.distortion.value_or(Distortion()), pixels);
}

LensCamera MeanCamera(const std::vector<PlacedCamera>& cameras) {
  constexpr size_t kIntrinsics = 4, kCoefficients = 14;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(kIntrinsics + kCoefficients);
  for (const PlacedCamera& placed : cameras) {
    const Camera& camera = placed.camera.camera;
    std::vector<double> values =
        DistortionCoefficients(placed.camera.distortion.value_or(Distortion()));
    values.insert(values.begin(), {camera.fx, camera.fy, camera.cx, camera.cy});
    values.resize(kIntrinsics + kCoefficients, 0.0);
    mean += Eigen::VectorXd::Map(values.data(), mean.size()) / static_cast<double>(cameras.size());
  }
  const Camera& first = cameras.front().camera.camera;
  LensCamera camera = {{first.width, first.height, mean[0], mean[1], mean[2], mean[3]}, {}};
  const auto lens = DistortionOfCoefficients({mean.data() + kIntrinsics, kCoefficients});
  if (lens != Distortion()) camera.distortion = lens;
  return camera;
}

}  // namespace

double UnseenDisplacementPx(const Camera& camera) {
  return std::max(1.0, std::max(camera.width, camera.height) / 640.0);
}

double DisplacementPx(const LensCamera& one, const LensCamera& other) {
  constexpr int kIntervals = 16;
  if (one.camera.width != other.camera.width || one.camera.height != other.camera.height) {
    return kInfinity;
  }
  std::vector<Eigen::Vector2d> grid;  // over the image, with its border
  for (int row = 0; row <= kIntervals; ++row) {
    for (int column = 0; column <= kIntervals; ++column) {
      grid.emplace_back(one.camera.width * column / double{kIntervals} - 0.5,
                        one.camera.height * row / double{kIntervals} - 0.5);
    }
  }
  std::vector<Eigen::Vector3d> rays;  // where the lens model has an inverse
  for (const auto& pixel :
       UndistortPixels(one.camera, one.distortion.value_or(Distortion()), grid)) {
    if (pixel) rays.push_back(one.camera.Ray(*pixel));
  }
  const std::vector<Eigen::Vector2d> pixels = ImagePoints(one, rays);
  const std::vector<Eigen::Vector2d> other_pixels = ImagePoints(other, rays);
  double squares = 0.0;
  for (size_t i = 0; i < rays.size(); ++i) squares += (pixels[i] - other_pixels[i]).squaredNorm();
  const double displacement_px = std::sqrt(squares / static_cast<double>(rays.size()));
  return std::isfinite(displacement_px) ? displacement_px : kInfinity;
}

LensCamera OneCamera(const std::vector<PlacedCamera>& cameras, const std::string& remedy,
                     std::vector<Finding>* findings) {
  const PlacedCamera& first = cameras.front();
  const auto is_first = [&](const PlacedCamera& placed) { return placed.camera == first.camera; };
  if (std::ranges::all_of(cameras, is_first)) return first.camera;
  const LensCamera mean = MeanCamera(cameras);
  const auto displacement_px = [&](const PlacedCamera& placed) {
    return DisplacementPx(mean, placed.camera);
  };
  const auto farthest = std::ranges::max_element(cameras, {}, displacement_px);
  const double largest_px = displacement_px(*farthest);
  const Camera& other = farthest->camera.camera;
  if (other.width != mean.camera.width || other.height != mean.camera.height) {
    throw InputError(fmt::format(
        "{}: is another camera, of {} x {} pixels, than the first, of {} "
        "x {}; expected one for all images ({})",
        farthest->place, other.width, other.height, mean.camera.width, mean.camera.height, remedy));
  }
  const double limit_px = UnseenDisplacementPx(mean.camera);
  if (largest_px >= limit_px) {
    throw InputError(
        fmt::format("{}: is another camera than that of the other images: image "
                    "points are {:.1f} px (root mean square) from those of the mean camera "
                    "(fx {:.2f}, not {:.2f}); expected one for all images, to {:.2g} px ({})",
                    farthest->place, largest_px, other.fx, mean.camera.fx, limit_px, remedy));
  }
  findings->push_back(
      {"camera_per_image", Severity::kWarning,
       fmt::format("{}: images have cameras of their own; their mean (fx {:.2f}), which is used "
                   "for all, displaces image points by {:.2f} px (root mean square)",
                   first.place, mean.camera.fx, largest_px),
       "one camera for all images",
       "a reconstruction with a camera for each image, or photos that EXIF turns in several ways",
       fmt::format("nothing where boxes are less accurate than that; otherwise {}", remedy)});
  return mean;
}

}  // namespace soslam
