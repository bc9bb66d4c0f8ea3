// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace soslam {

// The part of a network that computes some of its inner tensors, which become its outputs. Tensors
// are given by name, or as the output of the k-th node, from 0, of an operator: "Mul 36", which
// does not depend on the program that exported the network.
struct NetworkPart {
  std::string bytes;                 // an ONNX file
  std::vector<std::string> tensors;  // names
};
// Throws InputError, naming the file `name`, where the network has no such tensor.
NetworkPart CutNetwork(std::string_view bytes, const std::string& name,
                       const std::vector<std::string>& tensors);

// Cells a side to which inner tensors are pooled.
inline constexpr int kPooledSide = 7;

// An image of waves by which networks are compared: side x side, blue, green, red.
cv::Mat ProbeImage(int side);

// The inner layers of a detector network, and their features of square images of objects.
class InnerLayers {
 public:
  // An ONNX network and inner tensors (CutNetwork) of shape [1, channels, rows, columns];
  // `is_unit`: the network takes red, green, blue in 0 .. 1, otherwise blue, green, red in 0 ..
  // 255. Throws InputError.
  InnerLayers(std::string_view bytes, const std::string& name,
              const std::vector<std::string>& tensors, bool is_unit);

  // Means over 7 x 7 cells of all channels of all tensors, [channels x 49], 32-bit floats.
  // Throws InputError where the network cannot be run on an image of this size.
  cv::Mat Features(const cv::Mat& image);
  // The features of an image and of its mirror image.
  std::pair<cv::Mat, cv::Mat> FeaturesOfBoth(const cv::Mat& image);

  const std::string& name() const { return name_; }

 private:
  std::string name_;
  std::vector<std::string> tensors_;
  bool is_unit_;
  cv::dnn::Net network_;
};

}  // namespace soslam
