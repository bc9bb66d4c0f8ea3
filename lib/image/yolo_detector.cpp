// SPDX-License-Identifier: BSD-3-Clause
#include "image/yolo_detector.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <new>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/own_process.h"
#include "base/run_log.h"
#include "image/letterbox.h"
#include "image/onnx_check.h"

namespace soslam {
namespace {

// OpenCV's error message, in one line.
std::string Reason(const std::exception& error) {
  const auto* of_opencv = dynamic_cast<const cv::Exception*>(&error);
  std::string text = of_opencv != nullptr ? of_opencv->err : error.what();
  std::replace(text.begin(), text.end(), '\n', ' ');
  const size_t begin = text.find_first_not_of("> ");
  const size_t end = text.find_last_not_of("> ");
  return begin == text.npos ? "no reason given" : text.substr(begin, end - begin + 1);
}

// Throws std::bad_alloc if `error` is that, or OpenCV's equivalent: the network file is not at
// fault.
void RethrowOutOfMemory(const std::exception& error) {
  const auto* of_opencv = dynamic_cast<const cv::Exception*>(&error);
  if ((of_opencv != nullptr && of_opencv->code == cv::Error::StsNoMem) ||
      dynamic_cast<const std::bad_alloc*>(&error) != nullptr) {
    throw std::bad_alloc();
  }
}

std::string ReadNetwork(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!IsFile(path) || !stream) {
    throw InputError(path.string() + ": cannot be read; expected an ONNX file");
  }
  RecordInput(path);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  CheckOnnx(bytes, path.string());
  return bytes;
}

cv::dnn::Net LoadNetwork(const std::filesystem::path& path) {
  const std::string bytes = ReadNetwork(path);
  // OpenCV prints the errors that it throws.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    cv::dnn::Net network = cv::dnn::readNetFromONNX(bytes.data(), bytes.size());
    network.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    network.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    return network;
  } catch (const std::exception& error) {  // from OpenCV or its libraries
    RethrowOutOfMemory(error);
    throw InputError(fmt::format("{}: is not an ONNX network that OpenCV {} can load: {}",
                                 path.string(), CV_VERSION, Reason(error)));
  }
}

}  // namespace

YoloDetector::YoloDetector(const std::filesystem::path& network, int classes,
                           const DetectorOptions& options)
    : name_(network.string()),
      classes_(classes),
      options_(options),
      network_(LoadNetwork(network)) {}

std::vector<YoloDetection> YoloDetector::Detect(const cv::Mat& image) {
  const cv::Size input(options_.input_width, options_.input_height);
  const Letterbox letterbox(image.size(), input);
  const cv::Mat output = Forward(letterbox.Fit(image));
  const auto candidates =
      ReadYoloOutput(output, options_.output_layout, input, classes_, options_.min_score, name_);
  std::vector<YoloDetection> detections;
  for (YoloDetection detection : WithoutOverlaps(candidates, classes_, options_.max_overlap)) {
    detection.box = letterbox.ToImage(detection.box);
    if (detection.box.Width() > 0.0 && detection.box.Height() > 0.0) {
      detections.push_back(detection);
    }
  }
  return detections;
}

cv::Mat YoloDetector::Forward(const cv::Mat& input) {
  const bool is_unit = options_.pixel_values == PixelValues::kRgbUnit;
  const cv::Mat blob = cv::dnn::blobFromImage(input, is_unit ? 1.0 / 255.0 : 1.0, cv::Size(),
                                              cv::Scalar(), is_unit /* swap blue and red */);
  std::vector<cv::Mat> outputs;
  try {
    network_.setInput(blob);
    network_.forward(outputs, network_.getUnconnectedOutLayersNames());
  } catch (const std::exception& error) {  // from OpenCV or its libraries
    RethrowOutOfMemory(error);
    throw InputError(fmt::format("{}: cannot be run on an input of {} x {} pixels: {}", name_,
                                 input.cols, input.rows, Reason(error)));
  }
  if (outputs.size() != 1) {
    throw InputError(fmt::format("{}: has {} outputs; expected 1", name_, outputs.size()));
  }
  return outputs.front();
}

void CheckNetworkRuns(const std::filesystem::path& network, int classes,
                      const DetectorOptions& options) {
  const auto crash = CrashInOwnProcess([&] {
    const cv::Mat image(options.input_height, options.input_width, CV_8UC3, cv::Scalar::all(0));
    YoloDetector(network, classes, options).Detect(image);
  });
  if (!crash) return;
  throw InputError(fmt::format(
      "{}: OpenCV {} ends with {} when it loads or runs this network; expected an intact ONNX file",
      network.string(), CV_VERSION, *crash));
}

}  // namespace soslam
