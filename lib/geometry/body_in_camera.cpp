// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/body_in_camera.h"

#include "base/wide_loops.h"

namespace soslam {
namespace {

// Rotates the rays (x, y, 1) into the object frame.
SOSLAM_MULTIVERSION void TurnBack(const Eigen::Matrix3d& rotation, const double* x, const double* y,
                                  BatchOfVectors* rays) {
  for (int i = 0; i < 3; ++i) {
    const double by_x = rotation(0, i), by_y = rotation(1, i), by_z = rotation(2, i);
    for (int at = 0; at < kBatchSize; at += 4) {
      Four four_x, four_y;
      Load(x + at, &four_x);
      Load(y + at, &four_y);
      Store(by_x * four_x + by_y * four_y + by_z, (*rays)[i].data() + at);
    }
  }
}

}  // namespace

BodyInCamera::BodyInCamera(const Landmark& landmark_in_camera)
    : rotation(landmark_in_camera.frame_from_object.rotation.toRotationMatrix()),
      centre(landmark_in_camera.Centre()),
      camera_in_object(-(rotation.transpose() * centre)),
      surface(landmark_in_camera.half_axes, landmark_in_camera.shape_exponent) {}

void BodyInCamera::Meet(const double* x, const double* y, RayBatch* rays) const {
  TurnBack(rotation, x, y, &rays->direction);
  surface.Meet(camera_in_object, rays);
}

}  // namespace soslam
