// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "synthesis/scene.h"

namespace soslam {

// A robot's drive over a level floor, forward with gentle turns, past `objects` solids of random
// size, position and yaw, with shapes drawn from `shapes`. Objects do not touch; each has its own
// label and is in sight in at least three frames (in all, if there are fewer). Without noise; the
// caller may set it. The same arguments give the same scene. Throws SettingsError when a number is
// below one, or if there is no room for an object.
Scene RandomScene(int seed, int objects, int frames,
                  const std::vector<Shape>& shapes = {Shape::kEllipsoid});

}  // namespace soslam
