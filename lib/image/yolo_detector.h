// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <vector>

#include "geometry/box.h"
#include "image/detector_options.h"
#include "image/onnx_header.h"
#include "image/yolo_output.h"

namespace soslam {

// An ONNX file, and what it states about its network.
struct NetworkFile {
  std::string name;  // path, for messages
  std::string bytes;
  OnnxHeader header;

  // Width and height of the input; 0 where the file does not fix them.
  cv::Size InputSize() const;
};

// Throws InputError, naming the file, when it is missing or damaged, or holds a network that cannot
// detect objects in one image, or that this version of OpenCV is known not to run.
NetworkFile ReadNetworkFile(const std::filesystem::path& path);

// A YOLO network that OpenCV has loaded. Not to be shared between threads.
class YoloNetwork {
 public:
  // `file` must outlive this. Throws InputError when OpenCV cannot load it.
  explicit YoloNetwork(const NetworkFile& file);

  // The output for an image of the input's size (CV_8UC3, blue green red): the only one of three
  // dimensions; others, as those of masks, are ignored. Throws InputError when OpenCV cannot run
  // the network on this size.
  cv::Mat Forward(const cv::Mat& input, PixelValues pixel_values);

 private:
  bool RepeatStrides();
  [[noreturn]] void Refuse(const std::string& what, const std::exception& error) const;

  const NetworkFile& file_;
  cv::dnn::Net network_;
  bool has_repeated_ = false;  // RepeatStrides was tried
};

// Fits an image into the fixed input of a network without changing its proportions: scaled to the
// largest size that fits, centred, and padded with grey.
class Letterbox {
 public:
  Letterbox(const cv::Size& image, const cv::Size& input);

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
void CheckBoxesArePossible(const BoxTally& tally, const YoloFormat& format,
                           const std::string& network);

// A YOLO network that finds objects in images. Not to be shared between threads.
class YoloDetector {
 public:
  // `file` must outlive this. `groups`: see WithoutOverlaps. Throws InputError when OpenCV cannot
  // load the network.
  YoloDetector(const NetworkFile& file, const YoloFormat& format, std::vector<int> groups,
               const DetectorOptions& options);

  // Detections in an image (CV_8UC3, blue green red), by descending score. Boxes are in pixels of
  // the image, cut at its border. Throws InputError when the network does not have the format;
  // NumericalError for a box or score that is not finite.
  std::vector<YoloDetection> Detect(const cv::Mat& image);

  // Boxes found so far.
  const BoxTally& tally() const { return tally_; }

 private:
  std::string name_;
  YoloNetwork network_;
  YoloFormat format_;
  std::vector<int> groups_;
  DetectorOptions options_;
  BoxTally tally_;
};

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
