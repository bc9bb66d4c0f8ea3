// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>

#include "soslam/geometry/angles.h"
#include "soslam/geometry/landmark.h"
#include "soslam/model/appearance.h"
#include "soslam/model/sequence.h"

namespace soslam {

// What a picture tells that is most likely of an object seen from an azimuth (rad), and `weight`
// times two less likely, as a negative logarithm, from the opposite one.
inline BoxAppearance PictureFrom(double azimuth, double weight = 5.0) {
  BoxAppearance appearance;
  for (int i = 0; i < kAzimuthBins; ++i) {
    const double angle = 360.0 / kAzimuthBins * kRadPerDeg * i;
    appearance.azimuth_costs[i] = static_cast<float>(weight * (1.0 - std::cos(angle - azimuth)));
  }
  appearance.azimuth_costs.array() -= appearance.azimuth_costs.minCoeff();
  return appearance;
}

// The azimuth (rad) from which a camera at the origin sees a landmark along a ray.
inline double AzimuthAlong(const Eigen::Vector3d& ray, const Landmark& landmark_in_camera) {
  const Eigen::Vector3d towards =
      landmark_in_camera.frame_from_object.rotation.conjugate() * Eigen::Vector3d(-ray);
  return std::atan2(towards.y(), towards.x());
}

// Gives all detections pictures of their true landmarks, turned by an angle (rad) about their z
// axes.
inline void AddTruePictures(Sequence* sequence, double turn = 0.0, double weight = 5.0) {
  for (Detection& detection : sequence->detections) {
    const Landmark landmark = RotatedAboutZ(*TrueLandmarkInCamera(*sequence, detection), turn);
    const Eigen::Vector3d ray = sequence->CameraOf(detection).Ray(detection.box.Centre());
    detection.appearance =
        std::make_shared<const BoxAppearance>(PictureFrom(AzimuthAlong(ray, landmark), weight));
  }
}

}  // namespace soslam
