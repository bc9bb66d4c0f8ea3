// SPDX-License-Identifier: BSD-3-Clause
#include "soslam/image/network.h"

#ifdef SOSLAM_ONNXRUNTIME
#include <onnxruntime_cxx_api.h>

#include <algorithm>
#include <stdexcept>

namespace soslam {
namespace {

// The numbers of a tensor as CV_32F.
template <typename T>
cv::Mat AsFloats(const Ort::Value& tensor, const std::vector<int>& shape, size_t count) {
  cv::Mat floats(shape, CV_32FC1);
  const T* numbers = tensor.GetTensorData<T>();
  std::transform(numbers, numbers + count, floats.ptr<float>(),
                 [](T number) { return static_cast<float>(number); });
  return floats;
}

cv::Mat AsFloats(const Ort::Value& tensor) {
  const auto info = tensor.GetTensorTypeAndShapeInfo();
  const std::vector<std::int64_t> sides = info.GetShape();
  std::vector<int> shape(sides.begin(), sides.end());
  if (shape.empty()) shape = {1};  // one number
  const size_t count = info.GetElementCount();
  switch (info.GetElementType()) {
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_FLOAT:
      return AsFloats<float>(tensor, shape, count);
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT64:
      return AsFloats<std::int64_t>(tensor, shape, count);
    case ONNX_TENSOR_ELEMENT_DATA_TYPE_INT32:
      return AsFloats<std::int32_t>(tensor, shape, count);
    default:
      throw std::runtime_error("an output is neither float nor integer");
  }
}

class OnnxRuntimeNetwork : public Network {
 public:
  explicit OnnxRuntimeNetwork(const NetworkFile& file)
      : Network(file), session_(env_, file.bytes.data(), file.bytes.size(), Options()) {}

 protected:
  std::vector<cv::Mat> Run(const std::vector<cv::Mat>& inputs) override {
    std::vector<std::vector<std::int64_t>> integers;  // what the tensors refer to
    std::vector<Ort::Value> tensors;
    std::vector<const char*> input_names, output_names;
    integers.reserve(inputs.size());
    for (size_t i = 0; i < inputs.size(); ++i) {
      const OnnxValue& value = file_.header.inputs[i];
      const std::vector<std::int64_t> shape(inputs[i].size.p, inputs[i].size.p + inputs[i].dims);
      auto* floats = const_cast<float*>(inputs[i].ptr<float>());
      input_names.push_back(value.name.c_str());
      if (value.type == OnnxValue::kInt64) {
        auto& numbers = integers.emplace_back(floats, floats + inputs[i].total());
        tensors.push_back(Ort::Value::CreateTensor(memory_, numbers.data(), numbers.size(),
                                                   shape.data(), shape.size()));
      } else {
        tensors.push_back(Ort::Value::CreateTensor(memory_, floats, inputs[i].total(), shape.data(),
                                                   shape.size()));
      }
    }
    for (const OnnxValue& value : file_.header.outputs) output_names.push_back(value.name.c_str());
    const auto results = session_.Run(Ort::RunOptions(), input_names.data(), tensors.data(),
                                      tensors.size(), output_names.data(), output_names.size());
    std::vector<cv::Mat> outputs;
    for (const Ort::Value& result : results) outputs.push_back(AsFloats(result));
    return outputs;
  }

 private:
  static Ort::SessionOptions Options() {
    Ort::SessionOptions options;
    options.SetIntraOpNumThreads(1).SetInterOpNumThreads(1).SetExecutionMode(ORT_SEQUENTIAL);
    return options;
  }

  Ort::Env env_{ORT_LOGGING_LEVEL_FATAL};
  Ort::MemoryInfo memory_ = Ort::MemoryInfo::CreateCpu(OrtArenaAllocator, OrtMemTypeDefault);
  Ort::Session session_;
};

}  // namespace

std::unique_ptr<Network> LoadWithOnnxRuntime(const NetworkFile& file) {
  return std::make_unique<OnnxRuntimeNetwork>(file);
}

std::string OnnxRuntimeVersion() { return Ort::GetVersionString(); }

}  // namespace soslam

#else

namespace soslam {

std::unique_ptr<Network> LoadWithOnnxRuntime(const NetworkFile&) { return nullptr; }

std::string OnnxRuntimeVersion() { return ""; }

}  // namespace soslam

#endif
