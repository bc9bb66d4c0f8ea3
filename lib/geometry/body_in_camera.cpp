// SPDX-License-Identifier: BSD-3-Clause
#include "geometry/body_in_camera.h"

namespace soslam {

BodyInCamera::BodyInCamera(const Landmark& landmark_in_camera)
    : rotation(landmark_in_camera.frame_from_object.rotation.toRotationMatrix()),
      centre(landmark_in_camera.Centre()),
      camera_in_object(-(rotation.transpose() * centre)),
      surface(landmark_in_camera.half_axes, landmark_in_camera.shape_exponent) {}

void BodyInCamera::Meet(const double* x, const double* y, RayBatch* rays) const {
  for (int i = 0; i < 3; ++i) {
    const Eigen::Map<const Batch> along_x(x), along_y(y);
    rays->direction[static_cast<size_t>(i)] =
        rotation(0, i) * along_x + rotation(1, i) * along_y + rotation(2, i);
  }
  surface.Meet(camera_in_object, rays);
}

}  // namespace soslam
