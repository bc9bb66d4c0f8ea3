// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <new>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/dnn.hpp>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/paths.h"
#include "base/run_log.h"
#include "image/onnx_header.h"
#include "image/yolo_detector.h"

namespace soslam {
namespace {

namespace fs = std::filesystem;

// OpenCV before 4.7, as in Debian 12, which CertainlyFails is about.
constexpr bool kIsOldOpenCv = CV_VERSION_MAJOR == 4 && CV_VERSION_MINOR < 7;

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

bool HasAny(const OnnxHeader& header, const std::vector<const char*>& operators) {
  return std::ranges::any_of(operators,
                             [&](const char* name) { return header.operators.contains(name); });
}

bool IsHalf(const OnnxHeader& header) {
  return header.has_half_weights || std::ranges::any_of(header.inputs, [](const OnnxValue& input) {
           return input.type == OnnxValue::kHalf;
         });
}

// The command of Ultralytics that exports a network that OpenCV runs.
std::string ExportCommand(const NetworkFile& file, const std::string& further = "") {
  const cv::Size size = file.header.inputs.empty() ? cv::Size() : file.InputSize();
  return fmt::format(
      "yolo export model={}.pt format=onnx opset=12 imgsz={} half=False dynamic=False{}",
      fs::path(file.name).stem().string(),
      size.empty() ? "480,640" : fmt::format("{},{}", size.height, size.width), further);
}

// The property of a network that OpenCV 4.6 does not support, with what to do; none without one.
std::optional<std::string> CertainlyFails(const NetworkFile& file) {
  if (HasAny(file.header, {"GridSample"})) {
    return "it is a transformer with deformable attention (RT-DETR, D-FINE, DEIM, RF-DETR), whose "
           "GridSample OpenCV lacks; run it in its own software and import its boxes from a file";
  }
  if (HasAny(file.header, {"DynamicQuantizeLinear", "ConvInteger", "MatMulInteger"})) {
    return "its weights are quantised (int8); export it with " + ExportCommand(file, " int8=False");
  }
  if (IsHalf(file.header)) {
    return "its numbers are 16-bit floating point; export it with " + ExportCommand(file);
  }
  if (HasAny(file.header, {"TopK", "NonMaxSuppression"})) {
    return "it selects its boxes itself (end to end); export it with " +
           ExportCommand(file, " end2end=False nms=False");
  }
  return std::nullopt;
}

// The likely reason why OpenCV failed with a network, from its header; empty without one.
std::string LikelyReason(const NetworkFile& file) {
  if (const auto certain = CertainlyFails(file)) return ": " + *certain;
  constexpr int kBestOpset = 12;
  if (HasAny(file.header, {"QLinearConv", "QuantizeLinear"})) {
    return ": its weights are quantised (int8); export it with " + ExportCommand(file);
  }
  if (std::ranges::count(file.header.inputs.front().shape, 0) > 0) {
    return ": the size of its input is not fixed; export it with " + ExportCommand(file);
  }
  if (file.header.opset > kBestOpset) {
    return fmt::format(": it has opset {}; export it with {}", file.header.opset,
                       ExportCommand(file));
  }
  return "";
}

// The format of a network that is no ONNX file, by its first bytes; none for others.
std::optional<std::string> OtherFormat(std::string_view bytes) {
  struct Signature {
    size_t place;
    std::string_view bytes;
    const char* format;
  };
  using namespace std::string_view_literals;
  constexpr const char* kPyTorch = "a checkpoint of PyTorch";
  constexpr const char* kTensorRt = "an engine of TensorRT";
  constexpr Signature kSignatures[] = {{0, "PK\x03\x04"sv, "a zip archive"},
                                       {0, "\x80\x02"sv, kPyTorch},
                                       {8, "{\""sv, "a safetensors file"},
                                       {4, "TFL3"sv, "a model of TensorFlow Lite"},
                                       {4, "{\""sv, kTensorRt},
                                       {0, "ftrt"sv, kTensorRt},
                                       {0, "<?xml"sv, "a model of OpenVINO"},
                                       {0, "\x89HDF"sv, "a model of Keras"},
                                       {0, "7767517"sv, "a model of NCNN"}};
  if (bytes.starts_with("PK"sv) && bytes.find("/data.pkl"sv) != bytes.npos) return kPyTorch;
  for (const Signature& signature : kSignatures) {
    if (bytes.substr(std::min(signature.place, bytes.size())).starts_with(signature.bytes)) {
      return signature.format;
    }
  }
  return std::nullopt;
}

std::string HowToJoin(const fs::path& network) {
  return fmt::format(
      "export it with external_data=False, or join them with python3 -c \"import "
      "onnx; onnx.save(onnx.load('{}'), 'one_file.onnx')\"",
      network.string());
}

void RefuseOtherFormats(const NetworkFile& file) {
  for (const std::string_view ending : {".data", "_data"}) {
    fs::path network = fs::path(file.name).filename();
    if (!file.name.ends_with(fmt::format(".onnx{}", ending))) continue;
    network = network.string().substr(0, network.string().size() - ending.size());
    throw InputError(fmt::format("{}: has the weights of {}; expected one file with both: {}",
                                 file.name, network.string(), HowToJoin(network)));
  }
  const auto format = OtherFormat(file.bytes);
  if (!format) return;
  throw InputError(fmt::format(
      "{}: is {}; expected an ONNX file: a network of Ultralytics is exported with {}, others as "
      "docs/detections.md says",
      file.name, *format, ExportCommand(file)));
}

// OpenCV reads networks from memory.
void RefuseExternalWeights(const NetworkFile& file) {
  if (file.header.files_of_weights.empty()) return;
  const fs::path path = file.name;
  const std::string& weights = *file.header.files_of_weights.begin();
  throw InputError(fmt::format(
      "{}: its weights are in {}{}; expected one file with all of them: {}", file.name, weights,
      IsFile(path.parent_path() / weights) ? "" : ", which is not beside it (copy that, too)",
      HowToJoin(path.filename())));
}

// Throws InputError for a network that is none of those that detect objects in one image.
void CheckIsDetector(const NetworkFile& file) {
  const auto& inputs = file.header.inputs;
  const auto task = file.header.metadata.find("task");
  if (task != file.header.metadata.end() && task->second != "detect" && task->second != "segment" &&
      task->second != "pose") {
    throw InputError(
        fmt::format("{}: is a network for the task '{}'; expected detect, segment or "
                    "pose, whose boxes are upright",
                    file.name, task->second));
  }
  const std::vector<std::int64_t> shape =
      inputs.size() == 1 ? inputs.front().shape : std::vector<std::int64_t>{};
  const auto is = [&](size_t axis, std::int64_t side) {
    return shape[axis] == side || shape[axis] == 0;
  };
  if (shape.size() != 4 || !is(0, 1) || !is(1, 3)) {
    throw InputError(fmt::format(
        "{}: has {} inputs{}; expected one image of shape [1, 3, height, width]", file.name,
        inputs.size(), inputs.size() == 1 ? ", of shape " + ShapeText(shape) : ""));
  }
  const int type = inputs.front().type;
  if (type != 0 && type != OnnxValue::kFloat && type != OnnxValue::kHalf) {
    throw InputError(fmt::format(
        "{}: its input has numbers of ONNX's type {}; expected floating point, which is {}",
        file.name, type, OnnxValue::kFloat));
  }
}

}  // namespace

cv::Size NetworkFile::InputSize() const {
  const auto& shape = header.inputs.front().shape;
  constexpr std::int64_t kMax = 1 << 15;
  const auto side = [](std::int64_t pixels) {
    return static_cast<int>(pixels > kMax ? 0 : pixels);
  };
  return {side(shape[3]), side(shape[2])};
}

NetworkFile ReadNetworkFile(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!IsFile(path) || !stream) {
    throw InputError(path.string() + ": cannot be read; expected an ONNX file");
  }
  RecordInput(path);
  NetworkFile file{path.string(),
                   {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()},
                   {}};
  RefuseOtherFormats(file);
  file.header = ReadOnnxHeader(file.bytes, file.name);
  RefuseExternalWeights(file);
  if (const auto reason = CertainlyFails(file); reason && kIsOldOpenCv) {
    throw InputError(
        fmt::format("{}: does not run in OpenCV {}: {}", file.name, CV_VERSION, *reason));
  }
  CheckIsDetector(file);
  return file;
}

YoloNetwork::YoloNetwork(const NetworkFile& file) : file_(file) {
  // OpenCV prints the errors that it throws.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  try {
    network_ = cv::dnn::readNetFromONNX(file.bytes.data(), file.bytes.size());
    network_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
    network_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  } catch (const std::exception& error) {  // from OpenCV or its libraries
    Refuse(fmt::format("is not an ONNX network that OpenCV {} can load", CV_VERSION), error);
  }
}

void YoloNetwork::Refuse(const std::string& what, const std::exception& error) const {
  RethrowOutOfMemory(error);
  throw InputError(
      fmt::format("{}: {}{} ({})", file_.name, what, LikelyReason(file_), Reason(error)));
}

cv::Mat YoloNetwork::Forward(const cv::Mat& input, PixelValues pixel_values) {
  const bool is_unit = pixel_values != PixelValues::kBgrByte;
  const cv::Mat blob = cv::dnn::blobFromImage(input, is_unit ? 1.0 / 255.0 : 1.0, cv::Size(),
                                              cv::Scalar(), is_unit /* swap blue and red */);
  std::vector<cv::Mat> outputs;
  const auto run = [&] {
    network_.setInput(blob);
    network_.forward(outputs, network_.getUnconnectedOutLayersNames());
  };
  try {
    try {
      run();
    } catch (const cv::Exception&) {
      if (std::exchange(has_repeated_, true) || !RepeatStrides()) throw;
      run();
    }
  } catch (const std::exception& error) {  // from OpenCV or its libraries
    const cv::Size size = file_.InputSize();
    Refuse(fmt::format("cannot be run on an input of {} x {} pixels{}", input.cols, input.rows,
                       size.empty() || size == input.size()
                           ? ""
                           : fmt::format("; its own is {} x {}", size.width, size.height)),
           error);
  }
  const auto is_not_candidates = [](const cv::Mat& output) { return output.dims != 3; };
  const size_t all = outputs.size();
  std::erase_if(outputs, is_not_candidates);
  if (outputs.size() != 1) {
    throw InputError(fmt::format("{}: has {} outputs, {} with three dimensions; expected one",
                                 file_.name, all, outputs.size()));
  }
  return outputs.front();
}

// OpenCV 4.6 does not broadcast the last product of YOLOv8's graph, of boxes in cells [1, 4, N]
// with the pixels of a cell [1, N]: this repeats the latter. Returns whether the network has such a
// product.
bool YoloNetwork::RepeatStrides() {
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

}  // namespace soslam
