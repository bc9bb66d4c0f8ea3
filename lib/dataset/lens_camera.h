// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>

#include "geometry/camera.h"
#include "geometry/distortion.h"

namespace soslam {

// A pinhole camera, y down, and what its lens does to images and boxes.
struct LensCamera {
  Camera camera;
  std::optional<Distortion> distortion;  // none: nothing
};

// The lens that a file describes by the name of a model and its coefficients, in OpenCV's order: 4,
// 5, 8, 12 or 14 of them. Tools name models differently ("plumb_bob", "radtan", "OPENCV", "rational
// polynomial"); capitals do not count, nor what stands between words. No coefficients are no lens.
// Throws InputError, naming `place`, for a model that is not OpenCV's (fisheye, equidistant,
// omnidirectional, ...), and for a number of coefficients that the model does not have.
std::optional<Distortion> ParseLens(const std::string& model, std::span<const double> coefficients,
                                    const std::string& place);

}  // namespace soslam
