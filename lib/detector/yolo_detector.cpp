// SPDX-License-Identifier: BSD-3-Clause
#include "detector/yolo_detector.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>

#include "base/error.h"
#include "base/file_kind.h"
#include "base/run_log.h"
#include "detector/letterbox.h"

namespace soslam {
namespace {

// What OpenCV has to say, in one line.
std::string Reason(const cv::Exception& error) {
  std::string text = error.err;
  std::replace(text.begin(), text.end(), '\n', ' ');
  const size_t begin = text.find_first_not_of("> ");
  const size_t end = text.find_last_not_of("> ");
  return begin == text.npos ? "no reason given" : text.substr(begin, end - begin + 1);
}

cv::dnn::Net LoadNetwork(const std::filesystem::path& path) {
  if (!IsFile(path) || !std::ifstream(path)) {
    throw InputError(path.string() + ": cannot be read; expected an ONNX file");
  }
  NoteInput(path);
  // OpenCV prints what it also throws.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    cv::dnn::Net network = cv::dnn::readNetFromONNX(path.string());
    network.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    network.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
    return network;
  } catch (const cv::Exception& error) {
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
  const Letterbox letterbox(image.size(), {options_.input_width, options_.input_height});
  const cv::Mat output = Forward(letterbox.Fit(image));
  const auto candidates =
      ReadYoloOutput(output, options_.output_layout, classes_, options_.min_score, name_);
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
  } catch (const cv::Exception& error) {
    throw InputError(fmt::format("{}: cannot be run on an input of {} x {} pixels: {}", name_,
                                 input.cols, input.rows, Reason(error)));
  }
  if (outputs.size() != 1) {
    throw InputError(fmt::format("{}: has {} outputs; expected 1", name_, outputs.size()));
  }
  return outputs.front();
}

}  // namespace soslam
