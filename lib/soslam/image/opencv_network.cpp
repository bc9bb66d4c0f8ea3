// SPDX-License-Identifier: BSD-3-Clause
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <utility>

#include "soslam/image/network.h"

namespace soslam {
namespace {

class OpenCvNetwork : public Network {
 public:
  explicit OpenCvNetwork(const NetworkFile& file) : Network(file) {
    // OpenCV prints the errors that it throws.
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    network_ = cv::dnn::readNetFromONNX(file.bytes.data(), file.bytes.size());
    network_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    network_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  }

 protected:
  std::vector<cv::Mat> Run(const std::vector<cv::Mat>& inputs) override {
    try {
      return RunOnce(inputs);
    } catch (const cv::Exception&) {
      if (std::exchange(has_repeated_, true) || !RepeatStrides()) throw;
      return RunOnce(inputs);
    }
  }

 private:
  std::vector<cv::Mat> RunOnce(const std::vector<cv::Mat>& inputs) {
    for (size_t i = 0; i < inputs.size(); ++i) {
      network_.setInput(inputs[i], file_.header.inputs[i].name);
    }
    std::vector<std::string> names;
    for (const OnnxValue& output : file_.header.outputs) names.push_back(output.name);
    std::vector<cv::Mat> outputs;
    network_.forward(outputs, names);
    return outputs;
  }

  // OpenCV 4.6 does not broadcast the last product of YOLOv8's graph, of boxes in cells [1, 4, N]
  // with the pixels of a cell [1, N]: this repeats the latter. Returns whether the network has such
  // a product.
  bool RepeatStrides() {
    for (const int id : network_.getUnconnectedOutLayers()) {
      cv::Ptr<cv::dnn::Layer> layer = network_.getLayer(id);
      while (layer && (layer->type == "Identity" || layer->type == "Concat")) {
        const auto inputs = network_.getLayerInputs(network_.getLayerId(layer->name));
        layer = inputs.empty() ? nullptr : inputs.front();
      }
      if (!layer || layer->type != "Scale" || layer->blobs.size() != 1) continue;
      constexpr int kFields = 4;  // cx cy w h
      layer->blobs[0] = cv::repeat(layer->blobs[0].reshape(1, 1), kFields, 1).reshape(1, 1);
      return true;
    }
    return false;
  }

  cv::dnn::Net network_;
  bool has_repeated_ = false;  // RepeatStrides was tried
};

}  // namespace

std::unique_ptr<Network> LoadWithOpenCv(const NetworkFile& file) {
  return std::make_unique<OpenCvNetwork>(file);
}

}  // namespace soslam
