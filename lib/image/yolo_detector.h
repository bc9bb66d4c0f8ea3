// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <vector>

#include "image/detector_options.h"
#include "image/yolo_output.h"

namespace soslam {

// A YOLO network in an ONNX file. Not to be shared between threads.
class YoloDetector {
 public:
  // Throws InputError when the file is missing or is not a network that OpenCV can load.
  YoloDetector(const std::filesystem::path& network, int classes, const DetectorOptions& options);

  // Detections in an image (CV_8UC3, blue green red), by descending score. Boxes are in pixels of
  // the image, cut at its border. Throws InputError when the network does not take an input of the
  // size in the options, or its output has another layout; NumericalError for a box or score that
  // is not finite.
  std::vector<YoloDetection> Detect(const cv::Mat& image);

 private:
  cv::Mat Forward(const cv::Mat& input);

  std::string name_;
  int classes_;
  DetectorOptions options_;
  cv::dnn::Net network_;
};

// Loads a network and runs it on a uniform image in a child process. Throws InputError when OpenCV
// crashes: it trusts what network files state about their layers. Must not be called while other
// threads are running.
void CheckNetworkRuns(const std::filesystem::path& network, int classes,
                      const DetectorOptions& options);

}  // namespace soslam
