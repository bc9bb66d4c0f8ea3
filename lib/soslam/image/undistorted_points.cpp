// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/undistorted_points.h"

#include "soslam/image/distort_pixels.h"

namespace soslam {

std::optional<Eigen::Vector2d> UndistortedPixel(const Sequence& sequence,
                                                const PointObservation& observation) {
  if (!sequence.image_distortion) return observation.pixel;
  return UndistortPixels(sequence.camera, *sequence.image_distortion, {observation.pixel}).front();
}

PointObservation StoredObservation(const Sequence& sequence, const Frame& frame,
                                   const Eigen::Vector2d& pixel) {
  const auto& distortion = sequence.image_distortion;
  return {frame.id, distortion
                        ? DistortPixels(sequence.CameraOf(frame), *distortion, {pixel}).front()
                        : pixel};
}

std::vector<MapPoint> WithoutDistortion(const Sequence& sequence, std::vector<MapPoint> points) {
  for (MapPoint& point : points) {
    std::erase_if(point.observations, [&](PointObservation& observation) {
      const auto pixel = UndistortedPixel(sequence, observation);
      if (pixel) observation.pixel = *pixel;
      return !pixel;
    });
  }
  return points;
}

}  // namespace soslam
