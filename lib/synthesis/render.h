// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core.hpp>

#include "synthesis/scene.h"

namespace soslam {

// The camera's view of the scene, CV_8UC3 in blue, green, red, by casting 3 x 3 rays per pixel:
// soft light from above, no reflections, shadows only where objects touch their plane. Without
// noise.
cv::Mat RenderFrame(const Scene& scene, const Rigid3d& world_from_camera);

}  // namespace soslam
