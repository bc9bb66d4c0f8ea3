// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/appearance/inner_layers.h"

#include <fmt/format.h>
#define ONNX_ML 1  // operators of classical machine learning included, as Debian builds it
#include <onnx/onnx_pb.h>

#include <cmath>
#include <map>
#include <opencv2/dnn.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

#include "soslam/base/error.h"
#include "soslam/base/text.h"

namespace soslam {

NetworkPart CutNetwork(std::string_view bytes, const std::string& name,
                       const std::vector<std::string>& tensors) {
  onnx::ModelProto model;
  if (!model.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    throw InputError(name + ": is damaged; expected an ONNX file");
  }
  onnx::GraphProto& graph = *model.mutable_graph();
  std::map<std::string, const onnx::NodeProto*> makers;  // by tensor
  std::map<std::string, int> counts;                     // of nodes by operator
  std::map<std::string, std::string> names;              // by place: "Mul 36"
  for (const onnx::NodeProto& node : graph.node()) {
    const std::string place = fmt::format("{} {}", node.op_type(), counts[node.op_type()]++);
    for (const std::string& output : node.output()) {
      makers[output] = &node;
      names.emplace(place, output);
    }
  }
  NetworkPart result;
  for (const std::string& tensor : tensors) {
    const auto place = names.find(tensor);
    result.tensors.push_back(place == names.end() ? tensor : place->second);
    if (!makers.contains(result.tensors.back())) {
      throw InputError(fmt::format("{}: has no tensor '{}'", name, tensor));
    }
  }
  std::set<const onnx::NodeProto*> needed;
  std::vector<std::string> to_visit = result.tensors;
  while (!to_visit.empty()) {
    const std::string tensor = to_visit.back();
    to_visit.pop_back();
    const auto maker = makers.find(tensor);
    if (maker == makers.end() || !needed.insert(maker->second).second) continue;
    to_visit.insert(to_visit.end(), maker->second->input().begin(), maker->second->input().end());
  }
  std::set<std::string> inputs;
  onnx::GraphProto part = graph;
  part.clear_node();
  part.clear_output();
  part.clear_value_info();
  part.clear_initializer();
  for (const onnx::NodeProto& node : graph.node()) {  // in the order of the graph
    if (!needed.contains(&node)) continue;
    *part.add_node() = node;
    inputs.insert(node.input().begin(), node.input().end());
  }
  for (const onnx::TensorProto& weights : graph.initializer()) {
    if (inputs.contains(weights.name())) *part.add_initializer() = weights;
  }
  for (const std::string& tensor : result.tensors) {
    onnx::ValueInfoProto& output = *part.add_output();
    output.set_name(tensor);
    auto& type = *output.mutable_type()->mutable_tensor_type();
    type.set_elem_type(onnx::TensorProto::FLOAT);
    for (int i = 0; i < 4; ++i) type.mutable_shape()->add_dim();  // OpenCV expects a shape
  }
  graph = std::move(part);
  result.bytes = model.SerializeAsString();
  return result;
}

cv::Mat ProbeImage(int side) {
  cv::Mat image(side, side, CV_8UC3);
  for (int v = 0; v < side; ++v) {
    for (int u = 0; u < side; ++u) {
      for (int c = 0; c < 3; ++c) {
        const double wave = std::sin(0.07 * (c + 1) * u) * std::cos(0.05 * (4 - c) * v);
        image.at<cv::Vec3b>(v, u)[c] = cv::saturate_cast<uchar>(127.5 + 100.0 * wave);
      }
    }
  }
  return image;
}

InnerLayers::InnerLayers(std::string_view bytes, const std::string& name,
                         const std::vector<std::string>& tensors, bool is_unit)
    : name_(name), is_unit_(is_unit) {
  const NetworkPart part = CutNetwork(bytes, name, tensors);
  tensors_ = part.tensors;
  try {
    network_ = cv::dnn::readNetFromONNX(part.bytes.data(), part.bytes.size());
    network_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    network_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  } catch (const cv::Exception& error) {
    throw InputError(fmt::format("{}: OpenCV cannot load its part ({})", name, OneLine(error.err)));
  }
}

cv::Mat InnerLayers::Features(const cv::Mat& image) {
  std::vector<cv::Mat> outputs;
  try {
    network_.setInput(cv::dnn::blobFromImage(image, is_unit_ ? 1.0 / 255.0 : 1.0, cv::Size(),
                                             cv::Scalar(), is_unit_ /* swap blue and red */));
    network_.forward(outputs, tensors_);
  } catch (const cv::Exception& error) {
    throw InputError(fmt::format("{}: cannot be run on an input of {} x {} pixels ({})", name_,
                                 image.cols, image.rows, OneLine(error.err)));
  }
  cv::Mat features;
  for (size_t i = 0; i < outputs.size(); ++i) {
    const cv::Mat& output = outputs[i];
    if (output.dims != 4) {
      throw InputError(
          fmt::format("{}: tensor '{}' has {} dimensions; expected 4: image, channel, row, column",
                      name_, tensors_[i], output.dims));
    }
    for (int channel = 0; channel < output.size[1]; ++channel) {
      const cv::Mat plane(output.size[2], output.size[3], CV_32F,
                          const_cast<float*>(output.ptr<float>(0, channel)));
      cv::Mat pooled;
      cv::resize(plane, pooled, {kPooledSide, kPooledSide}, 0, 0, cv::INTER_AREA);
      features.push_back(pooled.reshape(1, 1));
    }
  }
  return features;
}

std::pair<cv::Mat, cv::Mat> InnerLayers::FeaturesOfBoth(const cv::Mat& image) {
  cv::Mat mirrored;
  cv::flip(image, mirrored, /*flipCode=*/1);
  const cv::Mat features = Features(image);
  return {features, Features(mirrored)};
}

}  // namespace soslam
