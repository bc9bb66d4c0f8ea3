// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "soslam/geometry/box.h"
#include "soslam/image/detector_options.h"
#include "soslam/image/network.h"
#include "soslam/image/network_output.h"

namespace soslam {

// Fits an image into the fixed input of a network: without changing its proportions, scaled to the
// largest size that fits, centred, and padded with grey; or stretched to the size of the input.
class Letterbox {
 public:
  Letterbox(const cv::Size& image, const cv::Size& input, bool is_stretched = false);

  // `image` is CV_8UC3 of the size given above; the result has the size of the network's input.
  cv::Mat Fit(const cv::Mat& image) const;

  // Converts a box from pixels of the network's input, measured from its outer corner, to pixels of
  // the image, cut at its border.
  Box ToImage(const Box& box_in_input) const;

 private:
  cv::Size image_;
  cv::Size input_;
  cv::Rect filled_;  // the part of the input that the image fills
};

inline constexpr int kTinySide = 4;  // px of a network's input: no network detects such objects

// Numbers of boxes that a network has found: all, those with both sides below kTinySide, and others
// outside of the image, in the padding.
struct BoxTally {
  int boxes = 0;
  int tiny = 0;
  int outside = 0;

  BoxTally& operator+=(const BoxTally& other) {
    boxes += other.boxes;
    tiny += other.tiny;
    outside += other.outside;
    return *this;
  }
};

// Throws InputError, naming the network and the format, if nearly all boxes are tiny or outside of
// their image: the network has another format.
void CheckBoxesArePossible(const BoxTally& tally, const NetworkFormat& format,
                           const std::string& network);

// A network that finds objects in images. Not to be shared between threads.
class Detector {
 public:
  // `file` must outlive this. `groups`: see WithoutOverlaps. Throws InputError when the
  // backend cannot load the network.
  Detector(const NetworkFile& file, const NetworkFormat& format, std::vector<int> groups,
           const DetectorOptions& options);

  // Detections in an image (CV_8UC3, blue green red), by descending score. Boxes are in pixels of
  // the image, cut at its border. Throws InputError when the network does not have the format;
  // NumericalError for a box or score that is not finite.
  std::vector<NetworkDetection> Detect(const cv::Mat& image);

  // Boxes found so far.
  const BoxTally& tally() const { return tally_; }

 private:
  std::string name_;
  std::unique_ptr<Network> network_;
  NetworkFormat format_;
  std::vector<int> groups_;
  DetectorOptions options_;
  BoxTally tally_;
};

// The size for an input of a network that takes any: that of the images, in multiples of 32 pixels
// a side, scaled to have at least the area that the network was made for, and at most that or 0.5
// megapixels.
cv::Size ImageShapedInput(const cv::Size& image, const cv::Size& own);

// Finds what a network takes and returns: from its file, from its outputs for a uniform image, and
// from the options, where they are not "auto". `image` is the size of the first image. Throws
// InputError for a network that does not have `classes` classes, that has an unknown layout or that
// the backend cannot run; SettingsError for an input with a width and no height, and for what the
// network does not show and no option says. Must not be called while other threads are running.
NetworkFormat FindFormat(const NetworkFile& file, int classes, const DetectorOptions& options,
                         const cv::Size& image);

}  // namespace soslam
