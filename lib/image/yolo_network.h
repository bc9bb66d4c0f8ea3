// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <opencv2/dnn/dnn.hpp>
#include <optional>
#include <string>

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

// Runs a network on a uniform image of this size in a child process, as OpenCV trusts what network
// files state about their layers. Returns how it crashed; none if it ended by itself. Must not be
// called while other threads are running.
std::optional<std::string> CrashOfNetwork(const NetworkFile& file, const cv::Size& input);

}  // namespace soslam
