// SPDX-License-Identifier: BSD-3-Clause
#include "image/yolo_detector.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/paths.h"
#include "base/process.h"
#include "base/run_log.h"
#include "image/onnx_check.h"

namespace soslam {
namespace {

// One axis: from the input to the image, where the first pixel's centre is 0.
double ToImageAxis(double in_input, int start, int filled, int image) {
  const double from_corner = (in_input - start) * image / filled;
  return std::clamp(from_corner, 0.0, static_cast<double>(image)) - 0.5;
}

}  // namespace

Letterbox::Letterbox(const cv::Size& image, const cv::Size& input) : image_(image), input_(input) {
  const double scale = std::min(static_cast<double>(input.width) / image.width,
                                static_cast<double>(input.height) / image.height);
  const auto scaled = [&](int side) {
    return std::max(1, static_cast<int>(std::lround(scale * side)));
  };
  const cv::Size size(scaled(image.width), scaled(image.height));
  filled_ = {{(input.width - size.width) / 2, (input.height - size.height) / 2}, size};
}

cv::Mat Letterbox::Fit(const cv::Mat& image) const {
  constexpr int kGrey = 114;  // padding in the training of YOLO networks
  cv::Mat fitted(input_, CV_8UC3, cv::Scalar::all(kGrey));
  cv::Mat part = fitted(filled_);
  cv::resize(image, part, filled_.size(), 0.0, 0.0, cv::INTER_LINEAR);
  return fitted;
}

Box Letterbox::ToImage(const Box& box) const {
  return {ToImageAxis(box.x_min, filled_.x, filled_.width, image_.width),
          ToImageAxis(box.y_min, filled_.y, filled_.height, image_.height),
          ToImageAxis(box.x_max, filled_.x, filled_.width, image_.width),
          ToImageAxis(box.y_max, filled_.y, filled_.height, image_.height)};
}

namespace {

// The output as one row per candidate: cx cy w h, the objectness (not of layout v8), the class
// scores.
cv::Mat CandidateRows(const cv::Mat& output, YoloLayout layout, int classes,
                      const std::string& network) {
  const bool has_objectness = layout != YoloLayout::kV8;
  const int fields = (has_objectness ? 5 : 4) + classes;
  const std::vector<int> shape(output.size.p, output.size.p + output.dims);
  const size_t field_axis = has_objectness ? 2 : 1;
  if (shape.size() != 3 || shape[0] != 1 || shape[field_axis] != fields ||
      output.type() != CV_32FC1) {
    throw InputError(fmt::format(
        "{}: output has shape [{}]; expected {} of layout {} with {} classes", network,
        fmt::join(shape, ", "),
        has_objectness ? fmt::format("[1, N, {}]", fields) : fmt::format("[1, {}, N]", fields),
        kYoloLayoutNames[static_cast<int>(layout)], classes));
  }
  const cv::Mat rows(shape[1], shape[2], CV_32FC1, const_cast<uchar*>(output.data));
  return has_objectness ? rows : cv::Mat(rows.t());
}

constexpr int kYoloxStrides[] = {8, 16, 32};

// Number of cells of all grids of YOLOX over an input.
int YoloxCells(const cv::Size& input) {
  int cells = 0;
  for (const int stride : kYoloxStrides) cells += (input.width / stride) * (input.height / stride);
  return cells;
}

double LargestSide(const cv::Mat& rows) {
  double largest = 0.0;
  if (!rows.empty()) cv::minMaxLoc(rows.colRange(2, 4), nullptr, &largest);
  return largest;
}

// Converts boxes from cells of YOLOX's grids to pixels. The rows are grid by grid, the finest
// first, each row by row. Throws InputError for boxes that are in pixels already.
cv::Mat FromYoloxGrids(const cv::Mat& rows, const cv::Size& input, const std::string& network) {
  if (rows.rows != YoloxCells(input)) {
    throw InputError(fmt::format(
        "{}: output has {} candidates; expected {} of layout yolox for an input of {} x {} pixels",
        network, rows.rows, YoloxCells(input), input.width, input.height));
  }
  constexpr double kMostLogCells = 20.0;
  if (LargestSide(rows) > kMostLogCells) {
    throw InputError(fmt::format(
        "{}: the largest side of a box in the output is {:.2f}; expected logarithms, of at most {} "
        "(YOLOX that was exported with --decode_in_inference has pixels: output_layout = v5)",
        network, LargestSide(rows), kMostLogCells));
  }
  cv::Mat decoded = rows.clone();
  int index = 0;
  for (const int stride : kYoloxStrides) {
    const int columns = input.width / stride;
    const int cells = columns * (input.height / stride);
    const auto pixels = static_cast<float>(stride);
    for (int cell = 0; cell < cells; ++cell, ++index) {
      const int cell_column = cell % columns;
      const int cell_row = cell / columns;
      float* row = decoded.ptr<float>(index);
      row[0] = (row[0] + static_cast<float>(cell_column)) * pixels;
      row[1] = (row[1] + static_cast<float>(cell_row)) * pixels;
      row[2] = std::exp(row[2]) * pixels;
      row[3] = std::exp(row[3]) * pixels;
    }
  }
  return decoded;
}

// Throws InputError for YOLOX's candidates in cells, which would pass for tiny boxes: logarithms of
// widths and heights are small, whereas among that many boxes in pixels some are not.
void CheckInPixels(const cv::Mat& rows, const cv::Size& input, const std::string& network) {
  const double largest = LargestSide(rows);
  if (rows.rows != YoloxCells(input) || rows.empty() || largest >= kYoloxStrides[0]) return;
  throw InputError(fmt::format(
      "{}: the largest side of a box in the output is {:.2f}; expected pixels (YOLOX as it is "
      "published has logarithms: output_layout = yolox)",
      network, largest));
}

}  // namespace

std::vector<YoloDetection> ReadYoloOutput(const cv::Mat& output, YoloLayout layout,
                                          const cv::Size& input, int classes, double min_score,
                                          const std::string& network) {
  cv::Mat rows = CandidateRows(output, layout, classes, network);
  if (layout == YoloLayout::kV5) CheckInPixels(rows, input, network);
  if (layout == YoloLayout::kYolox) rows = FromYoloxGrids(rows, input, network);
  const int first_class = rows.cols - classes;
  const auto is_finite = [](float value) { return std::isfinite(value); };
  std::vector<YoloDetection> boxes;
  for (int i = 0; i < rows.rows; ++i) {
    const float* row = rows.ptr<float>(i);
    const float* best = std::max_element(row + first_class, row + rows.cols);
    const double score = layout == YoloLayout::kV8 ? *best : static_cast<double>(*best) * row[4];
    if (score < min_score) continue;
    if (!std::isfinite(score) || !std::all_of(row, row + 4, is_finite)) {
      throw NumericalError(fmt::format("{}: candidate {} of the output is not finite", network, i));
    }
    const double cx = row[0], cy = row[1], half_w = 0.5 * row[2], half_h = 0.5 * row[3];
    boxes.push_back({static_cast<int>(best - row) - first_class,
                     score,
                     {cx - half_w, cy - half_h, cx + half_w, cy + half_h}});
  }
  return boxes;
}

std::vector<YoloDetection> WithoutOverlaps(const std::vector<YoloDetection>& boxes, int classes,
                                           double max_overlap) {
  std::vector<YoloDetection> kept;
  for (int class_index = 0; class_index < classes; ++class_index) {
    std::vector<YoloDetection> of_class;
    std::vector<cv::Rect2d> rectangles;
    std::vector<float> scores;
    for (const YoloDetection& box : boxes) {
      if (box.class_index != class_index) continue;
      of_class.push_back(box);
      rectangles.emplace_back(box.box.x_min, box.box.y_min, box.box.Width(), box.box.Height());
      scores.push_back(static_cast<float>(box.score));
    }
    std::vector<int> indices;
    cv::dnn::NMSBoxes(rectangles, scores, 0.0F, static_cast<float>(max_overlap), indices);
    for (const int index : indices) kept.push_back(of_class[static_cast<size_t>(index)]);
  }
  std::stable_sort(kept.begin(), kept.end(), [](const YoloDetection& a, const YoloDetection& b) {
    return a.score > b.score;
  });
  return kept;
}

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
