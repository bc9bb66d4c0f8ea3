// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>

#include "geometry/camera.h"
#include "geometry/distortion.h"

namespace soslam {

// A pinhole camera, y down, and the distortion of its lens.
struct LensCamera {
  Camera camera;
  std::optional<Distortion> distortion;  // none: no distortion
};

// Distortion from the name of a model and its coefficients, in OpenCV's order: 4, 5, 8, 12 or 14 of
// them. Tools name models differently ("plumb_bob", "radtan", "OPENCV", "rational polynomial");
// capitals and word separators are ignored. None without coefficients. Throws InputError, naming
// `place`, for a model that is not OpenCV's (fisheye, equidistant, omnidirectional, ...), and for a
// number of coefficients that the model does not have.
std::optional<Distortion> ParseLens(const std::string& model, std::span<const double> coefficients,
                                    const std::string& place);

}  // namespace soslam
