// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <vector>

#include "base/options.h"
#include "geometry/box.h"
#include "model/image_orientation.h"

namespace soslam {

// Layout of a YOLO network's output. N candidates, C classes; centre, width and height are in
// pixels of the network's input.
enum class YoloLayout {
  kV5,     // [1, N, 5 + C]: cx cy w h, objectness, a score of each class. Also YOLOv7.
  kV8,     // [1, 4 + C, N]: transposed, without objectness. Also YOLO11.
  kYolox,  // as kV5, but cx cy in cells and w h as logarithms of cells: YOLOX as published.
};
inline constexpr const char* kYoloLayoutNames[] = {"v5", "v8", "yolox"};

// Pixel values that a network expects.
enum class PixelValues {
  kRgbUnit,  // red, green, blue from 0 to 1: Ultralytics' networks
  kBgrByte,  // blue, green, red from 0 to 255: YOLOX
};
inline constexpr const char* kPixelValuesNames[] = {"rgb_0_1", "bgr_0_255"};

struct DetectorOptions {
  YoloLayout output_layout = YoloLayout::kV5;
  PixelValues pixel_values = PixelValues::kRgbUnit;
  int input_width = 640;
  int input_height = 640;
  ImageOrientation image_orientation = ImageOrientation::kUpright;
  double min_score = 0.25;
  double max_overlap = 0.45;

  void Describe(OptionVisitor& visit) {
    visit.Group("Network");
    visit.Choice(
        "output_layout", &output_layout, kYoloLayoutNames,
        "the network's output: v5 [1, N, 5 + classes], v8 [1, 4 + classes, N], or yolox: v5 "
        "with boxes in cells of its grids, as YOLOX is published (exported with "
        "--decode_in_inference it is v5)");
    visit.Choice("pixel_values", &pixel_values, kPixelValuesNames,
                 "what the network takes: rgb_0_1 (Ultralytics) or bgr_0_255 (YOLOX)");
    visit.Integer("input_width_px", &input_width, {1, 8192},
                  "width of the network's input, as it was exported");
    visit.Integer("input_height_px", &input_height, {1, 8192},
                  "height of the network's input, as it was exported");
    visit.Group("Images");
    visit.Choice("image_orientation", &image_orientation, kImageOrientationNames,
                 "where EXIF turns images: what is detected, and what boxes refer to, is the image "
                 "as viewers show it, or the pixels as the file stores them");
    visit.Group("Detections that are kept");
    visit.Real("min_score", &min_score, {0, 1}, "detections with a lower score are dropped");
    visit.Real("max_overlap", &max_overlap, {0, 1},
               "of two boxes of one class with a larger IoU, the one with the lower score is "
               "dropped");
  }
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

// A detected object: class, score and box.
struct YoloDetection {
  int class_index;
  double score;
  Box box;
};

// The candidates with at least `min_score` in the output of a YOLO network, each with its best
// class; the score is that of the class, times the objectness if there is one. Boxes are in pixels
// of the network's input, which is of size `input`, from its outer corner. `network` is its name in
// error messages. Throws InputError when the output does not have this layout for that many
// classes;
// NumericalError for a box or score that is not finite.
std::vector<YoloDetection> ReadYoloOutput(const cv::Mat& output, YoloLayout layout,
                                          const cv::Size& input, int classes, double min_score,
                                          const std::string& network);

// Non-maximum suppression: removes boxes that overlap one of the same class and higher score by
// more than `max_overlap` (IoU). Sorted by descending score.
std::vector<YoloDetection> WithoutOverlaps(const std::vector<YoloDetection>& boxes, int classes,
                                           double max_overlap);

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
