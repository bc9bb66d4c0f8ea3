// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/detector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "soslam/base/error.h"
#include "support/expect_error.h"
#include "support/folder_test.h"
#include "support/labelled_boxes.h"
#include "support/lists.h"
#include "support/onnx_network.h"

namespace soslam {
namespace {

TEST(LetterboxTest, FitsTheImageInGrey) {
  const cv::Mat image(480, 640, CV_8UC3, cv::Scalar(10, 20, 30));
  const cv::Mat fitted = Letterbox(image.size(), {320, 320}).Fit(image);
  ASSERT_EQ(fitted.size(), cv::Size(320, 320));
  const cv::Vec3b grey(114, 114, 114);
  const cv::Vec3b colour(10, 20, 30);
  for (const int x : {0, 160, 319}) {
    for (const int y : {0, 39, 280}) EXPECT_EQ(fitted.at<cv::Vec3b>(y, x), grey) << y;
    for (const int y : {40, 279}) EXPECT_EQ(fitted.at<cv::Vec3b>(y, x), colour) << y;
  }
}

constexpr int kClasses = 2;

class DetectorTest : public FolderTest {
 protected:
  template <typename Network>
  std::vector<NetworkDetection> Detect(const Network& network, const cv::Mat& image) {
    Write("net.onnx", network.Onnx());
    const auto detections = DetectWith(NetworkBackend::kOpenCv, image);
    if (HasOnnxRuntime()) {
      const auto others = DetectWith(NetworkBackend::kOnnxRuntime, image);
      EXPECT_EQ(others.size(), detections.size());
      for (size_t i = 0; i < std::min(others.size(), detections.size()); ++i) {
        EXPECT_EQ(others[i].class_index, detections[i].class_index);
        EXPECT_NEAR(others[i].score, detections[i].score, 1e-4);
        ExpectBox(others[i].box, detections[i].box);
      }
    }
    return detections;
  }
  std::vector<NetworkDetection> DetectWith(NetworkBackend backend, const cv::Mat& image) {
    const NetworkFile file = ReadNetworkFile(folder_ / "net.onnx", backend);
    const NetworkFormat format = FindFormat(file, kClasses, options_, image.size());
    Detector detector(file, format, {0, 1}, options_);
    const auto detections = detector.Detect(image);
    CheckBoxesArePossible(detector.tally(), format, "net.onnx");
    return detections;
  }
  static bool HasOnnxRuntime() { return !OnnxRuntimeVersion().empty(); }

  DetectorOptions options_;
  // Fills 64 x 48 of the input, from row 8 on: a pixel of the input is two of the image.
  const cv::Mat image_ = cv::Mat(96, 128, CV_8UC3, cv::Scalar(0, 0, 0));
};

// Two boxes of one class on top of each other, one of the other class, one below the threshold.
const std::vector<float> kCandidates = {20, 30, 10, 12, 0.9F, 0.9F, 0.0F,  //
                                        21, 30, 10, 12, 0.9F, 0.8F, 0.0F,  //
                                        40, 20, 8,  8,  0.5F, 0.2F, 0.6F,  //
                                        50, 50, 8,  8,  0.1F, 0.9F, 0.9F};

void ExpectTheTwoBoxes(const std::vector<NetworkDetection>& boxes, double score_0, double score_1) {
  ASSERT_EQ(boxes.size(), 2u);
  EXPECT_EQ(boxes[0].class_index, 0);
  EXPECT_NEAR(boxes[0].score, score_0, 1e-6);
  ExpectBox(boxes[0].box, {29.5, 31.5, 49.5, 55.5});  // (15, 24) to (25, 36) of the input
  EXPECT_EQ(boxes[1].class_index, 1);
  EXPECT_NEAR(boxes[1].score, score_1, 1e-6);
  ExpectBox(boxes[1].box, {71.5, 15.5, 87.5, 31.5});  // (36, 16) to (44, 24)
}

TEST_F(DetectorTest, V5) {
  ExpectTheTwoBoxes(Detect(MeanNetwork{{1, 4, 7}, kCandidates, {}}, image_), 0.81, 0.3);
}

// The score is the mean of one channel of the input, of which 48 of 64 rows are the image and the
// others grey, 114.
TEST_F(DetectorTest, PixelValues) {
  const cv::Mat image(96, 128, CV_8UC3, cv::Scalar(40, 90, 210));  // blue, green, red
  const auto score_of_channel = [&](size_t channel) {
    MeanNetwork network = {{1, 1, 7}, {20, 30, 10, 12, 1, 0, 0}, {}};
    network.weights.resize(7, {0.0F, 0.0F, 0.0F});
    const bool is_byte = options_.pixel_values == PixelValues::kBgrByte;
    const bool is_normal = options_.pixel_values == PixelValues::kRgbImageNet;
    network.weights[5][channel] = is_byte ? 1.0F / 255 : is_normal ? 0.5F : 1.0F;
    return Detect(network, image).at(0).score;
  };
  const auto mean = [](double value) { return (48 * value + 16 * 114) / 64; };
  // The network adds up 4096 numbers in single precision: at most 4096 * 6e-8 of the sum is lost.
  options_.min_score = 0.01;
  EXPECT_NEAR(score_of_channel(0), mean(210) / 255, 3e-4);
  EXPECT_NEAR(score_of_channel(1), mean(90) / 255, 3e-4);
  EXPECT_NEAR(score_of_channel(2), mean(40) / 255, 3e-4);
  options_.pixel_values = PixelValues::kBgrByte;
  EXPECT_NEAR(score_of_channel(0), mean(40) / 255, 3e-4);
  EXPECT_NEAR(score_of_channel(2), mean(210) / 255, 3e-4);
  options_.pixel_values = PixelValues::kRgbImageNet;
  EXPECT_NEAR(score_of_channel(0), 0.5 * (mean(210) / 255 - 0.485) / 0.229, 1e-3);
}

// (-8, 4) to (4, 20) of the input is 24 x 24 px of the image, of which 8 x 24 are inside; the other
// box is in the grey part below.
TEST_F(DetectorTest, OnlyWhatIsInTheImageIsFound) {
  const auto boxes =
      Detect(MeanNetwork{{1, 2, 7}, {-2, 12, 12, 16, 1, 1, 0, 30, 60, 8, 6, 1, 1, 0}, {}}, image_);
  ExpectBox(Only(boxes).box, {-0.5, -0.5, 7.5, 23.5});
}

TEST_F(DetectorTest, EndToEndKeepsOverlaps) {
  const auto boxes = Detect(MeanNetwork{{1, 2, 6},
                                        {15, 24, 25, 36, 0.81F, 0,  //
                                         15, 24, 25, 36, 0.3F, 0},
                                        {}},
                            image_);
  ASSERT_EQ(boxes.size(), 2u);
  ExpectBox(boxes[0].box, {29.5, 31.5, 49.5, 55.5});
}

// A box from (12, 24) to (20, 40) of an input of 64 x 64, to which the image is stretched: a pixel
// of the input is 2 x 1.5 of the image.
const std::vector<float> kFractions = {0.25F, 0.5F, 0.125F, 0.25F};
const Box kStretched{23.5, 35.5, 39.5, 59.5};

void ExpectFound(const NetworkDetection& found, int class_index, double score) {
  EXPECT_EQ(found.class_index, class_index);
  EXPECT_NEAR(found.score, score, 1e-5);
  ExpectBox(found.box, kStretched);
}

TEST_F(DetectorTest, DetrBySigmoidAndSoftmax) {
  options_.pixel_values = PixelValues::kRgbUnit;
  const float log_3 = std::log(3.0F);
  ConstantNetwork network = {
      {{"logits", {1, 1, 2}, {log_3, -log_3}}, {"pred_boxes", {1, 1, 4}, kFractions}}};
  ExpectFound(Only(Detect(network, image_)), 0, 0.75);
  network.outputs[0] = {"logits", {1, 2, 3}, {0, log_3, -1, 0, 0, 9}};
  network.outputs[1] = {"pred_boxes", {1, 2, 4}, {0.25F, 0.5F, 0.125F, 0.25F, 0.5F, 0.5F, 1, 1}};
  options_.output_layout = OutputLayout::kDetrSoftmax;
  ExpectFound(Only(Detect(network, image_)), 1, 3 / (1 + 3 + std::exp(-1.0)));
  if (!HasOnnxRuntime()) return;  // OpenCV wants all inputs to be used
  OnnxGraph masked = network.Graph();
  WriteBytes(folder_ / "net.onnx",
             masked.Input("pixel_mask", {0, 32, 0}, OnnxGraph::kInt64).Onnx());
  ExpectFound(Only(DetectWith(NetworkBackend::kOnnxRuntime, image_)), 1,
              3 / (1 + 3 + std::exp(-1.0)));
}

// RF-DETR names its logits "labels"; with as many classes as a box has numbers, only names tell.
TEST_F(DetectorTest, RfDetr) {
  const float log_3 = std::log(3.0F);
  ExpectFound(Only(Detect(ConstantNetwork{{{"dets", {1, 1, 4}, kFractions},
                                           {"labels", {1, 1, 3}, {-log_3, log_3, -9}}}},
                          image_)),
              1, 0.75);
}

// The box is asked for in pixels of the input, which is not square.
TEST_F(DetectorTest, LabelsBoxesAndScores) {
  options_.pixel_values = PixelValues::kRgbUnit;
  ConstantNetwork network = {{{"labels", {1, 1}, {1}, true},
                              {"boxes", {1, 1, 4}, {0.1875F, 0.375F, 0.3125F, 0.625F}},
                              {"scores", {1, 1}, {0.75F}}},
                             "boxes",
                             "orig_target_sizes"};
  network.input_height = 32;
  ExpectFound(Only(Detect(network, image_)), 1, 0.75);
}

// Two boxes on top of each other: the network without suppression leaves that to us.
TEST_F(DetectorTest, PaddleWithAndWithoutSuppression) {
  options_.pixel_values = PixelValues::kRgbImageNet;
  ConstantNetwork network = {{{"tmp_16", {1, 2, 4}, {12, 24, 20, 40, 12, 24, 20, 40.5F}},
                              {"concat_4.tmp_0", {1, 2, 2}, {0.1F, 0, 0.75F, 0.5F}}}};
  ExpectFound(Only(Detect(network, image_)), 1, 0.75);
  network = {{{"nms", {2, 6}, {1, 0.75F, 12, 24, 20, 40, -1, -1, -1, -1, -1, -1}},
              {"count", {1}, {1}, true}}};
  ExpectFound(Only(Detect(network, image_)), 1, 0.75);
}

TEST_F(DetectorTest, SizesOfPaddleAreThoseOfTheInput) {
  options_.pixel_values = PixelValues::kRgbImageNet;
  ConstantNetwork network = {
      {{"boxes", {1, 1, 4}, {12, 24, 20, 40}}, {"scores", {1, 2, 1}, {0.0F, 0.75F}}},
      "boxes",
      "scale_factor",
      false};
  ExpectFound(Only(Detect(network, image_)), 1, 0.75);
  network.size_input = "im_shape";  // height and width, 32 and 64
  network.input_height = 32;
  network.outputs[0].numbers = {12.0F / 32, 12.0F / 64, 20.0F / 32, 20.0F / 64};
  ExpectFound(Only(Detect(network, image_)), 1, 0.75);
}

// The end of this graph is what OpenCV before 4.7 does not run. Masks are a second output.
TEST_F(DetectorTest, V8WithMasks) {
  const V8Network network = {{{0, {20, 30, 10, 12}, 0, 0.81F},
                              {64, {21, 30, 10, 12}, 0, 0.72F},
                              {83, {40, 20, 8, 8}, 1, 0.3F}}};
  ExpectTheTwoBoxes(Detect(network, image_), 0.81, 0.3);
}

// The image has a red block of 16 x 16 pixels, a cell of the finest grid in an input of 64 x 64.
TEST_F(DetectorTest, YoloxRawAndDecoded) {
  cv::Mat image(128, 128, CV_8UC3, cv::Scalar(0, 0, 0));
  image(cv::Rect(48, 32, 16, 16)).setTo(cv::Scalar(0, 0, 255));
  options_.input_width = options_.input_height = 64;
  for (const bool is_decoded : {false, true}) {
    const NetworkDetection found = Only(Detect(GridNetwork{is_decoded}, image));
    EXPECT_NEAR(found.score, 0.9, 1e-6);
    ExpectBox(found.box, {39.5, 15.5, 71.5, 63.5});  // centre (28, 20), size (16, 24)
  }
}

// Transformers sample their features with GridSample, and choose the best queries with TopK.
TEST_F(DetectorTest, OnnxRuntimeRunsWhatOpenCvLacks) {
  if (!HasOnnxRuntime()) GTEST_SKIP() << "built without ONNX Runtime";
  OnnxGraph graph;
  graph.Input("images", {1, 3, 64, 64}).Output("boxes", {1, 1, 4});
  graph.Output("scores", {1, 1}).Output("labels", {1, 1}, OnnxGraph::kInt64);
  graph.Floats<float>("centre", {1, 1, 1, 2}, {0, 0})
      .Floats<float>("box", {1, 1, 4}, {12, 24, 20, 40});
  graph.Int64s("row", {1, 3}).Int64s("one", {1});
  graph.Node("GridSample", {"images", "centre"}, "colour")
      .Node("Reshape", {"colour", "row"}, "channels")
      .Node("TopK", {"channels", "one"}, std::vector<std::string>{"scores", "labels"}, {})
      .Node("Identity", {"box"}, "boxes");
  WriteBytes(folder_ / "net.onnx", graph.Onnx({}, 16));
  options_.pixel_values = PixelValues::kRgbUnit;
  const cv::Mat green(96, 128, CV_8UC3, cv::Scalar(0, 204, 51));
  ExpectFound(Only(DetectWith(NetworkBackend::kOnnxRuntime, green)), 1, 0.8);
}

TEST_F(DetectorTest, BadFilesAreNamed) {
  // A network that cannot run: seven numbers do not make eight.
  ExpectError<InputError>(
      [&] {
        Detect(MeanNetwork{{1, 1, 7}, std::vector<float>(8), {}}, image_);
      },
      {"net.onnx"});
  ExpectError<InputError>([&] { ReadNetworkFile(folder_ / "none.onnx"); },
                          {"none.onnx", "cannot be read"});
  ExpectError<InputError>([&] { ReadNetworkFile(folder_.path()); },
                          {folder_.path().string(), "cannot be read"});
}

TEST_F(DetectorTest, OtherFormatsAreNamedWithTheExport) {
  using Format = std::pair<std::string, const char*>;
  for (const auto& [bytes, format] :
       {Format(std::string("PK\3\4\0\0 yolo11n/data.pkl", 23), "checkpoint of PyTorch"),
        Format("PK\3\4 net.onnx", "zip archive"),
        Format(std::string("\x80\2\x8a\x0a", 4), "checkpoint of PyTorch"),
        Format(std::string("\x40\0\0\0\0\0\0\0{\"weights\"", 18), "safetensors"),
        Format(std::string("\x1c\0\0\0TFL3", 8), "TensorFlow Lite"), Format("ftrt", "TensorRT"),
        Format("<?xml version=\"1.0\"?>", "OpenVINO")}) {
    const auto path = Write("yolo11n.pt", bytes);
    ExpectError<InputError>([&] { ReadNetworkFile(path); },
                            {path.string(), format, "ONNX", "yolo export model=yolo11n.pt"});
  }
}

TEST_F(DetectorTest, ExternalWeightsAreNamed) {
  const auto location = ProtoMessage().Text(1, "location").Text(2, "net.onnx.data");
  const auto weights =
      ProtoMessage().Integer(1, 7).Integer(2, 1).Message(13, location).Integer(14, 1);
  const auto path =
      Write("net.onnx", ProtoMessage().Message(7, ProtoMessage().Message(5, weights)).bytes());
  const auto read = [&] { ReadNetworkFile(path); };
  ExpectError<InputError>(read, {path.string(), "net.onnx.data, which is not beside it"});
  Write("net.onnx.data", "weights");
  ExpectError<InputError>(read, {"weights are in net.onnx.data;", "external_data=False"});
  for (const char* name : {"net.onnx.data", "net.onnx_data"}) {
    ExpectError<InputError>([&] { ReadNetworkFile(Write(name, "weights")); },
                            {name, "has the weights of net.onnx;", "onnx.load('net.onnx')"});
  }
}

}  // namespace
}  // namespace soslam
