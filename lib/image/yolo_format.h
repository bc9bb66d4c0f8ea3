// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>

#include "image/detector_options.h"
#include "image/yolo_network.h"

namespace soslam {

// The size for an input of a network that takes any: that of the images, in multiples of 32 pixels
// a side, scaled to have at least the area that the network was made for, and at most that or 0.5
// megapixels.
cv::Size ImageShapedInput(const cv::Size& image, const cv::Size& own);

// Finds what a network takes and returns: from its file, from its output for a uniform image, and
// from the options, where they are not "auto". `image` is the size of the first image. Throws
// InputError for a network that does not have `classes` classes, that has an unknown layout or that
// OpenCV cannot run; SettingsError for an input with a width and no height. Must not be called
// while other threads are running.
YoloFormat FindFormat(const NetworkFile& file, int classes, const DetectorOptions& options,
                      const cv::Size& image);

}  // namespace soslam
