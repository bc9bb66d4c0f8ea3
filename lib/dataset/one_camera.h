// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "dataset/calibration_file.h"
#include "model/finding.h"

namespace soslam {

// The camera of an image, as a file with several cameras has it.
struct PlacedCamera {
  std::string place;  // for messages
  LensCamera camera;
};

// Distance in pixels of the two image points of a ray, root mean square over the rays of the whole
// image. Infinite for images of different sizes.
double DisplacementPx(const LensCamera& one, const LensCamera& other);

// The one camera of all images, of which there is one at least: the mean of the given ones. It is a
// finding if they are not equal. Throws InputError, naming the place and `remedy`, if one of them
// displaces image points by a pixel or more, which is the least standard deviation of a box edge.
LensCamera OneCamera(const std::vector<PlacedCamera>& cameras, const std::string& remedy,
                     std::vector<Finding>* findings);

}  // namespace soslam
